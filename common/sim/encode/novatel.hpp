#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::sim::encode {

/// What the headers of a receiver's logs say; as it is, that of a primary antenna on COM1 with steered time.
struct NovatelHeader {
  std::uint8_t message_type = 0;
  std::uint8_t time_status = 180;  ///< FINESTEERING
};

/// A log of any kind, in whole milliseconds.
[[nodiscard]] std::vector<std::uint8_t> novatel_log(std::uint16_t message, TimeNs utc_ns,
                                                    std::span<const std::uint8_t> data,
                                                    const NovatelHeader& header = {});
/// The same with the short header, as of inertial measurements. Precondition: 255 bytes at most.
[[nodiscard]] std::vector<std::uint8_t> novatel_short_log(std::uint16_t message, TimeNs utc_ns,
                                                          std::span<const std::uint8_t> data);

/// BESTPOS: undulation and sigmas in single precision. A fix in two dimensions is sent as one of a height
/// that is held, a time alone as no solution.
[[nodiscard]] std::vector<std::uint8_t> novatel_position(const GpsSample& sample, TimeNs utc_ns,
                                                         const NovatelHeader& header = {});
/// BESTVEL, which has no accuracy; an unknown velocity is no solution.
[[nodiscard]] std::vector<std::uint8_t> novatel_velocity(const GpsSample& sample, TimeNs utc_ns,
                                                         const NovatelHeader& header = {});
/// TIME with valid UTC and 18 leap seconds.
[[nodiscard]] std::vector<std::uint8_t> novatel_time(TimeNs utc_ns);

enum class NovatelHeadingLog : std::uint16_t { heading2 = 1335, dual_antenna = 2042 };
/// DUALANTENNAHEADING or HEADING2 in single precision, level, of a line of 1 m. A magnetic heading is sent as
/// the true one by its variation; an unknown one is no solution.
[[nodiscard]] std::vector<std::uint8_t> novatel_heading(
    const HeadingSample& sample, TimeNs utc_ns, NovatelHeadingLog log = NovatelHeadingLog::dual_antenna);

/// An epoch: BESTVEL and BESTPOS.
[[nodiscard]] std::vector<std::uint8_t> novatel_epoch(const GpsSample& sample, TimeNs utc_ns);

}  // namespace fathom::sim::encode
