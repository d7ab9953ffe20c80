#include <map>

#include <gtest/gtest.h>

#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

struct Score {
  double horizontal_rms_m = 0.0;
  double horizontal_max_m = 0.0;
  double attitude_max_rad = 0.0;
  double heading_end_rad = 0.0;
  double nees_mean = 0.0;  ///< of the horizontal position
  double aligned_after_s = -1.0;
  std::map<VerdictKind, int> verdicts;
  std::map<SourceKind, int> used;
  int first_verdicts = 0;
  std::size_t states = 0;
};

Score run(const SurveyRun& survey, const EngineConfig& config) {
  FusionEngine engine(config);
  Score score;
  int count = 0;
  const auto take_verdicts = [&] {
    Verdict verdict;
    while (engine.next_verdict(verdict)) {
      score.first_verdicts += verdict.revision == 0 ? 1 : 0;
      if (!verdict.is_final) continue;
      ++score.verdicts[verdict.kind];
      if (verdict.kind == VerdictKind::used) ++score.used[verdict.source];
    }
  };
  for (const test::Sample& sample : survey.samples) {
    test::feed(engine, sample);
    take_verdicts();
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = survey.truth[score.states++];
    const NavState& nav = engine.nav_state();
    EXPECT_EQ(nav.header.stamp_ns, truth.header.stamp_ns);
    if (nav.alignment == AlignmentPhase::aligned && score.aligned_after_s < 0.0)
      score.aligned_after_s = to_seconds(nav.header.stamp_ns - SurveyRun::kEpochNs);
    if (nav.mode < NavMode::gps_aided) continue;
    const Eigen::Vector3d e = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                                {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    const double horizontal = std::hypot(e.x(), e.y());
    score.horizontal_rms_m += horizontal * horizontal;
    score.horizontal_max_m = std::max(score.horizontal_max_m, horizontal);
    for (std::size_t i = 0; i < 2; ++i)
      score.attitude_max_rad = std::max(score.attitude_max_rad, std::abs(nav.rpy_rad[i] - truth.rpy_rad[i]));
    score.heading_end_rad = std::abs(geo::wrap_pi(nav.rpy_rad[2] - truth.rpy_rad[2]));
    const auto& p = nav.position_covariance_N_m2;
    const double det = p[0] * p[4] - p[1] * p[3];
    score.nees_mean += (e.x() * e.x() * p[4] - 2.0 * e.x() * e.y() * p[1] + e.y() * e.y() * p[0]) / det;
    ++count;
  }
  engine.finish();
  take_verdicts();
  score.horizontal_rms_m = std::sqrt(score.horizontal_rms_m / count);
  score.nees_mean /= count;
  return score;
}

TEST(Survey, NavigatesFromRestThroughADive) {
  const SurveyRun survey({.duration_s = 180.0});
  Score score = run(survey, SurveyRun::config());
  EXPECT_LT(score.horizontal_rms_m, 2.0);
  EXPECT_LT(score.horizontal_max_m, 4.0);
  EXPECT_LT(score.attitude_max_rad, 0.01);
  EXPECT_LT(score.heading_end_rad, 0.03);
  EXPECT_GT(score.aligned_after_s, 8.0);
  EXPECT_LT(score.aligned_after_s, 20.0);
  EXPECT_EQ(score.states, survey.truth.size());
  // Good data are not thrown away.
  EXPECT_LE(score.verdicts[VerdictKind::rejected], 5);
  EXPECT_EQ(score.verdicts.count(VerdictKind::late), 0U);
  EXPECT_EQ(score.verdicts.count(VerdictKind::duplicate), 0U);
  EXPECT_EQ(score.verdicts.count(VerdictKind::frozen), 0U);
  EXPECT_GT(score.used[SourceKind::dvl], 800);
  EXPECT_GT(score.used[SourceKind::gps], 60);
  EXPECT_GT(score.used[SourceKind::usbl], 15);
}

TEST(Survey, SaysHowWrongItIs) {
  // Mean over seeds of the squared error in units of the covariance: 2 for a perfect filter.
  double nees = 0.0;
  constexpr int kSeeds = 6;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const SurveyRun survey({.duration_s = 110.0, .seed = static_cast<std::uint64_t>(seed)});
    nees += run(survey, SurveyRun::config()).nees_mean / kSeeds;
  }
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 3.5);
}

TEST(Survey, EveryMeasurementHasExactlyOneFinalVerdict) {
  const SurveyRun survey({.duration_s = 70.0});
  Score score = run(survey, SurveyRun::config());
  int verdicts = 0;
  for (const auto& [kind, count] : score.verdicts) verdicts += count;
  int measurements = 0;
  for (const test::Sample& sample : survey.samples)
    measurements += std::holds_alternative<ImuSample>(sample) ? 0 : 1;
  EXPECT_EQ(verdicts, measurements);
  EXPECT_EQ(score.first_verdicts, measurements);
}

TEST(Survey, EachNamedConfigurationWorks) {
  const SurveyRun survey({.duration_s = 100.0});
  for (const char* name : {"gps_ins15", "standard", "hybrid25", "full"}) {
    EngineConfig config = SurveyRun::config();
    config.configuration = name;
    ASSERT_TRUE(named_state_groups(name, config.groups));
    // Without a state for it, the height of the surface must be known.
    config.states.surface_altitude_m = SurveyRun::kSurfaceAltitude_m;
    const Score score = run(survey, config);
    EXPECT_LT(score.horizontal_rms_m, 3.0) << name;
    EXPECT_LT(score.attitude_max_rad, 0.012) << name;
  }
}

}  // namespace
}  // namespace fathom::estimation
