#pragma once

#include <array>

#include "estimation/navigator/navigator.hpp"

namespace fathom::estimation {

/// How the vehicle moved in the last six minutes, second by second: what a forecast takes for the next ones.
class MotionMemory {
 public:
  static constexpr int kSeconds = 360;

  struct Second {
    geo::Quaternion q_NB;                                    ///< in its middle
    Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();       ///< in its middle
    Eigen::Vector3d rate_B_rad_s = Eigen::Vector3d::Zero();  ///< mean
    Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();  ///< mean
  };

  /// After each inertial step. Begins anew where the navigator does not navigate or the time axis jumps.
  void watch(const Navigator& navigator);
  /// The next whole second.
  void add(const Second& second);
  [[nodiscard]] int size() const { return count_; }
  /// 0 is the oldest.
  [[nodiscard]] const Second& at(int index) const {
    return seconds_[static_cast<std::size_t>((next_ + kSeconds - count_ + index) % kSeconds)];
  }
  /// The second that followed when the vehicle last moved as it moves now: where a pattern goes on (FC-2).
  /// The oldest one, where little is remembered.
  [[nodiscard]] int likely_next() const;

 private:
  void open(const Navigator& navigator);

  std::array<Second, kSeconds> seconds_{};
  int next_ = 0;
  int count_ = 0;
  // The second that is not over yet.
  TimeNs begin_ns_ = 0;
  Second open_;
  bool half_over_ = false;
  int samples_ = 0;
};

/// Turn about the vertical that brings one attitude nearest to the other, however steep they are.
[[nodiscard]] double turn_about_down_rad(const geo::Quaternion& from_NB, const geo::Quaternion& to_NB);

}  // namespace fathom::estimation
