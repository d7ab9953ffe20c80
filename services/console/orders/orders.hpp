#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "console/orders/roles.hpp"
#include "samples/command.hpp"
#include "samples/position/fix.hpp"

namespace fathom::console {

/// What becomes of an order that came in by HTTP.
struct OrderJudgement {
  int status = 400;                ///< of the HTTP answer: 200 only when there is a command
  std::string text;                ///< one sentence for the operator and the log
  std::optional<Command> command;  ///< without header; absent when refused
  std::optional<FixSample> fix{};  ///< instead of a command; of its header only the sensor is there
  double age_s = 0.0;              ///< of the fix: how long ago the vehicle was there
  bool confirm = false;            ///< it was passed on, and waits until it is given once more, confirmed
};

/// Judges the body of an order, e.g. {"kind": "acknowledge_alarm", "target": "gps_outage"} or
/// {"kind": "set_position", "lat_deg": 36.4, "lon_deg": 127.4, "depth_m": 5, "sigma_m": 10}, with
/// "confirmed": true when it is far from where navigation is and was ordered before. Or a position that
/// somebody tells, judged by navigation like any other measurement: {"kind": "fix", "lat_deg": 36.4,
/// "lon_deg": 127.4, "sigma_m": 20, "age_s": 600}, and where they are known "depth_m" and, when it is not
/// "operator" who says so, "from". Strict: a key that the kind does not know is refused.
[[nodiscard]] OrderJudgement judge_order(std::string_view body, const Identity& who, bool orders_enabled);

/// The words for the log: kind and target or position.
[[nodiscard]] std::string describe(const Command& command);
[[nodiscard]] std::string describe(const FixSample& fix, double age_s);

}  // namespace fathom::console
