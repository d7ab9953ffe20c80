#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimation/engine/fusion_engine.hpp"
#include "sim/simulation.hpp"

namespace fathom::study {

/// Inertial increments of several samples summed into one, as an instrument of a lower rate gives them:
/// nothing of the motion is dropped.
class ImuSum {
 public:
  explicit ImuSum(int samples) : samples_(samples) {}
  /// True when `sample` now holds the sum over the last `samples` samples.
  bool add(ImuSample& sample);

 private:
  int samples_;
  int count_ = 0;
  double dt_s_ = 0.0;
  Eigen::Vector3d angle_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

/// An engine under test. It is told measurements and a start, never the truth.
class EngineRun {
 public:
  /// `imu_every`: increments of this many inertial samples are summed before the engine sees them.
  explicit EngineRun(const estimation::EngineConfig& config, int imu_every = 1);

  void take(const sim::Measurement& measurement);
  /// Orders once, after the first inertial sample.
  void at_rest_for(double seconds) { at_rest_s_ = seconds; }

  [[nodiscard]] const estimation::FusionEngine& engine() const { return engine_; }
  [[nodiscard]] bool navigating() const;
  /// Measurements by verdict.
  [[nodiscard]] const VerdictTally& verdicts() const { return tally_; }

 private:
  estimation::FusionEngine engine_;
  ImuSum sum_;
  double at_rest_s_ = 0.0;
  VerdictTally tally_;
};

/// Carries out a scenario for `duration_s` and hands the measurements to all engines in the order of their
/// arrival. `observe`, where given, sees each measurement, and each inertial sample after the engines did.
void carry_out(sim::Simulation& simulation, double duration_s, std::span<EngineRun* const> engines,
               const std::function<void(const sim::Measurement&)>& observe = {});

/// Horizontal error of a navigation state and what the filter says about it.
struct HorizontalError {
  double error_m = 0.0;
  double nees = 0.0;     ///< error' P^-1 error, of two dimensions
  double sigma_m = 0.0;  ///< square root of the trace of P
};
/// All NaN where the engine does not navigate.
[[nodiscard]] HorizontalError horizontal_error(const NavState& nav, const Truth& truth);

}  // namespace fathom::study
