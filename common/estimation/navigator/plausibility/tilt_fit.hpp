#pragma once

#include <array>

#include <Eigen/Core>

#include "estimation/navigator/plausibility/axes_hypotheses.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {

/// Of an estimate that knows its heading.
struct TrustedAttitude {
  geo::Quaternion q_NB;
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();  ///< as it takes the gyro to be off
};

/// Whether the small tilts of a vehicle under way turn as the gyro says, and which exchange or sign of axes
/// explains them better (PLAUS-2). Where down is follows from the force, less what GPS's velocity changed by.
/// Of tilts of a degree nobody knows the noise: it is taken from what is left over. A value of fixed size.
class TiltFit {
 public:
  /// One velocity of GPS, and what is needed to see it in the body.
  struct Velocity {
    Eigen::Vector3d v_N_m_s;
    double noise_m_s;
    double lever_m;  ///< of the antenna, and how well it is known
    TrustedAttitude attitude;
  };

  /// At the end of each inertial interval.
  void add(const Eigen::Vector3d& dv_m_s, const Eigen::Vector3d& dtheta_rad, double dt_s);
  /// At its instant.
  void measured(const Velocity& velocity);
  /// Nothing spans what was not measured.
  void interrupt();
  /// No evidence where the gyro as it should be does not explain the tilts better than one that says nothing.
  [[nodiscard]] OtherAxes other() const;
  /// The hypothesis of this number is still more likely than "as configured".
  [[nodiscard]] bool stands(std::size_t number) const {
    return number < kAxesHypotheses && over_configured_[number] > 0.0;
  }

  /// For archives: see fields/plausibility.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  /// From one velocity to a later one.
  struct Block {
    Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();         ///< on average
    Eigen::Vector3d acceleration_B_m_s2 = Eigen::Vector3d::Zero();  ///< by GPS, in its middle
    Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  };
  static constexpr std::size_t kNothing = kAxesHypotheses;  ///< a gyro that says nothing
  static constexpr std::size_t kSeries = kAxesHypotheses + 1;
  void follow(const Block& now, double noise_rad);
  void judge(std::array<double, kSeries>& squares);

  bool has_velocity_ = false;
  bool has_down_ = false;
  Eigen::Vector3d v_N_m_s_ = Eigen::Vector3d::Zero();  ///< at the begin of the block
  Eigen::Vector3d dv_m_s_ = Eigen::Vector3d::Zero();   ///< since
  Eigen::Vector3d turn_rad_ = Eigen::Vector3d::Zero();
  double lasted_s_ = 0.0;
  Eigen::Vector3d turn_before_rad_ = Eigen::Vector3d::Zero();  ///< of the block before
  /// Of each hypothesis: down as all blocks have it, in the middle of the last one, and its variance in
  /// rad^2.
  std::array<Eigen::Vector3d, kSeries> down_B_ = [] {
    std::array<Eigen::Vector3d, kSeries> out;
    out.fill(Eigen::Vector3d::UnitZ());
    return out;
  }();
  double variance_ = 0.0;
  double count_ = 0.0;  ///< of blocks that were judged
  // Of each hypothesis: squares that it leaves over, and its evidence over "as configured" and over no turn.
  std::array<double, kAxesHypotheses> left_{};
  std::array<double, kAxesHypotheses> over_configured_{};
  std::array<double, kAxesHypotheses> over_nothing_{};
};

}  // namespace fathom::estimation
