#pragma once

#include "estimation/motion_memory.hpp"
#include "samples/forecast.hpp"

namespace fathom::estimation {

/// Radius that holds 95 % of a two-dimensional normal distribution with these axes' sigmas; exact to 0.3 %.
[[nodiscard]] double radius_95(double larger_sigma, double smaller_sigma);
/// Likewise of the one that holds half; exact to 0.7 %.
[[nodiscard]] double radius_50(double larger_sigma, double smaller_sigma);

/// Propagates the covariance on without position fixes, along the motion of the last two minutes over again,
/// with the other aiding that was in use a moment ago or without it (FC-1).
class Forecaster {
 public:
  explicit Forecaster(const Setup& setup);
  /// Remembers the last sample of a sensor: it stands for those to come.
  void remember(int sensor, const AnySample& sample);
  /// After each inertial step.
  void watch(const Core& core) { memory_.watch(core); }
  void fill(const Core& core, Forecast& out);
  /// `after_s` from now, with what aids now; unknown without navigation.
  [[nodiscard]] double horizontal_95_m(const Core& core, double after_s);

 private:
  /// Which aiding goes on: a sensor that does not, or one of these.
  enum Lost : int { kNone = -1, kAll = -2 };

  void begin(const Core& core);
  void step(const Core& core, int lost, double dt_s);
  [[nodiscard]] bool aids(const Core& core, int sensor) const;
  void follow(const Core& core, int lost, Forecast& out, std::uint32_t first);

  const Setup* setup_;
  MotionMemory memory_;
  ErrorFilter filter_;
  FilterState state_;  ///< as it may be then
  int second_ = 0;
  double ahead_s_ = 0.0;  ///< of the present
  double yaw_rad_ = 0.0;
  MotionMemory::Second still_;  ///< where nothing is remembered yet: straight ahead
  std::array<AnySample, kMaxSensors> last_{};
  std::array<bool, kMaxSensors> remembered_{};
};

}  // namespace fathom::estimation
