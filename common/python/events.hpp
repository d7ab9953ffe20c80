#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <variant>

#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"

namespace fathom::python {

/// States and alarms on their way from the threads of the bus, which never wait for Python, to the one that
/// calls Python. Who is too slow gets the newest: the oldest states go.
class Events {
 public:
  static constexpr std::size_t kMostStates = 32;
  static constexpr std::size_t kMostAlarms = 256;
  using Event = std::variant<std::monostate, NavState, Alarm>;

  void put(const NavState& state) { put(states_, state, kMostStates); }
  void put(const Alarm& alarm) { put(alarms_, alarm, kMostAlarms); }
  /// Forgets the states, or the alarms, that nobody has taken.
  void forget_states() { forget(states_); }
  void forget_alarms() { forget(alarms_); }

  /// Waits for the next one, alarms first. Monostate once it has ended.
  [[nodiscard]] Event wait() {
    std::unique_lock lock(mutex_);
    there_.wait(lock, [this] { return ended_ || !states_.empty() || !alarms_.empty(); });
    if (ended_) return {};
    if (!alarms_.empty()) return take(alarms_);
    return take(states_);
  }

  void end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    there_.notify_all();
  }

 private:
  template <class T>
  void put(std::deque<T>& queue, const T& value, std::size_t most) {
    {
      const std::lock_guard lock(mutex_);
      if (queue.size() == most) queue.pop_front();
      queue.push_back(value);
    }
    there_.notify_all();
  }
  template <class T>
  void forget(std::deque<T>& queue) {
    const std::lock_guard lock(mutex_);
    queue.clear();
  }
  template <class T>
  static Event take(std::deque<T>& queue) {
    Event out(std::move(queue.front()));
    queue.pop_front();
    return out;
  }

  std::mutex mutex_;  ///< of all that follows
  std::condition_variable there_;
  std::deque<NavState> states_;
  std::deque<Alarm> alarms_;
  bool ended_ = false;
};

}  // namespace fathom::python
