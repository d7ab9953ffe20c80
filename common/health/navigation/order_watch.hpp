#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/command.hpp"
#include "samples/nav_state.hpp"

namespace fathom::health {

/// Distance between an ordered position and a navigation state.
struct Departure {
  double apart_m = 0.0;    ///< horizontally
  double allowed_m = 0.0;  ///< allowed_departure_m()
  [[nodiscard]] bool far() const { return apart_m > allowed_m; }
};
/// The departure of an order. None when the state has no position, or when it is not an order of a position.
[[nodiscard]] std::optional<Departure> departure(const Command& order, const NavState& state);

/// A watch for orders of a position far from where navigation is: "position_order_held", a warning, when
/// fusion waits for the confirmation, and "position_order_far", critical, when the confirmation comes. Both
/// are events and stay until they are acknowledged.
class OrderWatch {
 public:
  void add(const NavState& state);
  void apply(const Command& order, AlarmBook& book, const Instant& now) const;

 private:
  static constexpr DurationNs kApart_ns = 50 * kNsPerMillisecond;
  static constexpr std::size_t kKept = 100;
  std::deque<NavState> states_;  ///< of the last seconds, because the newest state holds the order already
};

}  // namespace fathom::health
