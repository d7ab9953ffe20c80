#include "commission/explanation.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "commission/fit/signed_axes.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDeparture = 10.0;  // log odds against an instrument that is not as configured
// Units of a departure.
constexpr double kNotUp = 1.5;     // gravity is felt downwards
constexpr double kNotAhead = 2.5;  // it goes where its bow does not point: rather are two turned alike

Matrix3d about_z(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()).toRotationMatrix();
}

// A direction that has to be ahead is nearer to another axis, and the log tells it.
bool is_not_ahead(const Vector3d& direction_B, double sigma_rad) {
  const double beyond = std::atan2(direction_B.tail<2>().norm(), direction_B.x()) - 0.25 * std::numbers::pi;
  return beyond > std::sqrt(2.0 * kReject) * sigma_rad;
}

// Instruments that are not as configured, in units of a departure.
double faults(const Matrix3d& gyro, const Matrix3d& force, double force_sign, const Seen& seen) {
  const bool gyro_as_is = gyro.isIdentity(1e-9);
  const bool force_as_is = force.isIdentity(1e-9);
  const bool both_alike = gyro.isApprox(force, 1e-9);
  double out = both_alike ? (gyro_as_is ? 0.0 : 1.0) : (gyro_as_is ? 0.0 : 1.0) + (force_as_is ? 0.0 : 1.0);
  // Gravity is felt upwards; a vehicle goes where its bow points.
  if ((force * seen.mean_force).z() > -0.5 * seen.mean_force.norm()) out += kNotUp;
  const Matrix3d turn = force_sign * force;
  if (seen.way.direction_B.norm() > kSteady && is_not_ahead(turn * seen.way.direction_B, seen.way.sigma_rad))
    out += kNotAhead;
  if (seen.compass.direction_B.norm() > kSteady &&
      is_not_ahead(about_z(-seen.compass_yaw_rad) * turn * seen.compass.direction_B, seen.compass.sigma_rad))
    out += 1.0;
  if (seen.dvl && !nearest_signed_axes(force * *seen.dvl).isIdentity(1e-9)) out += 1.0;
  return out;
}

}  // namespace

Explanation explain(const std::vector<ReadingClass>& classes, const Seen& seen) {
  Explanation best;
  double least = std::numeric_limits<double>::max();
  double best_faults = 0.0;
  double best_sign = 1.0;
  for (const ReadingClass& each : classes) {
    if (each.against > kReject) continue;
    for (const Matrix3d& Q : signed_axes()) {
      if (Q.determinant() < 0.0) continue;
      const Matrix3d force = each.force_sign * Q;
      const Matrix3d gyro = Q * each.gyro;
      const double now = faults(gyro, force, each.force_sign, seen);
      const double cost =
          now + 1e-3 * (3.0 - gyro.trace()) + 1e-3 * (3.0 - force.trace()) + each.against / kDeparture;
      if (cost >= least) continue;
      least = cost;
      best_faults = now;
      best_sign = each.force_sign;
      best.gyro = gyro;
      best.force = force;
    }
  }
  for (const double turn_deg : {90.0, -90.0, 180.0}) {
    const Matrix3d turn = about_z(turn_deg / 180.0 * std::numbers::pi);
    if (best.rival_turn_deg || faults(turn * best.gyro, turn * best.force, best_sign, seen) > best_faults)
      continue;
    best.rival_turn_deg = turn_deg;
  }
  return best;
}

}  // namespace fathom::commission
