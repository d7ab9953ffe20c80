#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/truth.hpp"
#include "samples/usbl.hpp"

namespace fathom::test {

/// Normal numbers that are the same with every compiler.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_(seed) {}
  double operator()(double sigma = 1.0) {
    const double a = (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
    const double b = (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
    return sigma * std::sqrt(-2.0 * std::log(a)) * std::cos(6.283185307179586 * b);
  }
  Eigen::Vector3d vector(double sigma = 1.0) {
    const double x = (*this)(sigma);
    const double y = (*this)(sigma);
    return {x, y, (*this)(sigma)};
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }

 private:
  std::mt19937_64 engine_;
};

/// A motion given by its speed along the body's x axis and its Euler angles as functions of time. What the
/// sensors of an ideal vehicle see follows by differentiating, with the Earth's rotation and shape; nothing
/// of the estimator's mechanisation is used.
class AnalyticVehicle {
 public:
  struct Motion {
    std::function<double(double)> speed_m_s;
    std::function<Eigen::Vector3d(double)> rpy_rad;
  };

  AnalyticVehicle(Motion motion, const geo::Geodetic& start, double step_s)
      : motion_(std::move(motion)), position_(start), step_s_(step_s) {}

  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] const geo::Geodetic& position() const { return position_; }
  [[nodiscard]] Eigen::Vector3d rpy_rad() const { return motion_.rpy_rad(time_s_); }
  [[nodiscard]] Eigen::Matrix3d C_NB() const { return attitude(time_s_); }
  [[nodiscard]] Eigen::Vector3d v_N_m_s() const { return velocity(time_s_); }
  [[nodiscard]] Eigen::Vector3d rate_ib_B_rad_s() const { return rate(time_s_, position_); }
  [[nodiscard]] Eigen::Vector3d rate_nb_B_rad_s() const;
  [[nodiscard]] Eigen::Vector3d force_B_m_s2() const { return force(time_s_, position_); }

  /// Moves on by one step and gives the integrals of rate and specific force over it (Gauss-Legendre,
  /// 3 points).
  void step(Eigen::Vector3d& dtheta_rad, Eigen::Vector3d& dv_m_s);

 private:
  [[nodiscard]] Eigen::Matrix3d attitude(double t) const;
  [[nodiscard]] Eigen::Vector3d velocity(double t) const;
  [[nodiscard]] Eigen::Vector3d rate(double t, const geo::Geodetic& at) const;
  [[nodiscard]] Eigen::Vector3d force(double t, const geo::Geodetic& at) const;

  Motion motion_;
  geo::Geodetic position_;
  double step_s_;
  double time_s_ = 0.0;
  std::int64_t steps_ = 0;
};

}  // namespace fathom::test
