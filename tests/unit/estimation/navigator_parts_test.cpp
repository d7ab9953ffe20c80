// The navigator's parts, each by itself.
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/filter/chi_square.hpp"
#include "estimation/navigator/constraints.hpp"
#include "estimation/navigator/instruments.hpp"
#include "estimation/navigator/start/alignment_watch.hpp"
#include "estimation/navigator/start/ordered_position.hpp"
#include "estimation/navigator/usage.hpp"
#include "unit/estimation/navigating.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

TEST(AlignmentWatch, IsAlignedAfterTheHoldAndFallsOutAtTwiceTheLimit) {
  EngineConfig config;
  config.alignment.aligned_tilt_sigma_rad = 1.0 * kRadPerDeg;
  config.alignment.aligned_heading_sigma_rad = 2.0 * kRadPerDeg;
  config.alignment.aligned_hold_s = 5.0;
  AlignmentWatch watch;
  const auto at = [&](double t_s, double tilt_deg, double heading_deg) {
    const Vector3d sigma = kRadPerDeg * Vector3d(tilt_deg, tilt_deg, heading_deg);
    watch.judge(config, sigma, Plausible::yes, kNow_ns + from_seconds(t_s));
    return watch.phase;
  };
  EXPECT_EQ(at(0.0, 1.1, 1.0), AlignmentPhase::fine);
  EXPECT_EQ(at(1.0, 0.9, 1.9), AlignmentPhase::fine);
  EXPECT_EQ(at(5.9, 0.9, 1.9), AlignmentPhase::fine);
  EXPECT_EQ(at(6.0, 0.9, 1.9), AlignmentPhase::aligned);
  EXPECT_EQ(watch.phase_since_ns, kNow_ns + from_seconds(6.0));
  EXPECT_EQ(at(7.0, 1.9, 3.9), AlignmentPhase::aligned);
  EXPECT_EQ(at(8.0, 1.0, 4.1), AlignmentPhase::fine);
  EXPECT_EQ(watch.hold_since_ns, 0);
}

TEST(AlignmentWatch, WaitsForWhatGravitySaysToComeInAndFallsOutOfWhatCannotBeRight) {
  EngineConfig config;
  config.alignment.aligned_hold_s = 1.0;
  AlignmentWatch watch;
  const auto at = [&](double t_s, Plausible plausible) {
    watch.judge(config, Vector3d::Zero(), plausible, kNow_ns + from_seconds(t_s));
    return watch.phase;
  };
  EXPECT_NE(at(0.0, Plausible::not_heard_enough), AlignmentPhase::aligned);
  EXPECT_NE(at(4.0, Plausible::not_heard_enough), AlignmentPhase::aligned);
  EXPECT_EQ(at(5.0, Plausible::yes), AlignmentPhase::aligned);
  // As one that an older release saved.
  EXPECT_EQ(at(6.0, Plausible::not_heard_enough), AlignmentPhase::aligned);
  EXPECT_EQ(at(7.0, Plausible::no), AlignmentPhase::fine);
  EXPECT_EQ(at(7.5, Plausible::yes), AlignmentPhase::fine);
  EXPECT_EQ(at(8.5, Plausible::yes), AlignmentPhase::aligned);
}

TEST(AlignmentWatch, AsksForNoMoreThanTheAccelerometersCanShow) {
  EngineConfig config;
  config.alignment.aligned_tilt_sigma_rad = 0.1 * kRadPerDeg;
  config.imu.accel_scale_sigma = 0.003;
  config.imu.accel_misalignment_sigma_rad = 0.004;
  EXPECT_NEAR(config.aligned_tilt_sigma_rad(), 0.01, 1e-12);
  config.alignment.aligned_tilt_sigma_rad = 1.0 * kRadPerDeg;
  EXPECT_EQ(config.aligned_tilt_sigma_rad(), 1.0 * kRadPerDeg);
}

