#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "console/orders/roles.hpp"
#include "samples/command.hpp"

namespace fathom::console {

/// What becomes of an order that came in by HTTP.
struct OrderJudgement {
  int status = 400;                ///< of the HTTP answer: 200 only when there is a command
  std::string text;                ///< one sentence for the operator and the log
  std::optional<Command> command;  ///< without header; absent when refused
  bool confirm = false;            ///< it was passed on, and waits until it is given once more, confirmed
};

/// Judges the body of an order, e.g. {"kind": "acknowledge_alarm", "target": "gps_outage"} or
/// {"kind": "set_position", "lat_deg": 36.4, "lon_deg": 127.4, "depth_m": 5, "sigma_m": 10}, with
/// "confirmed": true when it is far from where navigation is and was ordered before. Strict: a key that the
/// kind does not know is refused.
[[nodiscard]] OrderJudgement judge_order(std::string_view body, const Identity& who, bool orders_enabled);

/// The words for the log: kind and target or position.
[[nodiscard]] std::string describe(const Command& command);

}  // namespace fathom::console
