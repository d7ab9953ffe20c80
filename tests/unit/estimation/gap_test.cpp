// The inertial unit is silent for some seconds, and the vehicle goes on (ALN-19).
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

struct Fared {
  double worst_tilt_sigmas = 0.0;
  double worst_position_sigmas = 0.0;
  double last_position_m = 0.0;
  double last_tilt_rad = 0.0;
};

/// From the end of the gap on. The DVL says nothing from the gap on until `log_s`.
Fared with_gap(const SurveyRun& run, double from_s, double until_s, double log_s = 0.0) {
  FusionEngine engine(SurveyRun::config());
  Fared out;
  std::size_t row = 0;
  for (const test::Sample& sample : run.samples) {
    const bool inertial = std::holds_alternative<ImuSample>(sample);
    const double t_s = to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
    const std::size_t at = inertial ? row++ : row;
    if (inertial && t_s >= from_s && t_s < until_s) continue;
    if (std::holds_alternative<DvlSample>(sample) && t_s >= from_s && t_s < log_s) continue;
    test::feed(engine, sample);
    if (!inertial || t_s < until_s) continue;
    const NavState& nav = engine.nav_state();
    const Truth& truth = run.truth[at];
    const Eigen::Vector3d off_m =
        geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                          {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    out.last_tilt_rad = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double tilt_rad = std::abs(geo::wrap_pi(nav.rpy_rad[i] - truth.rpy_rad[i]));
      out.last_tilt_rad = std::max(out.last_tilt_rad, tilt_rad);
      out.worst_tilt_sigmas = std::max(out.worst_tilt_sigmas, tilt_rad / nav.rpy_sigma_rad[i]);
      out.worst_position_sigmas =
          std::max(out.worst_position_sigmas, std::abs(off_m(static_cast<Eigen::Index>(i))) /
                                                  std::sqrt(nav.position_covariance_N_m2[4 * i]));
    }
    out.last_position_m = off_m.norm();
  }
  return out;
}

// The last rate, held for seconds, would turn the vehicle over.
TEST(Gap, InWavesIsNoSwingThatGoesOn) {
  for (const double from_s : {30.0, 31.0, 32.0, 33.0}) {
    for (const double gap_s : {1.0, 3.0, 6.0, 9.0}) {
      const SurveyRun run({.duration_s = 60.0, .dive_s = 1e9, .wave_rad = 0.12, .usbl = false});
      const Fared fared = with_gap(run, from_s, from_s + gap_s);
      EXPECT_LT(fared.worst_tilt_sigmas, 4.0) << from_s << " " << gap_s;
      EXPECT_LT(fared.worst_position_sigmas, 4.0) << from_s << " " << gap_s;
      EXPECT_LT(fared.last_position_m, 3.0) << from_s << " " << gap_s;
      EXPECT_LT(fared.last_tilt_rad, 1.0 * kRadPerDeg) << from_s << " " << gap_s;
    }
  }
}

// Behind the gap attitude and velocity are both uncertain, and the product of their errors is more than the
// noise of what is measured: by the DVL when it is heard again (AID-DVL-4), until then by depth (NOISE-3) and
// compass (AID-HDG-3).
TEST(Gap, InWhichADiveBeginsIsTakenInByTheFirstVelocity) {
  for (const double from_s : {49.0, 50.0, 50.5}) {
    for (const double gap_s : {2.0, 3.0, 4.0}) {
      for (const double silent_s : {0.3, 1.3, 3.0, 6.0}) {
        const SurveyRun run({.duration_s = 75.0, .usbl = false});
        const Fared fared = with_gap(run, from_s, from_s + gap_s, from_s + gap_s + silent_s);
        SCOPED_TRACE(std::to_string(from_s) + " " + std::to_string(gap_s) + " " + std::to_string(silent_s));
        EXPECT_LT(fared.worst_tilt_sigmas, 4.0);
        EXPECT_LT(fared.worst_position_sigmas, 4.0);
        EXPECT_LT(fared.last_tilt_rad, 0.2 * kRadPerDeg);
      }
    }
  }
}

}  // namespace
}  // namespace fathom::estimation
