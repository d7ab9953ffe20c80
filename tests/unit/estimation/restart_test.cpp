// Navigation that begins while the vehicle is already under way, as after a fusion that was killed.
#include <cmath>

#include <gtest/gtest.h>

#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

struct RestartOutcome {
  double aligned_after_s = kUnknown;
  double horizontal_m = 0.0;        ///< error at the end
  double horizontal_sigma_m = 0.0;  ///< of the filter at the end
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;
};

RestartOutcome begin_at(double start_s, const SurveyRun::Options& options) {
  const SurveyRun run(options);
  FusionEngine engine(SurveyRun::config());
  const TimeNs begin = SurveyRun::kEpochNs + from_seconds(start_s);
  RestartOutcome out;
  for (const auto& sample : run.samples) {
    const SampleHeader& header = test::header(sample);
    if (header.received_ns < begin) continue;
    test::feed(engine, sample);
    if (!known(out.aligned_after_s) && engine.nav_state().alignment == AlignmentPhase::aligned) {
      out.aligned_after_s = to_seconds(header.received_ns - begin);
    }
  }
  const NavState& nav = engine.nav_state();
  const Truth& truth = run.truth.back();
  const Eigen::Vector3d error = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                                  {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  out.horizontal_m = std::hypot(error.x(), error.y());
  out.horizontal_sigma_m = std::sqrt(nav.position_covariance_N_m2[0] + nav.position_covariance_N_m2[4]);
  out.yaw_rad = std::remainder(nav.rpy_rad[2] - truth.rpy_rad[2], 2.0 * M_PI);
  out.yaw_sigma_rad = nav.rpy_sigma_rad[2];
  return out;
}

TEST(Restart, UnderWayOnTheSurfaceWithGpsAndCompass) {
  // 1.8 m/s: too slow for the course to be a heading, too fast for levelling at rest.
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RestartOutcome out = begin_at(35.0, {.duration_s = 75.0, .dive_s = 70.0, .seed = seed});
    EXPECT_LT(out.aligned_after_s, 25.0) << "seed " << seed;
    EXPECT_LT(out.horizontal_m, 4.0 * out.horizontal_sigma_m + 0.5) << "seed " << seed;
    EXPECT_LT(out.horizontal_m, 5.0) << "seed " << seed;
    EXPECT_LT(std::abs(out.yaw_rad), 4.0 * out.yaw_sigma_rad) << "seed " << seed;
  }
}

TEST(Restart, UnderWaterWithDvlCompassAndUsbl) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RestartOutcome out = begin_at(75.0, {.duration_s = 140.0, .dive_s = 50.0, .seed = seed});
    EXPECT_LT(out.aligned_after_s, 50.0) << "seed " << seed;
    EXPECT_LT(out.horizontal_m, 4.0 * out.horizontal_sigma_m + 0.5) << "seed " << seed;
    EXPECT_LT(out.horizontal_m, 10.0) << "seed " << seed;
    EXPECT_LT(std::abs(out.yaw_rad), 4.0 * out.yaw_sigma_rad) << "seed " << seed;
  }
}

TEST(Restart, UnderWaterWithoutAnyPositionThereIsNone) {
  const RestartOutcome out = begin_at(75.0, {.duration_s = 100.0, .dive_s = 50.0, .seed = 1, .usbl = false});
  EXPECT_FALSE(known(out.aligned_after_s));
  EXPECT_TRUE(std::isnan(out.horizontal_m));
}

}  // namespace
}  // namespace fathom::estimation
