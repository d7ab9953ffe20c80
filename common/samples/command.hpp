#pragma once

#include <cstdint>
#include <string_view>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

enum class CommandKind : std::uint8_t {
  set_position = 0,  ///< latitude_rad, longitude_rad, depth_m, sigma_m
  realign = 1,
  enable_source = 2,      ///< target: sensor name
  disable_source = 3,     ///< target: sensor name
  acknowledge_alarm = 4,  ///< target: alarm, "*" for all
  mark_at_rest = 5,       ///< value_s: for how long
};
[[nodiscard]] std::string_view to_string(CommandKind kind);

/// An order from an operator. header.sensor says who gives it; it takes effect at header.stamp_ns.
struct Command {
  SampleHeader header;
  CommandKind kind = CommandKind::acknowledge_alarm;
  Name target;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double depth_m = kUnknown;
  double sigma_m = kUnknown;
  double value_s = kUnknown;
  /// Of a position far from where navigation is: it was ordered before, and is meant.
  bool confirmed = false;
};

}  // namespace fathom
