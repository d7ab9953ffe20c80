#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "samples/gps.hpp"

namespace fathom::codec {

/// A solution of a u-blox receiver: its own message NAV-PVT, and item 0x7010 of an Xsens unit with one
/// inside.
struct Pvt {
  /// The fields that both have in the same places, in either byte order. Precondition: kCommon bytes.
  Pvt(Bytes fields, std::endian order);
  static constexpr std::size_t kCommon = 72;

  CivilTime civil;        ///< UTC; its nanoseconds may be negative
  std::uint8_t valid;     ///< bits: date, time, resolved to the second
  std::uint8_t fix_type;  ///< 0 none, 1 dead reckoning, 2 in the plane, 3 in space, 4 3 with 1, 5 time only
  std::uint8_t flags;     ///< bit 0 within its limits, 1 corrected; from 6 on carrier phase: 1 float, 2 fixed
  double longitude_deg;
  double latitude_deg;
  double height_m;  ///< above the ellipsoid
  double height_msl_m;
  double horizontal_accuracy_m;  ///< a radius
  double vertical_accuracy_m;
  std::array<double, 3> velocity_N_m_s;
  double course_deg;
  double speed_accuracy_m_s;

  // What each has in a place of its own.
  std::uint8_t satellites = 0;
  bool position_invalid = false;
  double hdop = kUnknown;
};

/// Why the solution is refused; nothing when it is good. Position and velocity stay unknown unless the
/// receiver declares the fix within its limits and the position valid. One horizontal axis has the accuracy
/// over sqrt(2). UTC is given only when fully resolved.
[[nodiscard]] std::optional<RejectReason> read_pvt(const Pvt& pvt, GpsSample& sample, DeviceTime& time);

}  // namespace fathom::codec
