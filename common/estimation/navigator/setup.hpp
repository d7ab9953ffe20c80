#pragma once

#include <array>
#include <optional>

#include "estimation/alignment/drop_config.hpp"
#include "estimation/doubt/motion_noise.hpp"
#include "estimation/engine_config.hpp"
#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/gate.hpp"
#include "estimation/hydro/water_velocity.hpp"
#include "estimation/navigator/stride.hpp"

namespace fathom::estimation {

inline constexpr int kMaxSensors = 24;
/// DVLs whose water layer is judged beside the bottom.
inline constexpr int kMaxWaterLayers = 4;
/// Of all acoustic instruments together; a bridge knows the places of as many.
inline constexpr int kMaxBeacons = 16;

/// What never changes after construction: the configuration and what is made from it once.
struct Setup {
  explicit Setup(const EngineConfig& engine_config,
                 StateIndex::Considered considered = StateIndex::Considered::kept);

  EngineConfig config;
  StateIndex index;
  std::array<GateLimits, kMaxSensors> limits{};
  std::array<int, kMaxSensors> water_layer{};  ///< of each DVL a number; -1: none
  std::array<bool, kMaxSensors> unused{};      ///< nothing here has a use for what the sensor measures
  SensorConfig constraint_gate;                ///< how what no instrument measures is gated
  GateLimits constraint_limits;
  std::array<double, kMaxStates> initial_sigma{};  ///< of the states from index 9 on
  std::array<double, kMaxStates> walk{};
  std::array<double, kMaxStates> decay_per_s{};
  std::array<double, MotionNoise::kKinds> imu_noise{};  ///< that is said of it: m^2/s^3, rad^2/s
  StateDrift drift;                                     ///< of walk and decay_per_s
  double stride_s = 0.0;                                ///< how long the covariance may stay behind (KF-1)
  geo::Quaternion q_B_imu;                              ///< from the unit's own axes into B
  geo::Quaternion q_B_wheels;                           ///< likewise from those of the wheels
  std::optional<hydro::VelocityModel> velocity_model;   ///< where it is switched on
  SensorConfig model_gate;  ///< for it: nothing is widened or believed in the end because it insists
  GateLimits model_limits;

  [[nodiscard]] const SensorConfig& sensor(int number) const {
    return config.sensors[static_cast<std::size_t>(number)];
  }
  /// NaN where it is not configured.
  [[nodiscard]] double magnetic_variation_rad() const {
    return config.magnetic_variation_known ? config.magnetic_variation_rad : kUnknown;
  }
  /// Whether what the measurements contradict is put down to the inertial unit (GATE-11, GATE-12): what is
  /// left out and taken for none would pass for it.
  [[nodiscard]] bool doubts_imu() const { return config.left_out != LeftOut::noise; }
  /// (NOISE-1) At this attitude, with what is felt there.
  [[nodiscard]] ProcessNoise process_noise(const Eigen::Matrix3d& C_NB, const SquaredInputs& inputs) const;
  /// What the configuration says of a drop and what follows from it.
  [[nodiscard]] DropConfig drop_config() const;
};

}  // namespace fathom::estimation
