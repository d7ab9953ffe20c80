// Ranges to beacons as the only thing that says where the vehicle is once it has dived.

#include "estimation/aiding/beacon_range.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <variant>

#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "support/orders.hpp"
#include "support/sanitized.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Normal;
using test::SurveyRun;

constexpr double kDive_s = 50.0;
constexpr double kDvlEnds_s = 90.0;
constexpr double kRangeSigma_m = 0.5;
constexpr double kPlaceSigma_m = 1.0;  ///< as the default of states.beacon_place_sigma_m
const Vector3d kModem_B(0.3, -0.1, -0.2);

/// Of one beacon after the other, once the vehicle is under water, two seconds late. Each lies a metre or so
/// from where it is said to.
std::vector<RangeSample> ranges(const SurveyRun& survey, const std::vector<Vector3d>& beacons_N_m,
                                std::uint64_t seed) {
  std::vector<RangeSample> out;
  Normal normal(seed);
  const Truth& first = survey.truth.front();
  const geo::Geodetic start{first.latitude_rad, first.longitude_rad, SurveyRun::kSurfaceAltitude_m};
  std::vector<Vector3d> lie_at_N_m = beacons_N_m;
  for (Vector3d& one : lie_at_N_m) one.head<2>() += normal.vector(kPlaceSigma_m).head<2>();
  std::uint64_t sequence = 0;
  for (std::size_t k = 250; !beacons_N_m.empty() && k < survey.truth.size(); k += 300) {
    const Truth& truth = survey.truth[k];
    if (0.01 * static_cast<double>(k) < kDive_s) continue;
    const std::size_t asked = sequence % beacons_N_m.size();
    const Vector3d& place = beacons_N_m[asked];
    const geo::Geodetic beacon = geo::moved_by(start, place);
    const geo::Geodetic lies_at = geo::moved_by(start, lie_at_N_m[asked]);
    const Matrix3d C_NB = geo::to_matrix(geo::from_rpy(geo::vec(truth.rpy_rad)));
    const Vector3d path_N =
        geo::difference_N(lies_at, {truth.latitude_rad, truth.longitude_rad, truth.altitude_m}) +
        C_NB * kModem_B;
    RangeSample s;
    s.header = {"auv", "modem", truth.header.stamp_ns, truth.header.stamp_ns + 2 * kNsPerSecond, ++sequence};
    s.range_m = path_N.norm() + normal(kRangeSigma_m);
    s.sigma_m = kRangeSigma_m;
    s.beacon_latitude_rad = beacon.latitude_rad;
    s.beacon_longitude_rad = beacon.longitude_rad;
    s.beacon_depth_m = place.z();
    out.push_back(s);
  }
  return out;
}

struct Outcome {
  double horizontal_max_m = 0.0;
  double sigma_end_m = 0.0;
  double worst_sigmas = 0.0;  ///< horizontal error over its own standard deviation
  double nees = 0.0;          ///< mean of the horizontal position, once the Doppler log is gone
  std::map<VerdictKind, int> verdicts;
  bool ever_acoustic = false;
};

EngineConfig engine_config() {
  EngineConfig config = SurveyRun::config();
  EXPECT_TRUE(named_state_groups("full", config.groups));
  SensorConfig modem = default_sensor(SourceKind::range, "modem");
  modem.sigma = {kRangeSigma_m, kRangeSigma_m, kRangeSigma_m};
  modem.lever_B_m = geo::arr(kModem_B);
  config.sensors.push_back(modem);
  return config;
}

