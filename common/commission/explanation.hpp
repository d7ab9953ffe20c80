#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "commission/fit/gps_fit.hpp"
#include "commission/fit/reject.hpp"

namespace fathom::commission {

/// Length of the mean direction of travel from which a vehicle has a bow.
inline constexpr double kSteady = 0.8;

/// One class of readings: gyro against accelerometer, and the accelerometer as it is or negated. A turn of
/// both together changes nothing of what GPS and DVL can say.
struct ReadingClass {
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Identity();
  double force_sign = 1.0;
  double gps = 0.0;      ///< squares that it leaves against GPS
  double dvl = 0.0;      ///< and against the DVL
  double heading = 0.0;  ///< and against the compass
  double against = 0.0;  ///< log likelihood ratio against the best
};

/// What the other instruments say of the axes in which the inertial unit is recorded.
struct Seen {
  Eigen::Vector3d mean_force = Eigen::Vector3d::Zero();
  Ahead way;                     ///< in which the vehicle goes
  Ahead compass;                 ///< which the compass takes for ahead
  double compass_yaw_rad = 0.0;  ///< of its mounting, as configured
  /// Turn or mirror of the DVL against how it is configured; nothing where the log does not tell.
  std::optional<Eigen::Matrix3d> dvl;
};

/// How the recording has to be read: right = matrix * recorded.
struct Explanation {
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d force = Eigen::Matrix3d::Identity();
  /// Turn of both about the vertical with which as few instruments are at fault, the least there is.
  std::optional<double> rival_turn_deg;
};

/// The explanation that finds fault with the fewest instruments; of equal ones that which turns least.
/// Precondition: one class at least is not refuted.
[[nodiscard]] Explanation explain(const std::vector<ReadingClass>& classes, const Seen& seen);

}  // namespace fathom::commission
