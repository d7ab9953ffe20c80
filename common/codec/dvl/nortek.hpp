#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Nortek DVLs (DVL333, 500, 1000): the binary records DF21 of the bottom track (0x1B) and DF22 of the water
/// track (0x1D), which have one layout. Other records of the AD2CP family are good frames without sample.
///
/// Layout and units: nortekdvl1000_structs.h of WHOI's ds_sensors and dvl_data.h of SONIA's provider_dvl,
/// which agree.
///
/// Axes: X forward, Y to the right, Z out of the transducers' face, so down. The velocity is the instrument's
/// over ground or through water, and is taken as it is. (Nortek, manual of the DVL 1000, 2017, 6.2
/// "Coordinate System": right-handed, a bottom track in beams positive when the motion is towards the
/// transducer; osu-uwrt/nortek_dvl turns Y and Z to have forward, left, up.) A recorded beam velocity is that
/// of the instrument along the outward beam, and the beams 1 to 4 look towards 45, -45, -135 and 135 degrees
/// from X, clockwise seen from above (GSO-soslab/nortek_dvl). A recording over a sloping bottom confirms the
/// signs. What lies between X and the vehicle's forward is the mounting's. The record does not say the beam
/// angle: it is nominally 25 degrees.
///
/// Each number is known where its bit of the status is set; a beam or an axis that is lost takes no other one
/// with it. Down is the mean of Z1 (beams 1 and 3) and Z2 (beams 2 and 4) where both are good, else the good
/// one. The error velocity is their difference, in the measure of PD0's; unknown with less than four beams.
/// sigma_m_s is the root mean square of the figures of merit of X and Y: the noise of a single ping as
/// standard deviation (Nortek's answer "DVL1000 Data Questions" of 2017 in its forum; those of the axes
/// follow from those of the beams as variances do). beam_range_m is the vertical distance of each beam,
/// altitude_m their mean; the water track has neither.
///
/// Time: that of the trigger on the instrument's calendar clock, which nobody needs to have set, and dt1 from
/// the trigger to the centre of the echo, as free-running clock. Its age is dt2, from the centre of the echo
/// to the start of the output. Both are those of the first of X, Y, Z1, Z2 and the beams that is good.
[[nodiscard]] std::unique_ptr<Codec> make_nortek(const CodecOptions& options);

namespace nortek {

/// The sum of the little-endian words and of 0xB58C; an odd last byte is the high one of its word.
[[nodiscard]] std::uint16_t checksum(std::span<const std::uint8_t> bytes);

}  // namespace nortek
}  // namespace fathom::codec