Outcome run(const std::vector<Vector3d>& beacons_N_m, std::uint64_t seed = 3, bool known_places = true) {
  const SurveyRun survey({.duration_s = 240.0, .dive_s = kDive_s, .seed = seed, .usbl = false});
  std::vector<RangeSample> late = ranges(survey, beacons_N_m, 100 + seed);
  FusionEngine engine(engine_config());
  Outcome out;
  std::size_t index = 0;
  std::size_t heard = 0;
  int counted = 0;
  Verdict verdict;
  for (const test::Sample& sample : survey.samples) {
    const SampleHeader& header = test::header(sample);
    for (; heard < late.size() && late[heard].header.received_ns <= header.received_ns; ++heard) {
      if (!known_places) late[heard].beacon_latitude_rad = kUnknown;
      engine.add(late[heard]);
    }
    const double t = to_seconds(header.stamp_ns - SurveyRun::kEpochNs);
    if (std::holds_alternative<DvlSample>(sample) && t > kDvlEnds_s) continue;
    test::feed(engine, sample);
    while (engine.next_verdict(verdict))
      if (verdict.source == SourceKind::range && is_news(verdict)) ++out.verdicts[verdict.kind];
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = survey.truth[index++];
    const NavState& nav = engine.nav_state();
    out.ever_acoustic = out.ever_acoustic || nav.mode == NavMode::acoustic_aided;
    if (t < kDvlEnds_s) continue;
    const Vector3d e = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                         {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    const auto& p = nav.position_covariance_N_m2;
    out.horizontal_max_m = std::max(out.horizontal_max_m, std::hypot(e.x(), e.y()));
    const double squared = (e.x() * e.x() * p[4] - 2.0 * e.x() * e.y() * p[1] + e.y() * e.y() * p[0]) /
                           (p[0] * p[4] - p[1] * p[3]);
    out.worst_sigmas = std::max(out.worst_sigmas, std::sqrt(squared));
    out.nees += squared;
    ++counted;
    out.sigma_end_m = std::sqrt(p[0] + p[4]);
  }
  out.nees /= counted;
  return out;
}

const Vector3d kAhead(300.0, 100.0, 60.0);
const Vector3d kAbeam(-100.0, 350.0, 40.0);

TEST(BeaconRange, TwoBeaconsBoundTheDriftOnceTheDopplerLogIsGone) {
  const Outcome without = run({});
  EXPECT_GT(without.horizontal_max_m, 15.0);
  Outcome out = run({kAhead, kAbeam});
  EXPECT_LT(out.horizontal_max_m, 4.0);
  EXPECT_LT(out.worst_sigmas, 4.5);
  EXPECT_GT(out.verdicts[VerdictKind::used], 55);
}

TEST(BeaconRange, OneBeaconBoundsWhatLiesAlongThePathAndTheRestStaysUncertain) {
  Outcome out = run({kAbeam});
  EXPECT_LT(out.sigma_end_m, 0.8 * run({}).sigma_end_m);
  EXPECT_LT(out.worst_sigmas, 4.5);
  EXPECT_GT(out.verdicts[VerdictKind::used], 55);
}

TEST(BeaconRange, AloneItNeverClaimsAPosition) {
  EXPECT_FALSE(run({kAhead, kAbeam}).ever_acoustic);
  EXPECT_EQ(BeaconRange::policy({}, RangeSample{}).fix, Fix::none);
}

TEST(BeaconRange, ItsUncertaintyIsHonestOverSeeds) {
  FATHOM_MANY_RUNS();
  double two = 0.0;
  double one = 0.0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 20; seed < 20 + kSeeds; ++seed) {
    two += run({kAhead, kAbeam}, seed).nees / kSeeds;
    one += run({kAbeam}, seed).nees / kSeeds;
  }
  // Of two components; the errors of a run hang together, so the band is that of a few dozen draws.
  EXPECT_GT(two, 0.7);
  EXPECT_LT(two, 3.5);
  EXPECT_GT(one, 0.7);
  EXPECT_LT(one, 3.5);
}

TEST(BeaconRange, APlaceThatNobodyKnowsIsAnUnknownFrame) {
  Outcome out = run({kAhead}, 3, false);
  EXPECT_EQ(out.verdicts[VerdictKind::used], 0);
  EXPECT_GT(out.verdicts[VerdictKind::unknown_frame], 55);
}

