#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::test {

/// A source and what it delivered.
class Listener {
 public:
  explicit Listener(runtime::ByteSourceConfig config)
      : source_(std::make_unique<runtime::ByteSource>(
            std::move(config), clock_,
            [this](std::span<const std::uint8_t> bytes, const runtime::Arrival& at) {
              {
                const std::lock_guard lock(mutex_);
                text_.append(bytes.begin(), bytes.end());
                last_ = at;
              }
              while (held_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            },
            [this](const runtime::SourceEvent& event) {
              const std::lock_guard lock(mutex_);
              events_.push_back(event.state);
            })) {
    source_->start();
  }
  bool heard(const std::string& text) const {
    const std::lock_guard lock(mutex_);
    return text_.find(text) != std::string::npos;
  }
  /// Arrival of the last bytes.
  runtime::Arrival last() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }
  /// The source stands still at the next bytes, until release().
  void hold() { held_ = true; }
  void release() { held_ = false; }
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return text_.size();
  }
  std::vector<runtime::SourceState> events() const {
    const std::lock_guard lock(mutex_);
    return events_;
  }
  runtime::SourceState state() const { return source_->status().state; }
  runtime::SourceStatus status() const { return source_->status(); }
  double stop_s() {
    const auto before = std::chrono::steady_clock::now();
    source_.reset();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  }

 private:
  SystemClock clock_;
  mutable std::mutex mutex_;
  std::string text_;
  runtime::Arrival last_;
  std::atomic<bool> held_{false};
  std::vector<runtime::SourceState> events_;
  std::unique_ptr<runtime::ByteSource> source_;
};

/// Of a source that tries again at once.
inline runtime::ByteSourceConfig quick(runtime::SourceType type) {
  runtime::ByteSourceConfig out;
  out.type = type;
  out.backoff_first_s = 0.02;
  out.backoff_most_s = 0.1;
  out.silence_s = 0.3;
  return out;
}

}  // namespace fathom::test
