// Late fixes, told at random instants of random instants and arriving in random order, give the same bits,
// also through a saved state.

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::Normal;
using test::SurveyRun;

struct Arrival {
  TimeNs at_ns = 0;
  FixSample fix;
};

NavState run(const SurveyRun& survey, const EngineConfig& config, std::vector<Arrival> arrivals,
             double save_s) {
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.at_ns < b.at_ns; });
  auto engine = std::make_unique<FusionEngine>(config);
  std::size_t next = 0;
  bool saved = save_s <= 0.0;
  for (const test::Sample& sample : survey.samples) {
    const TimeNs now_ns = test::header(sample).received_ns;
    for (; next < arrivals.size() && arrivals[next].at_ns <= now_ns; ++next) engine->add(arrivals[next].fix);
    test::feed(*engine, sample);
    if (saved || now_ns < SurveyRun::kEpochNs + from_seconds(save_s)) continue;
    std::vector<std::byte> bytes;
    EXPECT_TRUE(engine->save(bytes));
    engine = std::make_unique<FusionEngine>(config);
    EXPECT_EQ(engine->restore(bytes), "");
    saved = true;
  }
  return engine->nav_state();
}

TEST(LateFixes, InWhateverOrderTheyComeTheStateIsTheSame) {
  EngineConfig config = SurveyRun::config();
  config.sensors.push_back(default_sensor(SourceKind::fix, "operator"));
  config.sensors.push_back(default_sensor(SourceKind::fix, "ship"));
  config.late_fix_memory_s = 90.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const SurveyRun survey({.duration_s = 115.0, .dive_s = 50.0, .seed = seed, .usbl = seed % 2 == 0});
    Normal normal(50 + seed);
    std::vector<Arrival> punctual;
    for (std::uint64_t i = 0; i < 7; ++i) {
      const double told_s = normal.uniform(60.0, 108.0);
      const double then_s = told_s - normal.uniform(0.0, 50.0);
      const Truth& truth = survey.truth[static_cast<std::size_t>(100.0 * then_s)];
      Arrival one;
      one.at_ns = SurveyRun::kEpochNs + from_seconds(told_s);
      one.fix.header = {"auv", i % 3 == 0 ? "ship" : "operator", truth.header.stamp_ns, one.at_ns, i};
      Eigen::Vector3d off = normal.vector(3.0);
      if (i == 4) off.x() += 500.0;
      const geo::Geodetic place =
          geo::moved_by({truth.latitude_rad, truth.longitude_rad, truth.altitude_m}, off);
      one.fix.latitude_rad = place.latitude_rad;
      one.fix.longitude_rad = place.longitude_rad;
      one.fix.sigma_m = 3.0;
      if (i % 2 == 1) {
        one.fix.depth_m = SurveyRun::kSurfaceAltitude_m - place.altitude_m;
        one.fix.depth_sigma_m = 3.0;
      }
      punctual.push_back(one);
    }
    const NavState wanted = run(survey, config, punctual, 0.0);
    for (int trial = 0; trial < 3; ++trial) {
      std::vector<Arrival> shuffled = punctual;
      for (Arrival& one : shuffled) one.at_ns += from_seconds(normal.uniform(0.0, 2.4));
      const NavState got = run(survey, config, shuffled, trial == 0 ? 0.0 : normal.uniform(70.0, 105.0));
      EXPECT_EQ(got.latitude_rad, wanted.latitude_rad) << seed;
      EXPECT_EQ(got.longitude_rad, wanted.longitude_rad) << seed;
      EXPECT_EQ(got.position_covariance_N_m2, wanted.position_covariance_N_m2) << seed;
      EXPECT_EQ(got.q_NB, wanted.q_NB) << seed;
      EXPECT_EQ(got.reset_counter, wanted.reset_counter) << seed;
    }
  }
}

}  // namespace
}  // namespace fathom::estimation