TEST(BeaconRange, AStateThatHoldsRangesIsTakenUpToTheLastBit) {
  const SurveyRun survey({.duration_s = 64.0, .dive_s = kDive_s, .usbl = false});
  const std::vector<RangeSample> late = ranges(survey, {kAhead, kAbeam}, 7);
  FusionEngine first(engine_config());
  FusionEngine second(engine_config());
  std::size_t heard = 0;
  bool taken_up = false;
  for (const test::Sample& sample : survey.samples) {
    const TimeNs now_ns = test::header(sample).received_ns;
    for (; heard < late.size() && late[heard].header.received_ns <= now_ns; ++heard) {
      first.add(late[heard]);
      if (taken_up) second.add(late[heard]);
    }
    if (!taken_up && heard == 3) {
      std::vector<std::byte> image;
      ASSERT_TRUE(first.save(image));
      ASSERT_EQ(second.restore(image), "");
      taken_up = true;
    }
    test::feed(first, sample);
    if (taken_up) test::feed(second, sample);
  }
  ASSERT_TRUE(taken_up);
  ASSERT_GT(heard, 3U);
  EXPECT_EQ(first.nav_state().latitude_rad, second.nav_state().latitude_rad);
  EXPECT_EQ(first.nav_state().position_covariance_N_m2, second.nav_state().position_covariance_N_m2);
}

/// Of each beacon its address as the bridge tells it, or none as in a data set.
void name_by_place(std::vector<RangeSample>& ranges) {
  std::map<double, std::string> names;
  for (RangeSample& one : ranges)
    one.beacon =
        std::string_view(names.emplace(one.beacon_latitude_rad, std::to_string(names.size())).first->second);
}

/// Horizontal error at the end when somebody ordered the vehicle 150 m away and was sure of it, the Doppler
/// log goes on, and nothing but ranges can tell.
double error_left_m(std::vector<RangeSample> late) {
  constexpr double kOrder_s = 60.0;
  const SurveyRun survey({.duration_s = 240.0, .dive_s = kDive_s, .usbl = false});
  FusionEngine engine(engine_config());
  std::size_t heard = 0;
  bool ordered = false;
  for (const test::Sample& sample : survey.samples) {
    const SampleHeader& header = test::header(sample);
    for (; heard < late.size() && late[heard].header.received_ns <= header.received_ns; ++heard)
      engine.add(late[heard]);
    test::feed(engine, sample);
    if (ordered || to_seconds(header.stamp_ns - SurveyRun::kEpochNs) < kOrder_s) continue;
    Command command;
    command.kind = CommandKind::set_position;
    command.latitude_rad = engine.nav_state().latitude_rad + 150.0 / 6.37e6;
    command.longitude_rad = engine.nav_state().longitude_rad;
    command.sigma_m = 1.0;
    ordered = test::order_twice(engine, command).empty();
  }
  const Truth& truth = survey.truth.back();
  const NavState& nav = engine.nav_state();
  return geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                           {nav.latitude_rad, nav.longitude_rad, nav.altitude_m})
      .head<2>()
      .norm();
}

TEST(BeaconRange, RefusedOnesOfSeveralBeaconsInTurnAreBelievedAsThoseOfOneAre) {
  const SurveyRun survey({.duration_s = 240.0, .dive_s = kDive_s, .usbl = false});
  // From all sides: what is too long to one is too short to another.
  const std::vector<Vector3d> around{kAhead, kAbeam, {-400.0, -150.0, 50.0}, {150.0, -400.0, 50.0}};
  std::vector<RangeSample> late = ranges(survey, around, 9);
  EXPECT_LT(error_left_m(late), 5.0);
  name_by_place(late);
  EXPECT_LT(error_left_m(late), 5.0);
}

TEST(BeaconRange, TwoBeaconsMayAnswerAtOneInstantAndOneBeaconNotTwice) {
  const SurveyRun survey({.duration_s = 64.0, .dive_s = kDive_s, .usbl = false});
  std::vector<RangeSample> late = ranges(survey, {kAhead, kAbeam}, 7);
  for (const bool named : {false, true}) {
    if (named) name_by_place(late);
    FusionEngine engine(engine_config());
    std::map<VerdictKind, int> verdicts;
    for (const test::Sample& sample : survey.samples) test::feed(engine, sample);
    const TimeNs stamp_ns = engine.nav_state().header.stamp_ns - kNsPerSecond;
    for (const std::size_t i : {0, 1, 1}) {
      RangeSample one = late[i];
      one.header.stamp_ns = stamp_ns;
      one.header.sequence = 1'000 + verdicts[VerdictKind::used]++;
      engine.add(one);
    }
    verdicts.clear();
    engine.finish();
    for (Verdict verdict; engine.next_verdict(verdict);)
      if (verdict.source == SourceKind::range && verdict.is_final) ++verdicts[verdict.kind];
    EXPECT_EQ(verdicts[VerdictKind::duplicate], 1) << named;
    EXPECT_EQ(verdicts[VerdictKind::used] + verdicts[VerdictKind::rejected], 2) << named;
  }
}

