#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/result.hpp"
#include "base/time.hpp"
#include "health/navigation/order_watch.hpp"
#include "samples/command.hpp"
#include "samples/position/fix.hpp"

/// Orders as people and programs write them. Who may give one is judged where it comes in.
namespace fathom::orders {

/// A position that somebody tells, judged by navigation like any other measurement.
struct ToldFix {
  FixSample fix;       ///< of its header only the sensor is there: who says so
  double age_s = 0.0;  ///< how long ago the vehicle was there
};
/// A command is without its header.
using Order = std::variant<Command, ToldFix>;

/// Reads JSON, e.g. {"kind": "acknowledge_alarm", "target": "gps_outage"} or {"kind": "set_position",
/// "lat_deg": 36.4, "lon_deg": 127.4, "depth_m": 5, "sigma_m": 10}, with "confirmed": true when it is far
/// from where navigation is and was ordered before. Or a position: {"kind": "fix", "lat_deg": 36.4,
/// "lon_deg": 127.4, "sigma_m": 20, "age_s": 600}, and where they are known "depth_m" and, when it is not
/// "operator" who says so, "from". Strict: a key that the kind does not know is refused. The error is one
/// sentence.
[[nodiscard]] Result<Order> order_of(std::string_view text);

/// The words for a log: kind and target or position.
[[nodiscard]] std::string describe(const Command& command);
[[nodiscard]] std::string describe(const ToldFix& told);
[[nodiscard]] std::string describe(const Order& order);

/// What goes onto the vehicle network: of `header` all but the sensor, the sequence and the times.
[[nodiscard]] FixSample sample_of(const ToldFix& told, const SampleHeader& header, TimeNs now_ns);

/// Whether the order waits until it is given once more, confirmed. `departure`: of health::departure().
[[nodiscard]] bool waits_for_confirmation(const Command& order,
                                          const std::optional<health::Departure>& departure);
/// The sentence for whoever gives an order that waits, or that may wait because nothing is known here of
/// where navigation is; empty for every other order.
[[nodiscard]] std::string waiting_text(const Command& order,
                                       const std::optional<health::Departure>& departure);

}  // namespace fathom::orders
