#pragma once

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {

/// What instruments said last while there was no attitude yet, kept for a start. Instants are those of
/// validity; 0: never.
struct UnderWay {
  TimeNs heading_ns = 0;
  double heading_rad = kUnknown;  ///< true, of the body
  double heading_sigma_rad = kUnknown;
  bool two_antenna = false;  ///< the heading is that of two GPS antennas
  TimeNs dvl_ns = 0;
  Eigen::Vector3d dvl_velocity_B_m_s = Eigen::Vector3d::Zero();  ///< over ground
  Eigen::Vector3d dvl_lever_B_m = Eigen::Vector3d::Zero();
  double dvl_sigma_m_s = kUnknown;
  TimeNs usbl_ns = 0;
  double usbl_latitude_rad = kUnknown;
  double usbl_longitude_rad = kUnknown;
  double usbl_depth_m = kUnknown;
  double usbl_sigma_m = kUnknown;
  Eigen::Vector3d usbl_lever_B_m = Eigen::Vector3d::Zero();
  bool usbl_agrees = false;  ///< with the fix before it
  /// What the place is wrong by, per radian that the transceiver is turned about its axes.
  Eigen::Matrix3d usbl_turned_N_m = Eigen::Matrix3d::Zero();
  TimeNs depth_ns = 0;
  double depth_m = kUnknown;
};

}  // namespace fathom::estimation
