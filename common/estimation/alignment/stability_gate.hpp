#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "estimation/alignment/drop_config.hpp"

namespace fathom::estimation {

/// Navigated and measured quantities at one inertial sample.
struct StabilityInput {
  double dt_s = 0.0;  ///< since the sample before
  double roll_rad = kUnknown;
  double pitch_rad = kUnknown;
  double depth_error_m = kUnknown;  ///< unknown: the depth is missing
  double speed_m_s = kUnknown;      ///< unknown: the propulsor's speed is missing
  double speed_slope_m_s2 = 0.0;
  Eigen::Vector3d rate_B_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();
  double g_m_s2 = kStandardGravity_m_s2;
};

enum class StabilityCondition : std::uint8_t {
  roll = 0,
  pitch,
  depth,
  rate_y,
  force_x,
  rate_z,
  gravity,
  speed_slope,
  count
};
inline constexpr std::size_t kStabilityConditions = static_cast<std::size_t>(StabilityCondition::count);
[[nodiscard]] std::string_view to_string(StabilityCondition condition);

/// Why timers and window were last set back to nothing.
enum class StabilityReset : std::uint8_t {
  none = 0,
  not_finite = 1,  ///< a sample that is not a number
  gap = 2,         ///< the inertial samples were interrupted
  stale = 3,       ///< a sample with an instant not after the one before
  repeated = 4,    ///< the same inertial readings again, bit for bit
  no_depth = 5,
  no_speed = 6,
  condition = 7,     ///< a condition failed while averaging
  spread = 8,        ///< the window was full and too restless
  level = 9,         ///< its mean was no gravity
  disagreement = 10  ///< its level contradicts what the fine alignment knows
};
[[nodiscard]] std::string_view to_string(StabilityReset reset);

/// Means over one full window.
struct StabilityWindow {
  double roll_rad = 0.0;  ///< navigated
  double pitch_rad = 0.0;
  Eigen::Vector3d rate_B_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();
  double speed_m_s = 0.0;
  double speed_slope_m_s2 = 0.0;
  double forward_spread_m_s2 = 0.0;  ///< standard deviation of the forward force, vibration aside
  double flow_spread_m_s2 = 0.0;     ///< likewise of the side force, within and in the seconds before
  int samples = 0;
};

/// Decides, sample by sample, when the vehicle has been steady for long enough and averages the window after
/// that. Conditions are sampled: averaging begins with the sample after the one that completes the hold
/// times. Whatever interrupts it throws the window away; a partial window is never given. A value of fixed
/// size.
class StabilityGate {
 public:
  struct Watched {
    double value = kUnknown;
    double limit = 0.0;
    double held_s = 0.0;
    double needed_s = 0.0;
    [[nodiscard]] bool met() const;
  };
  enum class Phase : std::uint8_t { waiting = 0, averaging = 1, full = 2 };

  explicit StabilityGate(const StabilityConfig& config = {});

  /// Takes one sample; `full` exactly at the last sample of a window, after which waiting begins anew.
  Phase add(const StabilityInput& input);
  /// Sets all timers and the window back.
  void reset(StabilityReset reason);
  /// Likewise, because of bad or missing measurements.
  void fail(StabilityReset reason);

  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] const Watched& watched(StabilityCondition condition) const {
    return watched_[static_cast<std::size_t>(condition)];
  }
  [[nodiscard]] StabilityReset last_reset() const { return last_reset_; }
  /// The last bad or missing measurement that set everything back, none before the first; how long ago.
  [[nodiscard]] StabilityReset last_fault() const { return last_fault_; }
  [[nodiscard]] double since_fault_s() const { return since_fault_s_; }
  [[nodiscard]] double averaged_s() const { return averaged_s_; }
  /// Until a window could be full if all conditions held from now on.
  [[nodiscard]] double time_to_full_s() const;
  [[nodiscard]] const StabilityWindow& window() const { return window_; }
  /// Variance of one sample of the specific force that comes from noise and vibration: half the mean square
  /// of its changes from sample to sample, mean of the axes.
  [[nodiscard]] double jitter_m2_s4() const { return jitter_; }

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  [[nodiscard]] StabilityReset fault(const StabilityInput& input) const;
  void watch(StabilityCondition condition, double value, double dt_s);
  void smooth(const StabilityInput& input);
  void smooth_side(const StabilityInput& input, double light, double slow, double flow);
  void average(const StabilityInput& input);
  /// Variance that vibration leaves in the low-passed force.
  [[nodiscard]] double vibration() const;

  StabilityConfig config_;
  Phase phase_ = Phase::waiting;
  std::array<Watched, kStabilityConditions> watched_{};
  StabilityReset last_reset_ = StabilityReset::none;
  StabilityReset last_fault_ = StabilityReset::none;
  double since_fault_s_ = 0.0;
  bool primed_ = false;  ///< the low-pass has a value
  bool has_before_ = false;
  Eigen::Vector3d raw_rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d raw_force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  // Low-passed for the spread: the forward force, and the side force beyond what turning explains.
  double light_share_ = 0.0;
  double light_forward_ = 0.0;
  double light_side_ = 0.0;
  double slow_side_ = 0.0;
  bool has_side_ = false;
  double flow_ = 0.0;  ///< mean square of the side force's fast part, by the weight
  double flow_weight_ = 0.0;
  double jitter_ = 0.0;
  double averaged_s_ = 0.0;
  int samples_ = 0;
  StabilityWindow sum_;
  Eigen::Vector2d first_light_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d excess_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d excess_square_ = Eigen::Vector2d::Zero();
  StabilityWindow window_;
};

}  // namespace fathom::estimation
