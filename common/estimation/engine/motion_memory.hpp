#pragma once

#include <array>

#include "estimation/navigator/navigator.hpp"

namespace fathom::estimation {

/// How the vehicle moved in the last two minutes, second by second: what a forecast takes for the next ones.
class MotionMemory {
 public:
  static constexpr int kSeconds = 120;

  struct Second {
    double roll_rad = 0.0;
    double pitch_rad = 0.0;
    double turned_rad = 0.0;  ///< of the heading, within it
    double speed_m_s = 0.0;   ///< along the course
    double sink_m_s = 0.0;
    double slip_rad = 0.0;                                   ///< course less heading
    Eigen::Vector3d rate_B_rad_s = Eigen::Vector3d::Zero();  ///< mean
    Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();  ///< mean
  };

  /// After each inertial step. Begins anew where the navigator does not navigate or the time axis jumps.
  void watch(const Navigator& navigator);
  [[nodiscard]] int size() const { return count_; }
  /// 0 is the oldest.
  [[nodiscard]] const Second& at(int index) const {
    return seconds_[static_cast<std::size_t>((next_ + kSeconds - count_ + index) % kSeconds)];
  }

 private:
  void open(const Navigator& navigator);

  std::array<Second, kSeconds> seconds_{};
  int next_ = 0;
  int count_ = 0;
  // The second that is not over yet.
  TimeNs begin_ns_ = 0;
  double yaw_before_rad_ = 0.0;
  int samples_ = 0;
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace fathom::estimation
