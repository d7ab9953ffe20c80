#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::sim::encode {

/// A block of any number: header, time of the week in whole milliseconds, week, `body`, and what fills it up
/// to a multiple of four bytes.
[[nodiscard]] std::vector<std::uint8_t> sbf_block(std::uint16_t number, unsigned revision, TimeNs utc_ns,
                                                  std::span<const std::uint8_t> body);

/// PVTGeodetic of revision 2: coordinates in double precision, velocity, course and undulation in single
/// precision, accuracies in centimetres. A time alone is no solution. HAccuracy is that of the horizontal
/// sigmas.
[[nodiscard]] std::vector<std::uint8_t> sbf_pvt_geodetic(const GpsSample& sample, TimeNs utc_ns);

/// PosCovGeodetic and VelCovGeodetic with the variances, in single precision, without what they have in
/// common.
[[nodiscard]] std::vector<std::uint8_t> sbf_position_covariance(const GpsSample& sample, TimeNs utc_ns);
[[nodiscard]] std::vector<std::uint8_t> sbf_velocity_covariance(const GpsSample& sample, TimeNs utc_ns);

/// AttEuler with fixed ambiguities, in single precision, without pitch. A magnetic heading is sent as the
/// true one by its variation; an unknown one is no attitude.
[[nodiscard]] std::vector<std::uint8_t> sbf_att_euler(const HeadingSample& sample, TimeNs utc_ns);
[[nodiscard]] std::vector<std::uint8_t> sbf_att_covariance(const HeadingSample& sample, TimeNs utc_ns);

/// ReceiverTime, with UTC in whole seconds.
[[nodiscard]] std::vector<std::uint8_t> sbf_receiver_time(TimeNs utc_ns, std::int8_t leap_seconds);

/// EndOfPVT and EndOfAtt.
[[nodiscard]] std::vector<std::uint8_t> sbf_end_of_pvt(TimeNs utc_ns);
[[nodiscard]] std::vector<std::uint8_t> sbf_end_of_att(TimeNs utc_ns);

/// What a receiver sends of an epoch: PVTGeodetic, both covariances and EndOfPVT; of an attitude AttEuler,
/// AttCovEuler and EndOfAtt.
[[nodiscard]] std::vector<std::uint8_t> sbf_epoch(const GpsSample& sample, TimeNs utc_ns);
[[nodiscard]] std::vector<std::uint8_t> sbf_attitude_epoch(const HeadingSample& sample, TimeNs utc_ns);

}  // namespace fathom::sim::encode