TEST(Usage, ModeFollowsWhatWasUsedLast) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0);
  Usage usage;
  EXPECT_EQ(usage.mode(config, estimate), NavMode::inertial);
  AidingPolicy log;
  log.velocity = VelocityOver::medium;
  usage.note(log, false, kNow_ns);
  EXPECT_EQ(usage.mode(config, estimate), NavMode::dead_reckoning);
  EXPECT_EQ(usage.dvl_used_ns, 0);
  AidingPolicy acoustic;
  acoustic.fix = Fix::acoustic;
  usage.note(acoustic, true, kNow_ns);
  EXPECT_EQ(usage.mode(config, estimate), NavMode::acoustic_aided);
  AidingPolicy satellite;
  satellite.fix = Fix::satellite;
  usage.note(satellite, false, kNow_ns);  // its position was refused: nobody navigates by it
  EXPECT_EQ(usage.mode(config, estimate), NavMode::acoustic_aided);
  usage.note(satellite, true, kNow_ns);
  EXPECT_EQ(usage.mode(config, estimate), NavMode::gps_aided);
  estimate.now_ns += from_seconds(config.gps_timeout_s + 1e-3);
  EXPECT_NE(usage.mode(config, estimate), NavMode::gps_aided);
}

TEST(Usage, OnlyADopplerOverGroundKnowsTheGround) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  const Estimate estimate = navigating(setup, 1.0);
  Usage usage;
  AidingPolicy doppler;
  doppler.doppler = true;
  doppler.velocity = VelocityOver::medium;
  usage.note(doppler, false, kNow_ns);
  EXPECT_EQ(usage.dvl_used_ns, kNow_ns);
  EXPECT_FALSE(usage.knows_ground(config, estimate));
  doppler.velocity = VelocityOver::ground;
  usage.note(doppler, false, kNow_ns);
  EXPECT_TRUE(usage.knows_ground(config, estimate));
}

TEST(InstrumentMemory, AReadingIsFrozenThatStandsStillWhileThePredictionMoves) {
  Instrument instrument;
  const std::array<double, 3> reading{1.0, 2.0, kUnknown};
  const auto frozen = [&](const std::array<double, 3>& now, double predicted, double travelled_m,
                          double way_m = HUGE_VAL) {
    return instrument.is_frozen(now, Vector3d(predicted, 0.0, 0.0), 1.0, Vector3d(0.0, travelled_m, 0.0),
                                way_m);
  };
  EXPECT_FALSE(frozen(reading, 0.0, 0.0));
  EXPECT_FALSE(frozen(reading, 0.9, 0.0));
  EXPECT_TRUE(frozen(reading, 1.1, 0.0));
  EXPECT_FALSE(frozen({1.0, 2.0 + 1e-12, kUnknown}, 1.1, 0.0));
  // Or while the vehicle travels, where no live instrument repeats itself; a simulator without noise may.
  EXPECT_FALSE(frozen(reading, 0.0, 0.0, 5.0));
  EXPECT_FALSE(frozen(reading, 0.0, 99.0, 5.0));
  for (int i = 0; i < 20; ++i) {
    (void)frozen({0.01 * i, 0.0, 0.0}, 0.0, 0.0);
    instrument.note_innovation(1.0);
  }
  EXPECT_FALSE(frozen(reading, 0.0, 100.0, 5.0));
  EXPECT_FALSE(frozen(reading, 0.0, 104.0, 5.0));
  EXPECT_TRUE(frozen(reading, 0.0, 106.0, 5.0));
  EXPECT_FALSE(frozen(reading, 0.0, 106.0));
  // What has nothing to say never repeats itself.
  const std::array<double, 3> silence{kUnknown, kUnknown, kUnknown};
  EXPECT_FALSE(frozen(silence, 0.0, 0.0, 5.0));
  EXPECT_FALSE(frozen(silence, 99.0, 99.0, 5.0));
}

TEST(OrderedPosition, AFarOneIsHeldUntilTheSamePlaceIsConfirmed) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 10.0);
  OrderedPosition ordered;
  Command order;
  order.kind = CommandKind::set_position;
  order.latitude_rad = 1e-2;  // 64 km
  order.longitude_rad = 0.0;
  order.sigma_m = 1.0;
  EXPECT_EQ(ordered.propose(setup, estimate, order).judgement.kind, VerdictKind::rejected);
  order.confirmed = true;
  Command elsewhere = order;
  elsewhere.latitude_rad = 2e-2;
  EXPECT_EQ(ordered.propose(setup, estimate, elsewhere).judgement.kind, VerdictKind::rejected);
  EXPECT_EQ(ordered.propose(setup, estimate, order).judgement.kind, VerdictKind::rejected);
  const OrderedPosition::Step step = ordered.propose(setup, estimate, order);
  EXPECT_EQ(step.judgement.kind, VerdictKind::used);
  EXPECT_NEAR(step.step_N_m.x(), 63'357.0, 50.0);
  EXPECT_EQ(step.axes, 2);
  EXPECT_EQ(ordered.held_ns, 0);
  // A confirmation comes within a minute.
  order.confirmed = false;
  (void)ordered.propose(setup, estimate, order);
  order.confirmed = true;
  estimate.now_ns += from_seconds(61.0);
  EXPECT_EQ(ordered.propose(setup, estimate, order).judgement.kind, VerdictKind::rejected);
}

