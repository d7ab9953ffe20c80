#pragma once

#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// IMU_SHORT as an Ellipse sends it: whole microseconds, forces and rates in counts. An axis that is unknown
/// has failed its test; a temperature that is unknown is sent as 0 degC. Rates beyond 32 rad/s go in the
/// coarse unit.
[[nodiscard]] std::vector<std::uint8_t> sbg_imu_short(const ImuSample& sample, DurationNs since_startup_ns);

/// IMU_DATA, in single precision.
[[nodiscard]] std::vector<std::uint8_t> sbg_imu_data(const ImuSample& sample, DurationNs since_startup_ns);

/// UTC_TIME of a unit whose clock has converged.
[[nodiscard]] std::vector<std::uint8_t> sbg_utc_time(TimeNs utc_ns, DurationNs since_startup_ns);

/// GPS1_POS, or GPS2_POS of receiver 2: the time of the week in whole milliseconds, undulation and sigmas in
/// single precision. A fix in two dimensions is sent as one in three, a time alone as no solution.
[[nodiscard]] std::vector<std::uint8_t> sbg_gps_position(const GpsSample& sample, TimeNs utc_ns,
                                                         DurationNs since_startup_ns, int receiver = 1);

/// GPS1_VEL or GPS2_VEL, in single precision; an unknown velocity is no solution.
[[nodiscard]] std::vector<std::uint8_t> sbg_gps_velocity(const GpsSample& sample, TimeNs utc_ns,
                                                         DurationNs since_startup_ns, int receiver = 1);

/// GPS1_HDT or GPS2_HDT, in single precision, without pitch. A magnetic heading is sent as the true one by
/// its variation; an unknown one is no solution.
[[nodiscard]] std::vector<std::uint8_t> sbg_gps_heading(const HeadingSample& sample, TimeNs utc_ns,
                                                        DurationNs since_startup_ns, int receiver = 1);

/// What a unit sends of an epoch of its receiver: UTC_TIME, GPS1_VEL and GPS1_POS.
[[nodiscard]] std::vector<std::uint8_t> sbg_epoch(const GpsSample& sample, TimeNs utc_ns,
                                                  DurationNs since_startup_ns);

/// A frame of any kind.
[[nodiscard]] std::vector<std::uint8_t> sbg_frame(std::uint8_t message, std::uint8_t message_class,
                                                  const std::vector<std::uint8_t>& data);

}  // namespace fathom::sim::encode
