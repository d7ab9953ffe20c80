#pragma once

#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// MAVLink 1 and 2, the telemetry of an autopilot, as instruments of last resort. The autopilot (component 1)
/// of `mavlink_system` counts, or of the first system that is heard. Signatures are not checked.
///
/// - ATTITUDE: heading, from true north as the autopilot believes it.
/// - SCALED_IMU: rates and specific force, forward-right-down, in steps of 1 mrad/s and 1 mg.
/// - GPS_RAW_INT: fix, velocity over ground from speed and course (no vertical one), `h_acc` of both axes.
/// - SCALED_PRESSURE2: depth, from the second barometer, that of the water on ArduSub.
/// - DISTANCE_SENSOR: height above the bottom, of a sensor that looks down, within its range.
///
/// Time: milliseconds since the autopilot started, as free-running clock; for GPS_RAW_INT UTC where it says
/// so.
[[nodiscard]] std::unique_ptr<Codec> make_mavlink(const CodecOptions& options);

}  // namespace fathom::codec
