#pragma once

#include <memory>

#include "estimation/core.hpp"
#include "samples/forecast.hpp"

namespace fathom::estimation {

/// Radius that holds 95 % of a two-dimensional normal distribution with these axes' sigmas; exact to 0.3 %.
[[nodiscard]] double radius_95(double larger_sigma, double smaller_sigma);

/// Propagates the covariance on, straight ahead at the present velocity, without position fixes and with the
/// other aiding that was in use a moment ago (FC-1).
class Forecaster {
 public:
  explicit Forecaster(const Setup& setup);
  /// Remembers the last sample of a sensor: it stands for those to come.
  void remember(int sensor, const AnySample& sample);
  void fill(const Core& core, Forecast& out);

 private:
  void step(double dt_s);
  [[nodiscard]] bool aids(const Core& core, int sensor) const;

  const Setup* setup_;
  ErrorFilter filter_;
  NavSolution nav_;  ///< at the start, and the force that keeps it unaccelerated
  Eigen::Vector3d force_B_ = Eigen::Vector3d::Zero();
  ProcessNoise noise_;
  std::array<AnySample, kMaxSensors> last_{};
  std::array<Observation, kMaxSensors> observations_{};
};

}  // namespace fathom::estimation
