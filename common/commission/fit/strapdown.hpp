#pragma once

#include <vector>

#include <Eigen/Core>

#include "commission/fit/series.hpp"

namespace fathom::commission {

/// How right rates and forces come from recorded ones: right = matrix * (recorded - bias).
struct ImuReading {
  Eigen::Matrix3d rate = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d force = Eigen::Matrix3d::Identity();
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();  ///< rad/s as recorded
};

/// The inertial unit integrated from the start of a span on, in the frame W of the body at that instant.
class Strapdown {
 public:
  struct State {
    Eigen::Matrix3d C_WB = Eigen::Matrix3d::Identity();
    Eigen::Vector3d S = Eigen::Vector3d::Zero();  ///< integral of C_WB f, m/s
    /// Integral of C_WB, s: what a bias of the force adds to S, and one of the rate to the angle, negative.
    Eigen::Matrix3d IC = Eigen::Matrix3d::Zero();
    /// Integral of [C_WB f] IC, m: what a bias of the rate adds to S, by the angles that it has made.
    Eigen::Matrix3d IFC = Eigen::Matrix3d::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  };
  /// Samples of [from_s, to_s], in steps of at least `step_s`. A sample counts for the interval before it.
  Strapdown(const ImuSeries& imu, const ImuReading& reading, double from_s, double to_s,
            double step_s = 0.02);
  /// Interpolated. Precondition: covers(t_s).
  [[nodiscard]] State at(double t_s) const;
  [[nodiscard]] bool covers(double t_s) const {
    return t_s_.size() > 1 && t_s >= t_s_.front() && t_s <= t_s_.back();
  }

 private:
  std::vector<double> t_s_;
  std::vector<State> states_;
};

/// Mean turn rate from 0.1 s before to 0.1 s behind an instant, read right, rad/s.
[[nodiscard]] Eigen::Vector3d rate_about(const ImuSeries& imu, const ImuReading& reading, double t_s);

}  // namespace fathom::commission
