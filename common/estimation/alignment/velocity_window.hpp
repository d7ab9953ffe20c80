#pragma once

#include <optional>

#include "base/time.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {

/// What the inertial unit went through since the window began: integrals in the axes that B had then.
struct InertialSpan {
  double duration_s = 0.0;
  geo::Quaternion q_start_now;                                ///< B now relative to B at the start
  Eigen::Vector3d dv_m_s = Eigen::Vector3d::Zero();           ///< of specific force
  Eigen::Matrix3d by_accel_bias = Eigen::Matrix3d::Zero();    ///< derivative of dv, s
  Eigen::Matrix3d turn_by_bias = Eigen::Matrix3d::Zero();     ///< of the turn, by the gyro's bias, s
  Eigen::Matrix3d dv_by_gyro_bias = Eigen::Matrix3d::Zero();  ///< derivative of dv, m

  /// One inertial interval: mean rate and specific force along B over dt_s.
  void add(double dt_s, const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2);
};

/// A velocity over ground of an antenna, and what the inertial unit went through until then.
struct VelocityMark {
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_B_rad_s = Eigen::Vector3d::Zero();
  InertialSpan span;
};

/// A velocity over ground that was measured within the inertial interval that comes next.
struct NewVelocity {
  TimeNs stamp_ns = 0;
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_m_s = Eigen::Vector3d::Zero();
};

/// Holds a first, a middle and a last velocity of a satellite receiver beside the inertial increments between
/// them (ALN-6). Fixed size.
class VelocityWindow {
 public:
  void reset() { *this = VelocityWindow(); }
  /// A velocity measured at `stamp_ns`, within the interval that add() tells next.
  void measured(TimeNs stamp_ns, const Eigen::Vector3d& v_N_m_s, const Eigen::Vector3d& sigma_m_s);
  /// One inertial interval that ends at `now_ns`. The window ends with the first velocity that is `length_s`
  /// or more younger than its first.
  void add(TimeNs now_ns, double dt_s, const Eigen::Vector3d& rate_B_rad_s,
           const Eigen::Vector3d& force_B_m_s2, double length_s);

  /// It ended within the last interval that was added.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] const VelocityMark& first() const { return first_; }
  /// None where no velocity came about half way.
  [[nodiscard]] const VelocityMark* middle() const { return has_middle_ ? &middle_ : nullptr; }
  [[nodiscard]] const VelocityMark& last() const { return last_; }
  [[nodiscard]] const InertialSpan& now() const { return now_; }
  /// None where nothing was measured since the last interval.
  [[nodiscard]] std::optional<NewVelocity> pending() const;
  /// Of the velocity that was measured last; zero before the first.
  [[nodiscard]] const Eigen::Vector3d& newest_sigma_m_s() const { return pending_sigma_m_s_; }

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.measured_ns_);
  }

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  void mark(const Eigen::Vector3d& rate_B_rad_s, double length_s);

  bool open_ = false;
  bool complete_ = false;
  bool has_middle_ = false;
  bool pending_ = false;
  TimeNs measured_ns_ = 0;
  Eigen::Vector3d pending_v_N_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d pending_sigma_m_s_ = Eigen::Vector3d::Zero();
  InertialSpan now_;
  VelocityMark first_;
  VelocityMark middle_;
  VelocityMark last_;
};

}  // namespace fathom::estimation
