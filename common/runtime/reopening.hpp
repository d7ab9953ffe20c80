#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "base/clock.hpp"
#include "base/time.hpp"
#include "runtime/backoff.hpp"
#include "runtime/change_log.hpp"

namespace fathom::runtime {

/// A port that is opened again for ever, after 0.1 to 5 s: says each change between trouble and well once, of
/// many the newest (ChangeLog), and knows when to try. Of one thread, apart from trouble().
class Reopening {
 public:
  using Say = std::function<void(bool is_trouble, const std::string& text)>;

  Reopening(asio::io_context& io, std::string name, Say say)
      : name_(std::move(name)), say_(std::move(say)), timer_(io), later_(io) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Why it does not work; empty when it does.
  [[nodiscard]] std::string trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }

  /// It does not work, and `open` shall be called after a while.
  void fail(const std::string& why, std::function<void()> open) {
    bool is_new = false;
    {
      const std::lock_guard lock(mutex_);
      is_new = trouble_.empty();
      trouble_ = why;
    }
    if (is_new) changed(LogLevel::warning, why + "; it is tried again and again");
    timer_.expires_after(std::chrono::nanoseconds(from_seconds(backoff_.next_s())));
    timer_.async_wait([open = std::move(open)](const asio::error_code& error) {
      if (!error) open();
    });
  }
  /// It works. `first`: what is said when there had been no trouble; empty: nothing.
  void well(const std::string& first = "") {
    bool was_bad = false;
    {
      const std::lock_guard lock(mutex_);
      was_bad = !trouble_.empty();
      trouble_.clear();
    }
    if (was_bad) {
      changed(LogLevel::info, "open again");
    } else if (!first.empty()) {
      changed(LogLevel::info, first);
    }
  }
  /// The next failure is the first of a series.
  void begin_anew() { backoff_.reset(); }
  void stop() {
    timer_.cancel();
    later_.cancel();
  }

 private:
  static constexpr double kFirstWait_s = 0.1;
  static constexpr double kLongestWait_s = 5.0;

  void changed(LogLevel level, const std::string& text) {
    write(changes_.add({level, name_ + ": " + text}, SystemClock().monotonic_ns()));
    if (!waits_) write_later();
  }
  /// What is held back.
  void write_later() {
    waits_ = changes_.holds();
    if (!waits_) return;
    later_.expires_after(std::chrono::seconds(1));
    later_.async_wait([this](const asio::error_code& error) {
      if (error) return;
      write(changes_.due(SystemClock().monotonic_ns()));
      write_later();
    });
  }
  void write(const std::optional<ChangeLog::Line>& line) {
    if (line) say_(line->level == LogLevel::warning, line->text);
  }

  const std::string name_;
  const Say say_;
  asio::steady_timer timer_;
  asio::steady_timer later_;  ///< writes what was held back
  bool waits_ = false;
  ChangeLog changes_;
  Backoff backoff_{kFirstWait_s, kLongestWait_s};
  mutable std::mutex mutex_;
  std::string trouble_;
};

}  // namespace fathom::runtime