TEST(Constraints, RestIsTakenForAVelocityOnceASecond) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  Estimate estimate = navigating(setup, 1.0, 1.0);
  estimate.state.nav.v_N_m_s = {0.5, -0.5, 0.1};
  Constraints constraints;
  ImuStep step;
  EXPECT_FALSE(constraints.apply(setup, step, estimate));
  constraints.mark_at_rest(estimate.now_ns, 1.5);
  EXPECT_TRUE(constraints.apply(setup, step, estimate));
  EXPECT_LT(estimate.state.nav.v_N_m_s.norm(), 0.05);
  EXPECT_FALSE(constraints.apply(setup, step, estimate));
  estimate.now_ns += kNsPerSecond;
  EXPECT_TRUE(constraints.apply(setup, step, estimate));
  estimate.now_ns += kNsPerSecond;
  EXPECT_FALSE(constraints.apply(setup, step, estimate));
}

TEST(AidingPolicies, EachModelSaysWhatItBrings) {
  const SensorConfig sensor;
  int fixes = 0;
  int velocities = 0;
  for (const AidingEntry& entry : aiding_registry()) {
    // A sample of the entry's kind in which nothing is known.
    EventSample sample;
    for_each_aiding_kind([&](auto kind) {
      if (kind.kSource == entry.source) sample = typename decltype(kind)::Sample{};
    });
    const AidingPolicy policy = entry.policy(sensor, sample);
    fixes += policy.position ? 1 : 0;
    velocities += policy.velocity != VelocityOver::none ? 1 : 0;
    EXPECT_TRUE(!policy.follows_motion || policy.position) << entry.name;
    for (const double value : policy.reading)
      EXPECT_TRUE(std::isnan(value) || value == 0.0) << entry.name << " repeats what nobody said";
  }
  EXPECT_EQ(fixes, 6);
  EXPECT_GE(velocities, 8);
}

AidingPolicy policy_of(std::string_view model, const EventSample& sample) {
  for (const AidingEntry& entry : aiding_registry())
    if (entry.name == model) return entry.policy({}, sample);
  ADD_FAILURE() << "no model " << model;
  return {};
}

TEST(AidingPolicies, APartOfAnAcousticFixIsNoPosition) {
  UsblSample usbl;
  usbl.frame = UsblFrame::vehicle_frd;
  usbl.range_m = 120.0;
  EXPECT_EQ(policy_of("usbl_range_bearing", usbl).fix, Fix::none);
  usbl.depression_rad = 0.2;
  EXPECT_EQ(policy_of("usbl_range_bearing", usbl).fix, Fix::none);
  usbl.bearing_rad = 1.0;
  EXPECT_EQ(policy_of("usbl_range_bearing", usbl).fix, Fix::acoustic);
  UsblSample vector;
  vector.relative_m = {kUnknown, 3.0, 5.0};
  EXPECT_EQ(policy_of("usbl_vector", vector).fix, Fix::none);
  vector.relative_m[0] = 2.0;
  EXPECT_EQ(policy_of("usbl_vector", vector).fix, Fix::acoustic);
}

TEST(AidingPolicies, ABarometerAloneIsNoVelocity) {
  AirspeedSample air;
  air.baro_altitude_m = 300.0;
  EXPECT_EQ(policy_of("baro_altitude", air).velocity, VelocityOver::none);
  EXPECT_EQ(policy_of("airspeed", air).velocity, VelocityOver::medium);
}

TEST(ChiSquare, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841458821, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.95, 2), 5.991464547, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.99, 3), 11.344866730, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.999, 6), 22.457744484, 1e-8);
}

}  // namespace
}  // namespace fathom::estimation
