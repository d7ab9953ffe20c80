#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "codec/registry.hpp"

namespace fathom::codec {

/// VectorNav VN-100/200/300: binary output frames with any selection of the fields of groups 1 to 7 (common,
/// time, IMU, GNSS1, attitude, INS, GNSS2), and the ASCII lines $VNYMR and $VNIMU. Other text is skipped.
///
/// Axes are the instrument's, forward-right-down. Uncompensated rate and specific force (factory calibration
/// only) are preferred to the compensated ones, from which the instrument has subtracted biases of its own:
/// two estimators must not chase the same bias. Increments are used where the frame has them; when it has
/// nothing else, rates are increments over their interval.
///
/// Fix: of the receiver in the unit (VN-200, VN-300), from Fix with PosLla or VelNed of the group GNSS1, or
/// GNSS2 in a stream without them; each fix once, however often frames repeat it (vectornav_fix.hpp).
/// Position and velocity are unknown where Fix says so; PosU and VelU are taken for one sigma of an axis, and
/// NumSats, which later manuals call tracked, for those used (VN-200 manual, UM004, GPS Solution). The group
/// INS, the unit's own filter, is not read. Of a frame with an inertial part and a fix, one of which cannot
/// be, the other one is kept; the frame is refused where nothing is left of it.
///
/// Time: TimeStartup as free-running clock (ns); UTC from TimeUtc or TimeGps where TimeStatus says that they
/// are valid. That of a fix is the receiver's, from Tow and Week, else TimeUtc, of its group, unless its
/// TimeInfo says that they are not valid.
[[nodiscard]] std::unique_ptr<Codec> make_vectornav(const CodecOptions& options);

/// CRC-16 of a binary frame (polynomial 0x1021, initially 0, not reflected) over the bytes after 0xFA. Over
/// bytes that end with their own CRC, high byte first, it is 0.
[[nodiscard]] std::uint16_t vectornav_crc16(std::span<const std::uint8_t> bytes);

}  // namespace fathom::codec
