// The alignment under way when its measurements are bad, missing or interrupted.
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/alignment/stability_gate.hpp"
#include "geo/so3.hpp"
#include "support/orders.hpp"
#include "support/vehicles/drop_run.hpp"

namespace fathom::estimation {
namespace {

using test::Fall;
using test::feed;
using test::kEpoch;
using test::release;

double time_of(const SampleHeader& header) {
  return to_seconds(header.stamp_ns - kEpoch);
}

struct Drop {
  explicit Drop(const EngineConfig& config = test::drop_config()) : engine(config) {
    engine.start_from(release());
  }
  AlignmentStatus status() const {
    AlignmentStatus out;
    engine.fill(out);
    return out;
  }
  [[nodiscard]] std::string advice() const { return status().advice.data(); }
  [[nodiscard]] AlignmentPhase phase() const { return engine.nav_state().alignment; }
  FusionEngine engine;
};

bool held(const AlignmentStatus& status, double longer_than_s) {
  for (std::size_t i = 0; i < kStabilityConditions; ++i)
    if (status.conditions[i].held_s > longer_than_s) return true;
  return false;
}

void expect_true_within(const NavState& nav, const Truth& truth, double sigmas) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(std::abs(geo::wrap_pi(nav.rpy_rad[i] - truth.rpy_rad[i])), sigmas * nav.rpy_sigma_rad[i]) << i;
  const Eigen::Vector3d off = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                                {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  EXPECT_LT(std::abs(off.x()), sigmas * std::sqrt(nav.position_covariance_N_m2[0]));
  EXPECT_LT(std::abs(off.y()), sigmas * std::sqrt(nav.position_covariance_N_m2[4]));
}

struct Fault {
  const char* name;
  const char* told;
  /// Feeds what comes instead of a good sample; how many good ones are left out from here on.
  int (*apply)(FusionEngine& engine, ImuSample good, const ImuSample& before);
};

class DropFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(DropFaults, SetTimersAndWindowBackAndSayWhy) {
  const Fall fall(26.0);
  Drop drop;
  ImuSample before;
  bool injected = false;
  int left_out = 0;
  double fault_s = 0.0;
  double coarse_s = 0.0;
  for (const auto& sample : fall.samples) {
    const auto* imu = std::get_if<ImuSample>(&sample);
    if (imu == nullptr) {
      feed(drop.engine, sample);
      continue;
    }
    if (left_out > 0) {
      --left_out;
      continue;
    }
    if (!injected && drop.phase() == AlignmentPhase::averaging && drop.status().in_phase_s > 0.5) {
      injected = true;
      fault_s = time_of(imu->header);
      left_out = GetParam().apply(drop.engine, *imu, before);
      if (left_out > 0) {
        --left_out;
        continue;
      }
    }
    const bool first = injected && coarse_s == 0.0 && time_of(before.header) < fault_s;
    drop.engine.add(*imu);
    before = *imu;
    if (first) {
      // The first good sample after it may count, no older one.
      const AlignmentStatus status = drop.status();
      EXPECT_EQ(status.phase, AlignmentPhase::waiting);
      EXPECT_FALSE(held(status, 0.011));
      EXPECT_NE(std::string(status.advice.data()).find(GetParam().told), std::string::npos)
          << status.advice.data();
    }
    if (coarse_s == 0.0 && drop.phase() == AlignmentPhase::coarse) coarse_s = time_of(imu->header);
  }
  ASSERT_TRUE(injected);
  // Three seconds of roll, one of averaging.
  EXPECT_GE(coarse_s, fault_s + 3.98);
  EXPECT_LT(coarse_s, fault_s + 4.2);
}

INSTANTIATE_TEST_SUITE_P(
    All, DropFaults,
    ::testing::Values(Fault{"not_a_number", "no number",
                            [](FusionEngine& engine, ImuSample good, const ImuSample&) {
                              good.delta_angle_B_rad[1] = std::numeric_limits<double>::quiet_NaN();
                              good.angular_rate_B_rad_s[1] = std::numeric_limits<double>::quiet_NaN();
                              EXPECT_FALSE(engine.add(good));
                              return 1;
                            }},
                      Fault{"gap", "missing", [](FusionEngine&, ImuSample, const ImuSample&) { return 2; }},
                      Fault{"stale", "stale",
                            [](FusionEngine& engine, ImuSample, const ImuSample& before) {
                              ImuSample old = before;
                              old.header.stamp_ns -= 20'000'000;
                              EXPECT_FALSE(engine.add(old));
                              return 0;
                            }},
                      Fault{"same_instant", "stale",
                            [](FusionEngine& engine, ImuSample, const ImuSample& before) {
                              EXPECT_FALSE(engine.add(before));
                              return 0;
                            }}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(DropFaults, MissingDepthAndShaftSpeedAreNamedAndWaitedFor) {
  const Fall fall(30.0);
  for (const bool depth : {true, false}) {
    Drop drop;
    double averaging_s = 0.0;
    double back_s = 0.0;
    bool told = false;
    for (const auto& sample : fall.samples) {
      const double t = to_seconds(drop.engine.nav_state().header.stamp_ns - kEpoch);
      if (averaging_s == 0.0 && drop.phase() == AlignmentPhase::averaging) averaging_s = t;
      const bool silent = averaging_s > 0.0 && t < averaging_s + 1.0;
      const bool concerned = depth ? std::holds_alternative<DepthSample>(sample)
                                   : std::holds_alternative<PropulsionSample>(sample);
      if (silent && concerned) continue;
      if (concerned && averaging_s > 0.0 && back_s == 0.0) back_s = t;
      feed(drop.engine, sample);
      if (silent && t > averaging_s + 0.6) {
        told = drop.advice().find(depth ? "depth was missing" : "propulsor speed was missing") !=
               std::string::npos;
        EXPECT_TRUE(told) << drop.advice();
        EXPECT_EQ(drop.phase(), AlignmentPhase::waiting);
        EXPECT_FALSE(known(drop.status().time_to_aligned_s));
      }
      if (back_s > 0.0 && t > back_s + 0.02 && t < back_s + 3.9) {
        EXPECT_NE(drop.phase(), AlignmentPhase::coarse) << t;
        EXPECT_NE(drop.phase(), AlignmentPhase::aligned) << t;
      }
    }
    EXPECT_TRUE(told);
    EXPECT_EQ(drop.phase(), AlignmentPhase::aligned);
  }
}

/// Without inertial samples for a while; what happens until the end of the fall.
struct Silence {
  bool lost = false;
  bool blind = false;  ///< at some time after it there was no position
  double aligned_again_s = 0.0;
};

Silence be_silent(Drop& drop, const Fall& fall, double from_s, double to_s) {
  Silence out;
  for (const auto& sample : fall.samples) {
    const auto* imu = std::get_if<ImuSample>(&sample);
    const double t = time_of(header_of(sample));
    if (imu != nullptr && t > from_s && t < to_s) continue;
    feed(drop.engine, sample);
    if (t < to_s || imu == nullptr) continue;
    out.lost = out.lost || drop.phase() == AlignmentPhase::lost;
    out.blind = out.blind || !known(drop.engine.nav_state().latitude_rad);
    if (out.lost && out.aligned_again_s == 0.0 && drop.phase() == AlignmentPhase::aligned)
      out.aligned_again_s = t;
  }
  return out;
}

TEST(DropFaults, AGapWidensWhatIsKnownAndTheRunEndsAligned) {
  const Fall fall(45.0);
  for (const double from_s : {16.0, 20.6, 22.0, 100.0}) {  // the last: none
    Drop drop;
    const Silence silence = be_silent(drop, fall, from_s, from_s + 2.0);
    EXPECT_FALSE(silence.lost);
    EXPECT_EQ(drop.phase(), AlignmentPhase::aligned) << from_s;
    expect_true_within(drop.engine.nav_state(), fall.truth.back(), 3.0);
  }
}

TEST(DropFaults, AttitudeLostUnderWayIsFoundAgain) {
  // Before and after it had been aligned for the first time.
  const Fall fall(62.0);
  for (const double from_s : {18.0, 33.0}) {
    Drop drop;
    const Silence silence = be_silent(drop, fall, from_s, from_s + 11.0);
    EXPECT_TRUE(silence.lost) << from_s;
    EXPECT_FALSE(silence.blind) << from_s;
    EXPECT_GT(silence.aligned_again_s, from_s + 15.0);
    EXPECT_LT(silence.aligned_again_s, from_s + 27.0);
    const NavState& nav = drop.engine.nav_state();
    // Nothing measures the heading, and it says so.
    EXPECT_GT(nav.rpy_sigma_rad[2], 30.0 * kRadPerDeg);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_LT(std::abs(nav.rpy_rad[i] - fall.truth.back().rpy_rad[i]), 0.4 * kRadPerDeg) << i;
    expect_true_within(nav, fall.truth.back(), 3.0);
  }
}

TEST(DropFaults, AnOrderToAlignAgainInTheFallForgetsNothingOfWhatTheTiltDidToTheMotion) {
  // Roll and pitch were not known at the release: what was integrated with them until the order stays wrong,
  // by up to 200 m and 15 m/s when the filter takes over.
  const Fall fall(30.0);
  for (const double order_s : {4.0, 8.0, 12.0, 16.0, 20.0}) {
    Drop drop;
    bool ordered = false;
    std::size_t row = 0;
    for (const auto& sample : fall.samples) {
      feed(drop.engine, sample);
      if (std::holds_alternative<ImuSample>(sample)) ++row;
      if (drop.phase() == AlignmentPhase::aligned) break;
      if (ordered || time_of(header_of(sample)) < order_s) continue;
      Command realign;
      realign.kind = CommandKind::realign;
      ordered = test::order_now(drop.engine, realign).empty();
    }
    ASSERT_TRUE(ordered);
    ASSERT_EQ(drop.phase(), AlignmentPhase::aligned) << order_s;
    const NavState& nav = drop.engine.nav_state();
    const Truth& truth = fall.truth[row - 1];
    Eigen::Matrix<double, 6, 1> off;
    off << geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                             {nav.latitude_rad, nav.longitude_rad, nav.altitude_m}),
        geo::vec(truth.velocity_N_m_s) - geo::vec(nav.velocity_N_m_s);
    const auto p = drop.engine.navigation_covariance();
    for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(off(i)), 3.0 * std::sqrt(p(i, i))) << order_s << " " << i;
  }
}

TEST(DropFaults, AHeadingLostTooNeedsMotionWithGps) {
  const Fall fall(62.0);
  EngineConfig config = test::drop_config();
  config.sensors.push_back(default_sensor(SourceKind::gps, "gps"));
  Drop drop(config);
  const Silence silence = be_silent(drop, fall, 27.0, 52.0);
  EXPECT_TRUE(silence.lost);
  EXPECT_TRUE(silence.blind);
  EXPECT_EQ(drop.engine.nav_state().mode, NavMode::none);
  EXPECT_EQ(drop.phase(), AlignmentPhase::lost);
  EXPECT_NE(drop.advice().find("heading was lost"), std::string::npos) << drop.advice();
  // Smooth as it runs, it is not taken for a vehicle at rest; nor does an order make up for a heading.
  Command realign;
  realign.kind = CommandKind::realign;
  EXPECT_EQ(test::order_now(drop.engine, realign), "");
  Command place;
  place.kind = CommandKind::set_position;
  place.latitude_rad = fall.truth.back().latitude_rad;
  place.longitude_rad = fall.truth.back().longitude_rad;
  place.sigma_m = 10.0;
  EXPECT_EQ(test::order_now(drop.engine, place, 2), "");
  // The same motion again, as the stamps go on, first without and then with fixes.
  const TimeNs shift = from_seconds(12.0);
  for (const auto& sample : fall.samples) {
    const auto* imu = std::get_if<ImuSample>(&sample);
    if (imu == nullptr || time_of(imu->header) < 50.01) continue;
    ImuSample again = *imu;
    again.header.stamp_ns += shift;
    again.header.received_ns += shift;
    drop.engine.add(again);
    const double t = time_of(imu->header);
    if (t < 56.0) {
      EXPECT_EQ(drop.engine.nav_state().mode, NavMode::none);
    }
    const auto k = static_cast<std::size_t>(std::lround(t * 100.0));
    if (t < 56.0 || k % 25 != 0 || k > fall.truth.size()) continue;
    const Truth& truth = fall.truth[k - 1];
    GpsSample gps;
    gps.header = again.header;
    gps.header.sensor = "gps";
    gps.header.sequence = k;
    gps.fix = GpsFix::fix_3d;
    gps.latitude_rad = truth.latitude_rad;
    gps.longitude_rad = truth.longitude_rad;
    gps.altitude_m = truth.altitude_m;
    gps.velocity_N_m_s = truth.velocity_N_m_s;
    drop.engine.add(gps);
  }
  EXPECT_EQ(drop.engine.nav_state().mode, NavMode::gps_aided);
  EXPECT_LT(std::abs(geo::wrap_pi(drop.engine.nav_state().rpy_rad[2] - fall.truth.back().rpy_rad[2])),
            3.0 * drop.engine.nav_state().rpy_sigma_rad[2]);
}

}  // namespace
}  // namespace fathom::estimation
