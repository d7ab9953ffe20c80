#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "commission/assumed.hpp"
#include "commission/finding.hpp"
#include "commission/fit/allan.hpp"
#include "dataset/dataset.hpp"

/// What a log tells about the instruments of a vehicle, and what it cannot tell. Pure: the log is an
/// argument.
namespace fathom::commission {

/// What the configuration should say instead; unset: as it is, or not known well enough.
struct Patch {
  std::optional<double> imu_rate_hz;
  std::optional<Eigen::Matrix3d> C_BI;  ///< inertial unit's axes into body
  std::optional<Eigen::Matrix3d> C_BD;  ///< DVL's axes into body
  std::optional<Eigen::Vector3d> gps_lever_B_m, dvl_lever_B_m;
  std::optional<double> gps_latency_s, dvl_latency_s, depth_latency_s, heading_latency_s;
  std::optional<double> heading_yaw_rad;       ///< of its north in the body
  std::optional<double> angle_random_walk;     ///< rad/sqrt(s)
  std::optional<double> velocity_random_walk;  ///< (m/s)/sqrt(s)
  [[nodiscard]] bool empty() const;
};

struct Commissioning {
  Findings findings;
  Patch patch;
  std::array<std::vector<AllanPoint>, 3> gyro_allan;   ///< rad/s; empty without rest
  std::array<std::vector<AllanPoint>, 3> force_allan;  ///< m/s^2
  double duration_s = 0.0;
  double rest_s = 0.0;  ///< the longest rest
};

/// Precondition: data has at least one inertial sample.
[[nodiscard]] Commissioning commission(const dataset::Dataset& data, const Assumed& assumed);

}  // namespace fathom::commission
