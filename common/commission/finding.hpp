#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/unknown.hpp"

namespace fathom::commission {

/// What a finding is about.
enum class FindingKind : std::uint8_t {
  axes,
  sign,
  unit,
  rate,
  convention,
  mounting,
  lever,
  latency,
  noise,
  instability,
  bias,
  scale,
  deviation,
  datum,
  missing,
};

/// "axes", "sign", ...
[[nodiscard]] std::string_view to_string(FindingKind kind);

enum class Severity : std::uint8_t {
  ok,     ///< as configured, or nothing to compare with
  note,   ///< differs, and navigation bears it
  wrong,  ///< navigation will be wrong
};
[[nodiscard]] std::string_view to_string(Severity severity);

/// One thing that a log tells, or cannot tell, about an instrument.
struct Finding {
  std::string sensor;  ///< word of its kind: "imu", "gps", ...
  std::string what;    ///< the quantity, e.g. "gyro_axes", "lever_x", "latency"
  FindingKind kind = FindingKind::missing;
  double value = kUnknown;  ///< in `unit`
  std::string unit;         ///< SI, degrees for angles; empty for a plain number
  double sigma = kUnknown;  ///< one standard deviation of value
  bool known = false;       ///< false: the log cannot tell, and text says what would
  Severity severity = Severity::ok;
  std::string text;  ///< one plain sentence or two
};

using Findings = std::vector<Finding>;

/// Whether any finding is wrong.
[[nodiscard]] bool any_wrong(const Findings& findings);

}  // namespace fathom::commission
