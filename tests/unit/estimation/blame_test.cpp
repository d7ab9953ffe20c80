// The water changes, or the instruments contradict each other: what is to blame gets the room.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "support/vehicles/spoilt_survey.hpp"

namespace fathom::test {
namespace {

using Eigen::Vector3d;

/// Truth at an instant.
const Truth& truth_at(const SurveyRun& run, TimeNs stamp_ns) {
  const auto next =
      std::lower_bound(run.truth.begin(), run.truth.end() - 1, stamp_ns,
                       [](const Truth& row, TimeNs at_ns) { return row.header.stamp_ns < at_ns; });
  return *next;
}

/// The same survey, whose DVL measures the water layer with each ping as well; the current is
/// `current_N(t_s)`.
template <class Current>
SurveyRun with_water_layer(const SurveyRun& run, const Current& current_N_m_s) {
  SurveyRun out = run;
  out.samples.clear();
  for (const Sample& sample : run.samples) {
    out.samples.push_back(sample);
    auto* bottom = std::get_if<DvlSample>(&out.samples.back());
    if (bottom == nullptr) continue;
    bottom->header.sequence *= 2;
    DvlSample water = *bottom;
    ++water.header.sequence;
    water.mode = DvlMode::water;
    const Vector3d rpy_rad = geo::vec(truth_at(run, water.header.stamp_ns).rpy_rad);
    const Vector3d current_B =
        geo::to_matrix(geo::from_rpy(rpy_rad)).transpose() * current_N_m_s(seconds_of(sample));
    for (std::size_t i = 0; i < 3; ++i) water.velocity_D_m_s[i] -= current_B[static_cast<Eigen::Index>(i)];
    out.samples.emplace_back(water);
  }
  return out;
}

/// 0.9 m/s that set in within five seconds.
auto sets_in_at(double from_s) {
  return [=](double t_s) {
    const double share = std::clamp((t_s - from_s) / 5.0, 0.0, 1.0);
    return Vector3d(0.6 * share, -0.7 * share, 0.0);
  };
}

TEST(Blame, AChangedCurrentIsNotTakenForTheVelocity) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SurveyRun run({.duration_s = 140.0, .seed = seed, .usbl = false});
    const SpoiltSurvey got = survey(with_water_layer(run, sets_in_at(90.0)), 60.0, [](Sample&, double) {});
    EXPECT_LT(got.worst_h_sigmas, 3.7) << seed;
  }
}

TEST(Blame, WithoutTheBottomAChangedCurrentIsAsLikelyAsTheVelocity) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SurveyRun run({.duration_s = 120.0, .seed = seed, .usbl = false});
    SurveyRun with_water = with_water_layer(run, sets_in_at(75.0));
    std::erase_if(with_water.samples, [](const Sample& sample) {
      const auto* dvl = std::get_if<DvlSample>(&sample);
      return dvl != nullptr && dvl->mode == DvlMode::bottom && seconds_of(sample) > 65.0;
    });
    const SpoiltSurvey got = survey(with_water, 60.0, [](Sample&, double) {});
    EXPECT_LT(got.worst_h_sigmas, 3.7) << seed;
  }
}

TEST(Blame, AnAccelerometerThatIsWorseThanDeclaredIsFoundOutByTheLevelThatGoesWrongAgain) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    // Forty times the sigma of its bias.
    const SurveyRun run({.duration_s = 300.0, .seed = seed, .accel_bias_m_s2 = 0.2});
    const SpoiltSurvey got = survey(run, 200.0, [](Sample&, double) {});
    EXPECT_LT(got.worst_h_sigmas, 3.7) << seed;
    EXPECT_LT(got.refused, 300) << seed;
  }
}

}  // namespace
}  // namespace fathom::test
