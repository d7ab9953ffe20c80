#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <asio/buffer.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>

namespace fathom::runtime {

/// What has left, and what a slow receiver did not take.
struct Flow {
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;
};

/// Texts on their way through one stream (serial port or connection), in order. When the receiver is slow,
/// the oldest that have not begun to leave make room. A receiver that takes nothing for kPatience is given
/// up.
template <class Stream>
class Lane : public std::enable_shared_from_this<Lane<Stream>> {
 public:
  using Ended = std::function<void(const std::string& why)>;

  static constexpr std::size_t kMostWaiting = 32 * 1024;
  static constexpr std::chrono::seconds kPatience{30};

  /// `ended` is called once, on the stream's thread, when a write fails or is given up.
  Lane(Stream stream, Flow& flow, Ended ended)
      : stream_(std::move(stream)),
        patience_(stream_.get_executor()),
        flow_(flow),
        ended_(std::move(ended)) {}

  [[nodiscard]] Stream& stream() { return stream_; }

  void send(std::shared_ptr<const std::string> text) {
    if (over_) return;
    waiting_bytes_ += text->size();
    waiting_.push_back(std::move(text));
    const std::size_t leaving = writing_ ? 1 : 0;
    while (waiting_bytes_ > kMostWaiting && waiting_.size() > leaving + 1) {
      const auto oldest = waiting_.begin() + static_cast<std::ptrdiff_t>(leaving);
      waiting_bytes_ -= (*oldest)->size();
      flow_.dropped += (*oldest)->size();
      waiting_.erase(oldest);
    }
    if (!writing_) write();
  }

  /// Nothing more leaves. `ended` is called unless it has been.
  void end(const std::string& why) {
    if (over_) return;
    over_ = true;
    patience_.cancel();
    asio::error_code ignored;
    stream_.close(ignored);
    if (ended_) std::exchange(ended_, nullptr)(why);
  }

 private:
  void write() {
    writing_ = true;
    auto self = this->shared_from_this();
    patience_.expires_after(kPatience);
    patience_.async_wait([self](const asio::error_code& error) {
      if (!error) self->end("takes nothing");
    });
    asio::async_write(stream_, asio::buffer(*waiting_.front()),
                      [self](const asio::error_code& error, std::size_t) { self->written(error); });
  }

  void written(const asio::error_code& error) {
    if (over_) return;
    if (error) return end(error.message());
    flow_.bytes += waiting_.front()->size();
    waiting_bytes_ -= waiting_.front()->size();
    waiting_.pop_front();
    writing_ = false;
    patience_.cancel();
    if (!waiting_.empty()) write();
  }

  Stream stream_;
  asio::steady_timer patience_;
  Flow& flow_;
  Ended ended_;
  std::deque<std::shared_ptr<const std::string>> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool writing_ = false;
  bool over_ = false;
};

}  // namespace fathom::runtime
