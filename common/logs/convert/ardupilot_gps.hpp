#pragma once

#include <optional>

#include "logs/convert/build.hpp"
#include "logs/convert/vehicle.hpp"

namespace fathom::logs {

/// UTC of the autopilot's start, from week and millisecond of its GPS messages. Nothing without one.
[[nodiscard]] std::optional<TimeNs> ardupilot_utc_of_start(const Log& log);

/// gps.csv of GPS with the accuracies of GPA, and heading.csv of a receiver with two antennas.
void ardupilot_gps(const Log& log, const Clock& clock, const ConvertOptions& options, Vehicle& out);

}  // namespace fathom::logs