/// The row of a range at a state without anything else, for a position with this uncertainty.
Observation row(double sigma_m, const Vector3d& beacon_N_m, double range_m, double own_sigma_m) {
  const StateIndex index{StateGroups{}};
  FilterState state;
  state.nav.position = {0.6, 2.2, -20.0};
  const AidingState aiding(index, state, Vector3d::Zero(), kUnknown);
  SensorConfig sensor = default_sensor(SourceKind::range, "modem");
  sensor.sigma.fill(own_sigma_m);
  const geo::Geodetic beacon = geo::moved_by(state.nav.position, beacon_N_m);
  RangeSample sample;
  sample.range_m = range_m;
  sample.beacon_latitude_rad = beacon.latitude_rad;
  sample.beacon_longitude_rad = beacon.longitude_rad;
  sample.beacon_depth_m = -beacon.altitude_m;
  Observation out;
  EXPECT_EQ(BeaconRange::append_rows({.state = aiding,
                                      .sensor = sensor,
                                      .surface_altitude_m = 0.0,
                                      .position_covariance_N_m2 = sigma_m * sigma_m * Matrix3d::Identity()},
                                     sample, out),
            Usable::yes);
  return out;
}

TEST(BeaconRange, ASphereIsNotFlatWithinTheUncertaintyOfThePosition) {
  // Ranges from places drawn at the sigma: mean and spread of the innovation are those that the row says.
  Normal normal(8);
  const Vector3d beacon(60.0, 20.0, 10.0);
  constexpr double kSigma_m = 15.0;
  const Observation at = row(kSigma_m, beacon, beacon.norm(), 0.5);
  double mean = 0.0;
  double square = 0.0;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    const Vector3d error = normal.vector(kSigma_m);
    const double range_m = (beacon + error).norm() + normal(0.5);
    const double innovation = at.innovation[0] + beacon.norm() - range_m;
    const double linear = error.dot(beacon.normalized());
    mean += innovation / kDraws;
    square += (innovation + linear) * (innovation + linear) / kDraws;
  }
  EXPECT_NEAR(mean, 0.0, 0.6);  // 3.5 m without the curvature
  EXPECT_NEAR(std::sqrt(square), at.sigma[0], 0.15 * at.sigma[0]);
  EXPECT_GT(at.sigma[0], 2.0);
  EXPECT_NEAR(row(0.0, beacon, beacon.norm(), 0.5).sigma[0], 0.5, 1e-12);
}

TEST(BeaconRange, WhatNoRangeCanBeIsOutOfRange) {
  SensorConfig sensor = default_sensor(SourceKind::range, "modem");
  RangeSample sample;
  sample.range_m = 100.0;
  EXPECT_EQ(BeaconRange::usable(sensor, sample), Usable::unknown_frame);
  sensor.transceiver_known = true;
  EXPECT_EQ(BeaconRange::usable(sensor, sample), Usable::yes);
  for (const double range_m : {kUnknown, 0.0, -5.0, 1e9}) {
    sample.range_m = range_m;
    EXPECT_EQ(BeaconRange::usable(sensor, sample), Usable::out_of_range) << range_m;
  }
  sample.range_m = 100.0;
  sample.beacon_latitude_rad = 2.0;
  sample.beacon_longitude_rad = 0.0;
  sample.beacon_depth_m = 10.0;
  EXPECT_EQ(BeaconRange::usable(sensor, sample), Usable::out_of_range);
}

}  // namespace
}  // namespace fathom::estimation
