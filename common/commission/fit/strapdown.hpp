#pragma once

#include <vector>

#include <Eigen/Core>

#include "commission/fit/series.hpp"
#include "geo/so3.hpp"

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
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  };
  /// What small biases of the unit do to a state.
  struct OfBias {
    /// Integral of C_WB, s: what a bias of the force adds to S, and one of the rate to the angle, negative.
    Eigen::Matrix3d IC = Eigen::Matrix3d::Zero();
    /// Integral of [C_WB f] IC, m: what a bias of the rate adds to S, by the angles that it has made.
    Eigen::Matrix3d IFC = Eigen::Matrix3d::Zero();
  };
  struct Both {
    State state;
    OfBias of_bias;
  };
  enum class Integrate { motion, motion_and_biases };
  /// Samples of [from_s, to_s], in steps of at least 0.02 s. A sample counts for the interval before it.
  Strapdown(const ImuSeries& imu, const ImuReading& reading, double from_s, double to_s,
            Integrate what = Integrate::motion);
  /// Interpolated. Precondition: covers(t_s).
  [[nodiscard]] State at(double t_s) const;
  /// Interpolated. Precondition: covers(t_s), and biases were integrated.
  [[nodiscard]] Both both_at(double t_s) const;
  [[nodiscard]] bool covers(double t_s) const {
    return t_s_.size() > 1 && t_s >= t_s_.front() && t_s <= t_s_.back();
  }

 private:
  // The end of a step.
  struct Step {
    geo::Quaternion q_WB;
    Eigen::Vector3d S = Eigen::Vector3d::Zero();     // as that of State
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // within the step, rad/s
  };
  struct Place {
    std::size_t next = 1;  // of the step that an instant is in
    double share = 0.0;    // of the step that has passed
  };
  [[nodiscard]] Place place_of(double t_s) const;
  [[nodiscard]] State state_at(const Place& place) const;

  std::vector<double> t_s_;
  std::vector<Step> steps_;
  std::vector<OfBias> of_bias_;  // empty where only motion was asked for
};

/// The unit integrated over a span for a bias of the rate that is being estimated. A bias that has moved
/// little is taken in by the derivatives; one that has moved so far that this is no longer as good integrates
/// again.
class MovedStrapdown {
 public:
  /// The series outlives this.
  MovedStrapdown(const ImuSeries& imu, const ImuReading& reading, double from_s, double to_s);
  /// The bias of the rate from now on, rad/s as recorded.
  void move_to(const Eigen::Vector3d& rate_bias);
  /// Interpolated. Precondition: covers(t_s).
  [[nodiscard]] Strapdown::Both at(double t_s) const;
  [[nodiscard]] bool covers(double t_s) const { return strapdown_.covers(t_s); }

 private:
  const ImuSeries& imu_;
  ImuReading integrated_;
  double from_s_;
  double to_s_;
  Strapdown strapdown_;
  Eigen::Vector3d moved_ = Eigen::Vector3d::Zero();  // of the bias since it was integrated, rad/s, read right
};

/// Mean turn rate from 0.1 s before to 0.1 s behind an instant, read right, rad/s.
[[nodiscard]] Eigen::Vector3d rate_about(const ImuSeries& imu, const ImuReading& reading, double t_s);

}  // namespace fathom::commission
