#include "dataset/score.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geo/so3.hpp"

namespace fathom::dataset {
namespace {

constexpr double kLatitude = 0.6;
constexpr double kLongitude = 3.1415;  // the date line is 600 m away
// Arc lengths of one radian at this latitude, from the closed forms with a = 6378137 m, f = 1/298.257223563.
constexpr double kMetresPerRadianNorth = 6355776.26;
constexpr double kMetresPerRadianEast = 5269730.25;

Truth row(double t_s, double north_m, double yaw_rad = 0.0) {
  Truth truth;
  truth.header.stamp_ns = from_seconds(t_s);
  truth.latitude_rad = kLatitude + north_m / kMetresPerRadianNorth;
  truth.longitude_rad = kLongitude;
  truth.altitude_m = -10.0 - t_s;
  truth.velocity_N_m_s = {t_s, 0.0, 1.0};
  truth.rpy_rad = {0.0, 0.1, yaw_rad};
  return truth;
}

TEST(NedDifference, IsMetresNorthEastDown) {
  const auto d = ned_difference_m(kLatitude + 1e-4, kLongitude + 2e-4, 5.0, kLatitude, kLongitude, 7.0);
  EXPECT_NEAR(d[0], 1e-4 * kMetresPerRadianNorth, 0.05);
  EXPECT_NEAR(d[1], 2e-4 * kMetresPerRadianEast, 0.1);
  EXPECT_DOUBLE_EQ(d[2], 2.0);
}

TEST(NedDifference, CrossesTheDateLineTheShortWay) {
  const auto d =
      ned_difference_m(kLatitude, -std::numbers::pi + 1e-6, 0.0, kLatitude, std::numbers::pi - 1e-6, 0.0);
  EXPECT_NEAR(d[1], 2e-6 * kMetresPerRadianEast, 1e-3);
}

TEST(TruthTrack, InterpolatesBetweenRowsAndNowhereElse) {
  const TruthTrack track({row(0.0, 0.0, 3.0), row(1.0, 10.0, -3.0), row(9.0, 20.0)});
  EXPECT_FALSE(track.at(-1));
  EXPECT_FALSE(track.at(from_seconds(5.0)));  // a gap of 8 s
  EXPECT_FALSE(track.at(from_seconds(9.5)));
  ASSERT_TRUE(track.at(0));
  ASSERT_TRUE(track.at(from_seconds(9.0)));
  const auto middle = track.at(from_seconds(0.25));
  ASSERT_TRUE(middle);
  EXPECT_NEAR((middle->latitude_rad - kLatitude) * kMetresPerRadianNorth, 2.5, 1e-6);
  EXPECT_DOUBLE_EQ(middle->altitude_m, -10.25);
  EXPECT_DOUBLE_EQ(middle->velocity_N_m_s[0], 0.25);
  // From 3 to -3 rad by way of pi.
  EXPECT_NEAR(middle->rpy_rad[2], 3.0 + 0.25 * (2.0 * std::numbers::pi - 6.0), 1e-12);
  EXPECT_EQ(middle->header.stamp_ns, from_seconds(0.25));
}

TEST(TruthTrack, TurnsOnTheShortestWayBetweenTwoAttitudes) {
  // A vehicle that dives and rolls at a steady rate: halfway its attitude is not the mean of the angles.
  const geo::Quaternion start = geo::from_rpy({0.9, -1.2, 0.4});
  const Eigen::Vector3d turn_rad(0.5, 0.6, -0.8);
  std::vector<Truth> rows;
  for (const double share : {0.0, 1.0}) {
    Truth at = row(share, 0.0);
    at.rpy_rad = geo::arr(geo::to_rpy(start * geo::exp(share * turn_rad)));
    rows.push_back(at);
  }
  const TruthTrack track(rows);
  for (const double share : {0.1, 0.5, 0.8}) {
    const auto at = track.at(from_seconds(share));
    ASSERT_TRUE(at);
    const geo::Quaternion expected = start * geo::exp(share * turn_rad);
    const geo::Quaternion own = geo::from_rpy({at->rpy_rad[0], at->rpy_rad[1], at->rpy_rad[2]});
    EXPECT_LT(geo::log(geo::conjugate(expected) * own).norm(), 1e-9) << share;
  }
}

TEST(TruthTrack, AHeadingAloneTurnsTheShorterWay) {
  Truth a = row(0.0, 0.0, 3.0);
  Truth b = row(1.0, 0.0, -3.0);
  a.rpy_rad[0] = a.rpy_rad[1] = b.rpy_rad[0] = b.rpy_rad[1] = kUnknown;
  const auto at = TruthTrack({a, b}).at(from_seconds(0.5));
  ASSERT_TRUE(at);
  EXPECT_NEAR(std::abs(at->rpy_rad[2]), 3.14159265358979, 1e-9);
  EXPECT_FALSE(known(at->rpy_rad[0]));
}

TEST(TruthTrack, MeasuresThePath) {
  TruthTrack track;
  EXPECT_EQ(track.distance_m(0, 1), 0.0);
  track.add(row(0.0, 0.0));
  track.add(row(1.0, 10.0));
  track.add(row(0.5, 99.0));  // out of order: not taken
  track.add(row(2.0, 0.0));
  EXPECT_EQ(track.rows().size(), 3U);
  EXPECT_NEAR(track.distance_m(from_seconds(-5.0), from_seconds(50.0)), 20.0, 1e-3);
  EXPECT_NEAR(track.distance_m(from_seconds(0.5), from_seconds(1.25)), 7.5, 1e-3);
  EXPECT_EQ(track.distance_m(from_seconds(1.0), from_seconds(0.5)), 0.0);
}

NavState state_at(const Truth& truth) {
  NavState state;
  state.header.stamp_ns = truth.header.stamp_ns;
  state.latitude_rad = truth.latitude_rad;
  state.longitude_rad = truth.longitude_rad;
  state.altitude_m = truth.altitude_m;
  state.velocity_N_m_s = truth.velocity_N_m_s;
  state.rpy_rad = truth.rpy_rad;
  state.position_covariance_N_m2 = {4.0, 1.0, 0.0, 1.0, 9.0, 0.0, 0.0, 0.0, 1.0};
  state.velocity_covariance_N_m2_s2 = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  return state;
}

TEST(ErrorOf, IsEstimateMinusTruthWithItsConsistency) {
  const Truth truth = row(1.0, 0.0, -3.1);
  NavState state = state_at(truth);
  state.latitude_rad += 3.0 / kMetresPerRadianNorth;
  state.longitude_rad -= 4.0 / kMetresPerRadianEast;
  state.altitude_m -= 2.0;
  state.velocity_N_m_s[1] += 0.5;
  state.rpy_rad[2] = 3.1;
  const NavError error = error_of(state, truth);
  EXPECT_NEAR(error.position_N_m[0], 3.0, 1e-3);
  EXPECT_NEAR(error.position_N_m[1], -4.0, 1e-3);
  EXPECT_NEAR(error.position_N_m[2], 2.0, 1e-12);
  EXPECT_NEAR(error.horizontal_m, 5.0, 1e-3);
  EXPECT_NEAR(error.rpy_rad[2], 6.2 - 2.0 * std::numbers::pi, 1e-12);
  // [3 -4] [4 1; 1 9]^-1 [3 -4]' = (9*9 + 2*12 + 4*16) / 35.
  EXPECT_NEAR(error.nees_horizontal, 169.0 / 35.0, 5e-3);
  EXPECT_NEAR(error.nees_position, 169.0 / 35.0 + 4.0, 5e-3);
  EXPECT_DOUBLE_EQ(error.nees_velocity, 0.25);
}

TEST(ErrorOf, KeepsTheUnknownUnknown) {
  Truth truth = row(1.0, 0.0);
  truth.rpy_rad = {kUnknown, kUnknown, kUnknown};
  NavState state = state_at(truth);
  state.position_covariance_N_m2[0] = -1.0;
  const NavError error = error_of(state, truth);
  EXPECT_FALSE(known(error.rpy_rad[0]));
  EXPECT_FALSE(known(error.nees_position));
  EXPECT_EQ(error.horizontal_m, 0.0);
}

TEST(Scorer, ReportsRootMeanSquarePercentileLargestAndLast) {
  Scorer scorer;
  EXPECT_EQ(scorer.score().count, 0U);
  EXPECT_FALSE(known(scorer.score().horizontal_m.rms));
  for (int i = 1; i <= 100; ++i) {
    NavError error;
    error.stamp_ns = i;
    error.horizontal_m = i;
    error.position_N_m = {static_cast<double>(-i), 0.0, 0.0};
    error.nees_horizontal = i <= 90 ? 2.0 : 20.0;
    scorer.add(error);
  }
  const Score score = scorer.score();
  EXPECT_EQ(score.count, 100U);
  EXPECT_EQ(score.first_ns, 1);
  EXPECT_EQ(score.last_ns, 100);
  EXPECT_NEAR(score.horizontal_m.rms, std::sqrt(101.0 * 201.0 / 6.0), 1e-9);
  EXPECT_EQ(score.horizontal_m.p95, 95.0);
  EXPECT_EQ(score.horizontal_m.max, 100.0);
  EXPECT_EQ(score.horizontal_m.end, 100.0);
  EXPECT_EQ(score.position_N_m[0].end, -100.0);
  EXPECT_EQ(score.position_N_m[0].max, 100.0);
  EXPECT_FALSE(known(score.rpy_rad[0].rms));
  EXPECT_EQ(score.nees_horizontal.count, 100U);
  EXPECT_NEAR(score.nees_horizontal.mean, 3.8, 1e-12);
  EXPECT_NEAR(score.nees_horizontal.inside, 0.9, 1e-12);
  EXPECT_EQ(score.nees_velocity.count, 0U);
}

}  // namespace
}  // namespace fathom::dataset
