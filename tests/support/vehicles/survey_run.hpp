#pragma once

#include <variant>
#include <vector>

#include "estimation/engine/fusion_engine.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::test {

using Sample = std::variant<ImuSample, GpsSample, DvlSample, DepthSample, HeadingSample, UsblSample>;

inline const SampleHeader& header(const Sample& sample) {
  return std::visit([](const auto& s) -> const SampleHeader& { return s.header; }, sample);
}

void feed(estimation::FusionEngine& engine, const Sample& sample);

/// A short survey of a small underwater vehicle: at rest afloat (with waves), under way at the surface with
/// GPS, then a dive without. Everything a fusion engine would be told, in the order of arrival, and the truth
/// at each inertial sample.
struct SurveyRun {
  static constexpr double kSurfaceAltitude_m = 18.5;
  static constexpr TimeNs kEpochNs = 1'700'000'000 * kNsPerSecond;

  struct Options {
    double duration_s = 120.0;
    double dive_s = 50.0;    ///< GPS ends here
    double surface_s = 1e9;  ///< and comes back here
    std::uint64_t seed = 1;
    double wave_rad = 0.02;
    double gyro_bias_rad_s = 4.0e-6;
    double accel_bias_m_s2 = 5e-3;
    double gps_delay_s = 0.2;
    double dvl_delay_s = 0.1;
    bool usbl = true;
    double usbl_slow_m =
        0.0;  ///< where it is not 0, the acoustic fixes are off by a constant and hardly scatter
  };

  std::vector<Sample> samples;  ///< by received_ns
  std::vector<Truth> truth;     ///< one per inertial sample

  static const Eigen::Vector3d& dvl_lever() {
    static const Eigen::Vector3d lever(0.4, 0.05, 0.3);
    return lever;
  }
  static const Eigen::Vector3d& gps_lever() {
    static const Eigen::Vector3d lever(-0.3, 0.0, -0.5);
    return lever;
  }

  explicit SurveyRun(const Options& options);

  /// Configuration that suits the vehicle.
  static estimation::EngineConfig config();
};

}  // namespace fathom::test
