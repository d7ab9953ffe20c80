#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geo/wgs84.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::test {

/// Strapdown navigation in the Earth-fixed frame from inertial increments: a second way to the trajectory
/// that shares only the gravity model with the simulator, which works in north-east-down.
class EcefIntegrator {
 public:
  explicit EcefIntegrator(const sim::TruthPoint& start) {
    const Eigen::Matrix3d C_EN = axes(start.latitude_rad, start.longitude_rad);
    r_E_ = position(start.latitude_rad, start.longitude_rad, start.altitude_m);
    v_E_ = C_EN * start.v_N_m_s;
    q_EB_ = Eigen::Quaterniond(C_EN) * start.q_NB;
  }

  void add(const sim::ImuTruth& imu) {
    const Eigen::Vector3d a = imu.delta_angle_B_rad;
    const Eigen::Vector3d v = imu.delta_velocity_B_m_s;
    const double h = imu.dt_s;
    const Eigen::Vector3d omega_E{0.0, 0.0, geo::kEarthRate_rad_s};
    const Eigen::Vector3d thrust = v + 0.5 * a.cross(v) + (a_before_.cross(v) + v_before_.cross(a)) / 12.0;
    const Eigen::Vector3d turned = a + a_before_.cross(a) / 12.0;
    const Eigen::Vector3d thrust_E = q_EB_ * thrust;
    const Eigen::Vector3d pushed = thrust_E - 0.5 * h * omega_E.cross(thrust_E);
    // Gravity and Coriolis at the middle of the interval, from a first guess of the velocity there.
    const Eigen::Vector3d v_guess = v_E_ + 0.5 * (pushed + h * (gravity(r_E_) - 2.0 * omega_E.cross(v_E_)));
    const Eigen::Vector3d r_guess = r_E_ + 0.5 * h * v_guess;
    const Eigen::Vector3d v_next = v_E_ + pushed + h * (gravity(r_guess) - 2.0 * omega_E.cross(v_guess));
    r_E_ += 0.5 * h * (v_E_ + v_next);
    v_E_ = v_next;
    q_EB_ = (exp(-h * omega_E) * q_EB_ * exp(turned)).normalized();
    a_before_ = a;
    v_before_ = v;
  }

  [[nodiscard]] double position_error_m(const sim::TruthPoint& truth) const {
    return (r_E_ - position(truth.latitude_rad, truth.longitude_rad, truth.altitude_m)).norm();
  }
  [[nodiscard]] double velocity_error_m_s(const sim::TruthPoint& truth) const {
    return (v_E_ - axes(truth.latitude_rad, truth.longitude_rad) * truth.v_N_m_s).norm();
  }
  [[nodiscard]] double attitude_error_rad(const sim::TruthPoint& truth) const {
    const Eigen::Quaterniond q_EB =
        Eigen::Quaterniond(axes(truth.latitude_rad, truth.longitude_rad)) * truth.q_NB;
    return q_EB.angularDistance(q_EB_);
  }

 private:
  static Eigen::Quaterniond exp(const Eigen::Vector3d& rotation) {
    const double angle = rotation.norm();
    if (angle == 0.0) return Eigen::Quaterniond::Identity();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle));
  }

  /// Columns: north, east, down in Earth-fixed axes.
  static Eigen::Matrix3d axes(double lat, double lon) {
    Eigen::Matrix3d out;
    out << -std::sin(lat) * std::cos(lon), -std::sin(lon), -std::cos(lat) * std::cos(lon),
        -std::sin(lat) * std::sin(lon), std::cos(lon), -std::cos(lat) * std::sin(lon), std::cos(lat), 0.0,
        -std::sin(lat);
    return out;
  }

  static Eigen::Vector3d position(double lat, double lon, double alt) {
    const double e2 = geo::kEccentricitySquared;
    const double n = geo::kSemiMajorAxis_m / std::sqrt(1.0 - e2 * std::sin(lat) * std::sin(lat));
    return {(n + alt) * std::cos(lat) * std::cos(lon), (n + alt) * std::cos(lat) * std::sin(lon),
            (n * (1.0 - e2) + alt) * std::sin(lat)};
  }

  static Eigen::Vector3d gravity(const Eigen::Vector3d& r) {
    const double e2 = geo::kEccentricitySquared;
    const double p = std::hypot(r.x(), r.y());
    double lat = std::atan2(r.z(), p * (1.0 - e2));
    double alt = 0.0;
    for (int i = 0; i < 5; ++i) {
      const double n = geo::kSemiMajorAxis_m / std::sqrt(1.0 - e2 * std::sin(lat) * std::sin(lat));
      alt = p / std::cos(lat) - n;
      lat = std::atan2(r.z(), p * (1.0 - e2 * n / (n + alt)));
    }
    return axes(lat, std::atan2(r.y(), r.x())) * geo::gravity_N(lat, alt);
  }

  Eigen::Vector3d r_E_;
  Eigen::Vector3d v_E_;
  Eigen::Quaterniond q_EB_;
  Eigen::Vector3d a_before_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_before_ = Eigen::Vector3d::Zero();
};

}  // namespace fathom::test
