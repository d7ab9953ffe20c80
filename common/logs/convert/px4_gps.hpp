#pragma once

#include <optional>

#include "logs/convert/build.hpp"
#include "logs/convert/vehicle.hpp"

namespace fathom::logs {

/// UTC of the autopilot's start: the middle of what its GPS messages say. Nothing without one.
[[nodiscard]] std::optional<TimeNs> px4_utc_of_start(const Log& log);

/// gps.csv, and heading.csv of a receiver with two antennas.
void px4_gps(const Log& log, const Clock& clock, const ConvertOptions& options, Vehicle& out);

}  // namespace fathom::logs
