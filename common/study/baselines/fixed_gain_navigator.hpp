#pragma once

#include "estimation/engine_config.hpp"
#include "geo/wgs84.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "study/baselines/fixed_gain.hpp"

namespace fathom::study::fixed_gain {

using estimation::InitialState;

/// Local north-east-down axes at `origin`, fixed to the Earth: T.
class TangentFrame {
 public:
  explicit TangentFrame(const geo::Geodetic& origin);
  /// From the origin, m along T; exact on the ellipsoid.
  [[nodiscard]] Eigen::Vector3d position_T_m(const geo::Geodetic& at) const;
  /// Turns from north, east, down at a place near by into T.
  [[nodiscard]] Eigen::Matrix3d R_TN(const geo::Geodetic& at) const;

 private:
  Eigen::Vector3d origin_E_m_;
  Eigen::Matrix3d R_TE_;
};

/// What goes on being fed back when there is no fix.
enum class OutageMode : std::uint8_t {
  mean = 0,  ///< running mean of the corrections so far: an ad-hoc bias along T, wrong after a turn
  hold = 1,  ///< the correction right behind the last fix
};

/// The published estimator as a whole: strapdown in T, a filter of nine errors (attitude, position and
/// p = v + u x r; no instrument error is a state), whose estimates are fed back with fixed poles (FIX-5).
class Navigator {
 public:
  struct Config {
    OutageMode outage = OutageMode::mean;
    Gains gains;
    double angle_walk_rad_sqrt_s = 3e-4;     ///< of the nine-state filter; what it has for instrument errors
    double velocity_walk_m_s_sqrt_s = 0.05;  ///< likewise
    double position_sigma_m = 2.0;           ///< of a fix, each axis
    double velocity_sigma_m_s = 0.1;         ///< likewise
    std::array<double, 3> gps_lever_B_m{0, 0, 0};
    double lost_after_s = 0.75;  ///< without a fix
  };

  /// Starts with the first inertial sample at or after the stamp; its sigmas are those of the filter.
  Navigator(const Config& config, const InitialState& start);

  /// Rates at the stamp, integrated by the trapezoidal rule. In the order of their stamps.
  void add(const ImuSample& sample);
  /// Acts with the first inertial sample at or after its stamp.
  void add(const GpsSample& sample);

  [[nodiscard]] const TangentFrame& frame() const { return frame_; }
  [[nodiscard]] const Eigen::Vector3d& position_T_m() const { return r_T_m_; }
  [[nodiscard]] Eigen::Matrix3d R_TB() const;

 private:
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  struct Feedback {
    Eigen::Vector3d acceleration_T_m_s2 = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate_T_rad_s = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] Feedback of_errors() const;
  void step(const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2, double dt_s);
  void correct(const GpsSample& fix);

  Config config_;
  geo::Geodetic origin_;
  TangentFrame frame_;
  TimeNs start_ns_;
  bool running_ = false;
  TimeNs now_ns_ = 0;
  TimeNs fix_ns_ = 0;
  double since_start_s_ = 0.0;
  Eigen::Vector3d rate_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_B_ = Eigen::Vector3d::Zero();
  geo::Quaternion q_IB_;
  Eigen::Vector3d r_T_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_T_m_s_ = Eigen::Vector3d::Zero();
  Vector9 errors_ = Vector9::Zero();  ///< truth - computed: attitude, r, p
  Matrix9 covariance_ = Matrix9::Zero();
  GpsSample waiting_;
  bool has_waiting_ = false;
  Feedback held_;
  Feedback mean_;
  double averaged_s_ = 0.0;
};

}  // namespace fathom::study::fixed_gain
