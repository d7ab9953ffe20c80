#pragma once

#include <chrono>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "support/presence.hpp"

namespace fathom::test {

using std::chrono::milliseconds;

inline bus::ParticipantOptions options(std::uint32_t domain, const std::string& name) {
  return presence(domain, name);
}

/// True as soon as `condition` is; false when it has not become so within `limit`.
inline bool eventually(const std::function<bool()>& condition, milliseconds limit = milliseconds(10'000)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return condition();
    std::this_thread::sleep_for(milliseconds(2));
  }
  return true;
}

/// Lets `time` pass, for tests of what must not happen.
inline void let_pass(milliseconds time) {
  std::this_thread::sleep_for(time);
}

/// Keeps what arrives, for several threads.
template <class T>
class Inbox {
 public:
  auto handler() {
    return [this](const T& sample, const bus::SampleInfo& info) {
      const std::lock_guard lock(mutex_);
      samples_.emplace_back(sample, info);
    };
  }
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return samples_.size();
  }
  std::vector<std::pair<T, bus::SampleInfo>> all() const {
    const std::lock_guard lock(mutex_);
    return samples_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<T, bus::SampleInfo>> samples_;
};

/// Keeps the events of a participant.
class Events {
 public:
  explicit Events(bus::Participant& participant) : participant_(participant) {
    participant.on_event([this](const bus::BusEvent& event) {
      const std::lock_guard lock(mutex_);
      events_.push_back(event);
    });
  }
  ~Events() { participant_.on_event(nullptr); }
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  std::vector<bus::BusEvent> of(bus::BusEventKind kind) const {
    const std::lock_guard lock(mutex_);
    std::vector<bus::BusEvent> found;
    for (const bus::BusEvent& event : events_) {
      if (event.kind == kind) found.push_back(event);
    }
    return found;
  }

 private:
  bus::Participant& participant_;
  mutable std::mutex mutex_;
  std::vector<bus::BusEvent> events_;
};

/// Of the environment; empty: it is not set.
inline std::string variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? "" : value;
}

/// Another process: this executable, running one disabled test as its body.
class Child {
 public:
  /// `test` is Suite.DISABLED_name; `variables` are added to the environment, each NAME=value.
  Child(const std::string& test, std::vector<std::string> variables);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void kill_hard();  ///< SIGKILL, and waits for the end
  void pause();      ///< SIGSTOP
  void go_on();      ///< SIGCONT
  int stop();        ///< SIGTERM, and waits for the end; returns the exit status

 private:
  int end(int signal);
  int pid_ = -1;
};

/// In a child: sleeps until SIGTERM or `limit` has passed, calling `step` every `period`.
void until_stopped(milliseconds period, const std::function<void()>& step,
                   milliseconds limit = milliseconds(60'000));

}  // namespace fathom::test
