#pragma once

#include <Eigen/Core>

#include "base/unknown.hpp"

namespace fathom::commission {

/// What the configuration says of an instrument: the hypothesis that the log is held against.
struct AssumedInstrument {
  bool configured = false;  ///< false: nothing was said, the figures below are zero
  Eigen::Vector3d lever_B_m = Eigen::Vector3d::Zero();  ///< from the inertial unit
  Eigen::Matrix3d C_BD = Eigen::Matrix3d::Identity();   ///< instrument's axes D into body B
  double latency_s = 0.0;                               ///< subtracted from the stamp
  Eigen::Vector3d sigma{kUnknown, kUnknown, kUnknown};  ///< noise, SI unit of the kind
  Eigen::Vector3d velocity_sigma_m_s{kUnknown, kUnknown, kUnknown};
};

struct Assumed {
  bool configured = false;                             ///< false: there is no configuration
  double imu_rate_hz = kUnknown;                       ///< nominal
  bool imu_point_samples = false;                      ///< rates at the stamp instead of means
  Eigen::Matrix3d C_BI = Eigen::Matrix3d::Identity();  ///< inertial unit's axes I into body B
  double angle_random_walk = kUnknown;                 ///< rad/sqrt(s)
  double velocity_random_walk = kUnknown;              ///< (m/s)/sqrt(s)
  double variation_rad = kUnknown;                     ///< magnetic, east positive, where configured
  AssumedInstrument gps, dvl, depth, heading;
};

}  // namespace fathom::commission
