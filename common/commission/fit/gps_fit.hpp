#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "commission/fit/strapdown.hpp"
#include "commission/fit/window_fit.hpp"

namespace fathom::commission {

/// Sums of squares that an inertial unit leaves against the velocity of GPS, m^2/s^2, with what the model
/// neglects.
struct GpsSquares {
  double as_read = 0.0;
  double force_negated = 0.0;  ///< were every specific force the negative of what was read
};
/// Of a unit so read: each window may turn freely. `latency_s` is subtracted from the stamps of GPS. Where
/// both are beyond `enough`, further windows are left out.
[[nodiscard]] GpsSquares gps_squares(const Series& series, const GpsVelocity& velocity_N,
                                     const std::vector<Span>& windows, const ImuReading& reading,
                                     double latency_s,
                                     double enough = std::numeric_limits<double>::infinity());

/// The attitude of the body at one instant.
struct AttitudeAt {
  double t_s = 0.0;
  Eigen::Matrix3d C_NB = Eigen::Matrix3d::Identity();
};

/// A direction in body axes, the mean of many windows.
struct Ahead {
  Eigen::Vector3d direction_B = Eigen::Vector3d::Zero();  ///< unit or shorter, the steadier the longer
  double sigma_rad = 1e9;                                 ///< of the mean
};

/// What IMU and GPS together tell.
struct GpsFit {
  bool done = false;
  Eigen::Vector3d lever_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_sigma_m = Eigen::Vector3d::Constant(1e9);
  double latency_s = 0.0;
  double latency_sigma_s = 1e9;
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();  ///< beyond that of the reading
  Eigen::Vector3d rate_bias_sigma = Eigen::Vector3d::Zero();
  double residual_m_s = 0.0;
  std::size_t windows = 0;
  /// Direction in which the vehicle goes. Zero where the log does not tell that it has one: its courses turn
  /// with it.
  Ahead way;
  /// Direction that the compass takes for ahead. Zero where few windows tell.
  Ahead compass;
  std::optional<AttitudeAt> attitude;  ///< where the velocity changed most
};
[[nodiscard]] GpsFit fit_gps(const Series& series, const GpsVelocity& velocity_N,
                             const std::vector<Span>& windows, const ImuReading& reading, double latency_s,
                             const Eigen::Vector3d& lever_B_m);

}  // namespace fathom::commission
