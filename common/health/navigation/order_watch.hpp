#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/command.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

/// Distance between an ordered position and a navigation state.
struct Departure {
  double apart_m = 0.0;    ///< horizontally
  double allowed_m = 0.0;  ///< allowed_departure_m()
  [[nodiscard]] bool far() const { return apart_m > allowed_m; }
};
/// The departure of an order. None when the state has no position, or when it is not an order of a position.
[[nodiscard]] std::optional<Departure> departure(const Command& order, const NavState& state);

/// A watch for orders. Of a position far from where navigation is: "position_order_held", a warning, when
/// fusion waits for the confirmation, and "position_order_far", critical, when the confirmation comes. Of any
/// that a fusion says in its life sign not to have done: "order_refused", a warning. All are events and stay
/// until they are acknowledged.
class OrderWatch {
 public:
  void add(const NavState& state);
  void add(const ServiceStatus& status, AlarmBook& book, const Instant& now);
  void apply(const Command& order, AlarmBook& book, const Instant& now);

 private:
  static constexpr DurationNs kApart_ns = 50 * kNsPerMillisecond;
  static constexpr std::size_t kKept = 100;
  /// What a process has left undone since it was started.
  struct Undone {
    std::uint32_t pid = 0;
    TimeNs started_ns = 0;
    std::uint64_t orders = 0;
  };
  static constexpr std::size_t kMostServices = 64;
  std::map<Name, Undone> undone_;
  std::string last_;             ///< the newest order to navigation and who gave it, in words
  std::deque<NavState> states_;  ///< of the last seconds, because the newest state holds the order already
};

}  // namespace fathom::health
