#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// What `relative_m` of a USBL fix is measured along.
enum class UsblFrame : std::uint8_t {
  geodetic = 0,    ///< latitude_rad, longitude_rad, depth_m
  ned = 1,         ///< north, east, down from the transceiver
  vessel_frd = 2,  ///< forward, right, down from the transceiver, along the vessel
};

/// An acoustic fix of a transponder: absolute, or relative to the transceiver whose own position is then
/// needed.
struct UsblSample {
  SampleHeader header;
  UsblFrame frame = UsblFrame::geodetic;
  Name transponder;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double depth_m = kUnknown;
  std::array<double, 3> relative_m{kUnknown, kUnknown, kUnknown};
  double sigma_m = kUnknown;        ///< horizontal, one axis
  double travel_time_s = kUnknown;  ///< one way
};

}  // namespace fathom
