#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// What an acoustic fix is measured along.
enum class UsblFrame : std::uint8_t {
  geodetic = 0,     ///< latitude_rad, longitude_rad, depth_m
  ned = 1,          ///< north, east, down from the station's transceiver
  vessel_frd = 2,   ///< forward, right, down from the station's transceiver, along the station
  vehicle_frd = 3,  ///< forward, right, down from the vehicle's own transceiver to the station (inverted)
};

/// An acoustic fix of a transponder: absolute, or relative to a station whose own place is needed. The
/// station is the ship or buoy that carries the transceiver; for a transceiver on the vehicle it is the
/// beacon. A relative fix is given by its components, or by range, bearing and depression, each of which may
/// be missing.
struct UsblSample {
  SampleHeader header;
  UsblFrame frame = UsblFrame::geodetic;
  Name transponder;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double depth_m = kUnknown;
  std::array<double, 3> relative_m{kUnknown, kUnknown, kUnknown};
  double range_m = kUnknown;         ///< slant
  double bearing_rad = kUnknown;     ///< from north or forward, towards east or right
  double depression_rad = kUnknown;  ///< below the horizontal of the frame
  double sigma_m = kUnknown;         ///< of one horizontal component; of the range
  double sigma_rad = kUnknown;       ///< of the direction, across it
  double travel_time_s = kUnknown;   ///< one way
  double station_latitude_rad = kUnknown;
  double station_longitude_rad = kUnknown;
  double station_depth_m = kUnknown;  ///< of its transceiver, or of the beacon
  std::array<double, 3> station_rpy_rad{kUnknown, kUnknown,
                                        kUnknown};  ///< attitude of the ship, for vessel_frd
};

}  // namespace fathom
