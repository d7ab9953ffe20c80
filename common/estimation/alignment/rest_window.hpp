#pragma once

#include "geo/so3.hpp"

namespace fathom::estimation {

/// What a window of rest tells about the attitude.
struct RestResult {
  double duration_s = 0.0;
  Eigen::Vector3d force_start_m_s2 = Eigen::Vector3d::Zero();  ///< mean specific force along B at the start
  geo::Quaternion q_start_now;  ///< B now relative to B at the start of the window
  Eigen::Vector3d mean_rate_B_rad_s = Eigen::Vector3d::Zero();
  double tilt_sigma_rad = 0.0;  ///< of the levelled attitude, from the unrest of the force
  Eigen::Vector3d rate_sigma_rad_s = Eigen::Vector3d::Zero();  ///< of the mean rate, from the unrest
};

/// Averages the specific force in the axes that B had when the window began, so that slow rolling of a
/// floating vehicle does not smear the level (ALN-1), and watches how quiet it is. Pure arithmetic, fixed
/// size.
class RestWindow {
 public:
  void reset() { *this = RestWindow(); }
  /// One inertial interval: mean rate and specific force along B over dt_s.
  void add(double dt_s, const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2);
  /// True heading measured at the end of the last interval added, and what it may be wrong by all through the
  /// window. As soon as two antennas speak the compass is left out.
  void add_heading(double heading_rad, double sigma_rad, bool two_antenna);

  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// Largest standard deviation of any axis within the window.
  [[nodiscard]] double rate_spread_rad_s() const;
  [[nodiscard]] double force_spread_m_s2() const;
  [[nodiscard]] int headings() const { return headings_; }
  [[nodiscard]] bool two_antenna() const { return two_antenna_; }
  /// Of heading_start_rad().
  [[nodiscard]] double heading_sigma_rad() const { return heading_sigma_rad_; }
  /// Mean of the headings, each taken back to the start of the window by the gyro. Needs headings() > 0.
  [[nodiscard]] double heading_start_rad() const;
  [[nodiscard]] RestResult result() const;

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  double duration_s_ = 0.0;
  int count_ = 0;
  geo::Quaternion q_start_now_;
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_square_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_first_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  ///< of the difference to the first, start axes
  Eigen::Vector3d force_square_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_sum_ = Eigen::Vector3d::Zero();  ///< of the rotation since the start
  Eigen::Vector3d turn_square_ = Eigen::Vector3d::Zero();
  double time_sum_ = 0.0;  ///< of the time since the start
  double time_square_ = 0.0;
  Eigen::Vector3d turn_time_ = Eigen::Vector3d::Zero();  ///< of rotation times time
  int headings_ = 0;
  bool two_antenna_ = false;
  double heading_sigma_rad_ = 0.0;
  double heading_sine_ = 0.0;
  double heading_cosine_ = 0.0;
};

/// Roll and pitch of axes in which a vehicle at rest feels this specific force (ALN-2).
[[nodiscard]] Eigen::Vector2d level(const Eigen::Vector3d& force_m_s2);

/// Heading of axes levelled with `roll_pitch` in which a vehicle at rest turns at this rate with the Earth
/// (ALN-3).
[[nodiscard]] double gyrocompass(const Eigen::Vector2d& roll_pitch, const Eigen::Vector3d& rate_B_rad_s);

}  // namespace fathom::estimation
