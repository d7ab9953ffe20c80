#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "commission/assumed.hpp"
#include "dataset/dataset.hpp"

namespace fathom::commission {

/// Vectors over time, seconds since the first inertial sample. Times never decrease.
struct VectorSeries {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> v;
  [[nodiscard]] std::size_t size() const { return t_s.size(); }
};
/// Velocity over ground by GPS: north, east, down.
struct GpsVelocity : VectorSeries {
  bool has_down = true;  ///< false: down is unknown, and 0 in every row
  [[nodiscard]] int known_axes() const { return has_down ? 3 : 2; }
  /// A residual without what the receiver does not give.
  [[nodiscard]] Eigen::Vector3d measured(const Eigen::Vector3d& residual_N) const {
    return {residual_N.x(), residual_N.y(), has_down ? residual_N.z() : 0.0};
  }
};
struct ScalarSeries {
  std::vector<double> t_s;
  std::vector<double> v;
  [[nodiscard]] std::size_t size() const { return t_s.size(); }
};

/// The inertial unit: rates and specific forces in body axes as configured, at the same instants.
struct ImuSeries {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> rate;   ///< rad/s, as labelled
  std::vector<Eigen::Vector3d> force;  ///< m/s^2, as labelled
  [[nodiscard]] std::size_t size() const { return t_s.size(); }
};

/// A log as numbers: what every test of commissioning works on.
struct Series {
  TimeNs epoch_ns = 0;  ///< of t_s = 0
  ImuSeries imu;
  VectorSeries gps_position;                 ///< north, east, down from the first fix, m
  GpsVelocity gps_velocity;                  ///< m/s, as labelled; empty where unknown
  std::vector<double> gps_position_sigma_m;  ///< horizontal, of each position; may be unknown
  bool gps_rtk = false;                      ///< most fixes are carrier-phase fixed
  double latitude_rad = kUnknown;
  double first_altitude_m = kUnknown;
  VectorSeries dvl;      ///< over the bottom, in its own axes D, m/s
  ScalarSeries depth;    ///< m, down positive, as labelled
  ScalarSeries heading;  ///< rad, unwrapped
  bool heading_magnetic = false;
  double heading_variation_rad = kUnknown;  ///< as the compass reports it
};

/// Takes out of a data set what is known and finite, in the order of stamps; stamps as recorded, less the
/// configured latencies. Precondition: data has inertial samples.
[[nodiscard]] Series series_of(const dataset::Dataset& data, const Assumed& assumed);

/// Linear between rows; nothing outside and in gaps longer than `longest_gap_s`.
[[nodiscard]] std::optional<Eigen::Vector3d> at(const VectorSeries& series, double t_s, double longest_gap_s);
[[nodiscard]] std::optional<double> at(const ScalarSeries& series, double t_s, double longest_gap_s);

}  // namespace fathom::commission
