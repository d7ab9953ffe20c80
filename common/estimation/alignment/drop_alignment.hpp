#pragma once

#include <cmath>

#include "base/units.hpp"
#include "estimation/alignment/motion_level.hpp"
#include "estimation/alignment/stability_gate.hpp"
#include "estimation/alignment/tilt_filter.hpp"
#include "samples/nav_state.hpp"

namespace fathom::estimation {

/// Speed and its slope from a speed log, for a vehicle whose slope dies away by itself when the thrust is
/// constant (ALN-13). A Kalman filter of two states.
class SpeedTrack {
 public:
  void restart(double speed_m_s, double sigma_m_s);
  void add(double dt_s, double speed_m_s, double sigma_m_s, double tau_s, double rate_y_rad_s);
  [[nodiscard]] double speed_m_s() const { return x_.x(); }
  [[nodiscard]] double slope_m_s2() const { return x_.y(); }
  [[nodiscard]] double slope_sigma_m_s2() const { return std::sqrt(p_(1, 1)); }

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  Eigen::Vector2d x_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d p_ = Eigen::Matrix2d::Identity();
};

/// One inertial interval.
struct DropStep {
  double dt_s = 0.0;
  Eigen::Vector3d rate_IB_B_rad_s = Eigen::Vector3d::Zero();  ///< mean over the interval
  Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_IN_N_rad_s = Eigen::Vector3d::Zero();  ///< Earth's and transport rate
  Eigen::Vector3d earth_rate_N_rad_s = Eigen::Vector3d::Zero();
  double g_m_s2 = kStandardGravity_m_s2;
};

/// The state machine of the in-motion alignment (ALN-12): waiting, averaging, coarse, fine, aligned; timed
/// out, lost. Carries its own attitude by the gyro from the one handed over. Deterministic, a value of fixed
/// size.
class DropAlignment {
 public:
  explicit DropAlignment(const DropConfig& config = {});

  /// Begins with an attitude of which only the heading is known.
  void start(const geo::Quaternion& q_NB);
  /// One inertial interval. Returns the rotation about N by which the attitude was corrected at its end.
  Eigen::Vector3d add(const DropStep& step);
  /// The interval could not be measured: timers and window begin anew from the attitude as it is.
  void interrupt(StabilityReset reason) { gate_.fail(reason); }
  /// What may have happened meanwhile, along each axis.
  void widen(double angle_sigma_rad, double velocity_sigma_m_s, double depth_sigma_m);
  /// Depth below the surface and propulsor speed, valid now. Return the correction likewise.
  Eigen::Vector3d add_depth(double depth_m);
  Eigen::Vector3d add_rpm(double rpm);
  /// The attitude cannot be trusted any more: begins anew from it, and says so for a second.
  void lose();

  [[nodiscard]] AlignmentPhase phase() const { return phase_; }
  [[nodiscard]] double in_phase_s() const { return time_s_ - phase_since_s_; }
  [[nodiscard]] const geo::Quaternion& q_NB() const { return filtering_ ? filter_.q_NB() : q_NB_; }
  /// Sigmas of roll, pitch, yaw.
  [[nodiscard]] Eigen::Vector3d rpy_sigma_rad() const;
  /// Of the attitude error about N.
  [[nodiscard]] Eigen::Matrix3d attitude_covariance() const;
  /// Predicted; unknown while something is missing, 0 when aligned.
  [[nodiscard]] double time_to_aligned_s() const;
  [[nodiscard]] const StabilityGate& gate() const { return gate_; }
  [[nodiscard]] bool filtering() const { return filtering_; }
  [[nodiscard]] const TiltFilter& filter() const { return filter_; }
  [[nodiscard]] bool wet() const { return entered_s_ >= 0.0; }
  [[nodiscard]] double held_s() const { return hold_since_s_ < 0.0 ? 0.0 : time_s_ - hold_since_s_; }
  /// Mean of the normalised innovations squared: 1 when all fits together.
  [[nodiscard]] double consistency() const { return consistency_; }
  [[nodiscard]] bool consistent() const;
  /// no_depth or no_speed while such samples are missing, else none.
  [[nodiscard]] StabilityReset missing() const;
  [[nodiscard]] const DropConfig& config() const { return config_; }

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  static constexpr double kLeastSpeed_m_s = 3.0;  ///< of a body that its fins steer

  void enter(AlignmentPhase phase);
  [[nodiscard]] bool fresh(double at_s) const {
    return at_s >= 0.0 && time_s_ - at_s <= config_.sensor_timeout_s;
  }
  [[nodiscard]] Eigen::Vector3d slip(const Eigen::Vector3d& rate_NB_B) const;
  void start_filter(const Eigen::Matrix3d& attitude_covariance);
  Eigen::Vector3d take(const TiltFilter::Row* rows, int count);
  /// Begins anew where the filter arrived when that was far from where it began.
  void recentre();
  /// Follows what the accelerometers take for up, the motion taken off.
  void follow_level(const DropStep& step);
  /// Whether the measurements have contradicted the filter for a while and its tilt is not that of the
  /// accelerometers.
  [[nodiscard]] bool captured();
  /// Begins anew from the accelerometers' level and the heading of the release; returns the correction.
  Eigen::Vector3d restart_from_level();
  /// Follows a correction of the attitude; returns by how much the heading is off because of it.
  double heading_slip(const Eigen::Vector3d& rotation_N_rad);
  Eigen::Vector3d finish_window();
  void watch();
  [[nodiscard]] Eigen::Vector2d coarse_sigma(const StabilityWindow& window) const;

  DropConfig config_;
  AlignmentPhase phase_ = AlignmentPhase::none;
  double time_s_ = 0.0;
  double phase_since_s_ = 0.0;
  double hold_since_s_ = -1.0;
  double entered_s_ = -1.0;
  geo::Quaternion q_NB_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of the attitude while not filtering
  StabilityGate gate_;
  bool filtering_ = false;
  double filtering_since_s_ = 0.0;
  double next_slip_s_ = 0.0;
  geo::Quaternion turned_;  ///< by the filter since it began
  TiltFilter filter_;
  double consistency_ = 1.0;
  double contradicted_since_s_ = -1.0;                       ///< negative: the filter is consistent
  Eigen::Vector3d level_force_B_ = Eigen::Vector3d::Zero();  ///< low-passed; zero: not known
  Eigen::Vector3d rate_NB_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d slip_rate_ = Eigen::Vector3d::Zero();  ///< turn rate as the slip follows it
  double g_m_s2_ = kStandardGravity_m_s2;
  double depth_at_s_ = -1.0;
  double depth_m_ = 0.0;
  double speed_at_s_ = -1.0;
  double measured_speed_m_s_ = 0.0;
  double behind_m_s_ = 0.0;  ///< by which the propulsor is behind the speed
  SpeedTrack speed_;
  // The heading was known at the release, whatever is found out about the tilt there.
  geo::Quaternion q_release_;
  double release_heading_rad_ = 0.0;
};

}  // namespace fathom::estimation
