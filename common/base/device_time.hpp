#pragma once

#include <optional>

#include "base/time.hpp"

namespace fathom {

/// What a device's frame says about its instant of validity. runtime/device_time.hpp turns it into a stamp.
struct DeviceTime {
  /// UTC that the device itself gives (GPS, a disciplined clock).
  std::optional<TimeNs> utc_ns;
  /// A free-running clock of the device (since start, or a calendar clock nobody sets): only differences
  /// count.
  std::optional<TimeNs> clock_ns;
  /// UTC time of day without a date (NMEA); the date is completed from the arrival.
  std::optional<DurationNs> time_of_day_ns;
  /// How long before its transmission the sample was valid, where the frame says so.
  std::optional<DurationNs> age_ns;
};

}  // namespace fathom
