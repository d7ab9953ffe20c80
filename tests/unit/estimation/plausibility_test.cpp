// What cannot be right is named and does not stay aligned; what is right is left alone.
#include "estimation/navigator/plausibility/plausibility.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "estimation/navigator/plausibility/axes_fit.hpp"
#include "estimation/navigator/plausibility/pair_fit.hpp"
#include "samples/alignment/help.hpp"
#include "sim/random.hpp"
#include "sim/simulation.hpp"
#include "support/vehicles/simulated_drive.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Proof kProof{.fewest = kFewestPairs, .most_left = 0.25, .claim = 0.0};

/// An AUV at 2 m/s that turns at the surface and dives.
sim::Scenario scenario(bool dives) {
  sim::Scenario out = test::auv_at(36.4 * kRadPerDeg, 127.4 * kRadPerDeg);
  out.environment.surface_altitude_m = 18.5;
  out.environment.water_depth_m = 45.0;
  double t = 0.0;
  int i = 0;
  for (const double heading : {35.0, 95.0, 30.0, 330.0, 60.0, 350.0, 80.0, 20.0}) {
    sim::MissionStep one;
    one.at_s = t;
    one.speed_m_s = 2.0;
    one.heading_rad = heading * kRadPerDeg;
    one.depth_m = dives && i % 2 == 1 ? 8.0 : 0.0;
    out.mission.push_back(one);
    t += 10.0;
    ++i;
  }
  auto& imu = test::enable<ImuSample>(out, 100.0);
  imu.gyro.bias_sigma = 1.0 * kRadPerDeg / 3600.0;
  imu.gyro.random_walk = 0.012 * kRadPerDeg / 60.0;
  imu.accelerometer.bias_sigma = 0.01;
  imu.accelerometer.random_walk = 0.07 / 60.0;
  test::enable<GpsSample>(out, 2.0).lever_B_m = {0.0, 0.0, -0.4};
  test::enable<DvlSample>(out, 5.0);
  test::enable<DepthSample>(out, 10.0);
  test::enable<HeadingSample>(out, 10.0).sigma_rad = 0.3 * kRadPerDeg;
  return out;
}

EngineConfig config() {
  EngineConfig out;
  out.imu.nominal_rate_hz = 100.0;
  const auto add = [&](SourceKind kind, const Name& name) {
    out.sensors.push_back(default_sensor(kind, std::string(name.view())));
  };
  add(SourceKind::gps, "gps");
  out.sensors.back().lever_B_m = {0.0, 0.0, -0.4};
  add(SourceKind::dvl, "dvl");
  add(SourceKind::depth, "depth");
  add(SourceKind::heading, "heading");
  return out;
}

struct Outcome {
  std::string first_named;
  std::string named;  ///< the last of what was found implausible
  std::string advice;
  double named_at_s = kUnknown;
  AlignmentPhase phase = AlignmentPhase::none;
  double aligned_at_s = kUnknown;
  std::vector<double> heading_nees;  ///< of aligned states
};

using test::change_of;

Outcome run(const sim::Scenario& scenario, std::uint64_t seed, const test::SampleChange& change) {
  FusionEngine engine(config());
  Outcome out;
  AlignmentStatus status;
  test::drive(engine, scenario, seed, change, [&](int i, const auto& truth) {
    if (i % 20 != 0) return;
    const double t = 0.01 * i;
    engine.fill(status);
    out.phase = status.phase;
    if (const AlignmentCondition* found = implausible(status)) {
      if (out.named.empty()) {
        out.named_at_s = t;
        out.first_named = std::string(found->name.view());
      }
      out.named = std::string(found->name.view());
      out.advice = status.advice.data();
      EXPECT_NE(status.phase, AlignmentPhase::aligned) << out.named;
    }
    const NavState& nav = engine.nav_state();
    if (status.phase != AlignmentPhase::aligned) return;
    if (!known(out.aligned_at_s)) out.aligned_at_s = t;
    const double error = std::remainder(nav.rpy_rad[2] - truth.rpy_rad[2], 2.0 * M_PI);
    out.heading_nees.push_back(std::pow(error / nav.rpy_sigma_rad[2], 2));
  });
  return out;
}

template <class Array>
void scale(Array& values, double factor) {
  for (double& one : values) one *= factor;
}

struct Mistake {
  const char* name;
  const char* words;  ///< of the sentence
  bool dives;
  test::SampleChange change;
};

std::vector<Mistake> mistakes() {
  return {
      {"implausible_force_downwards", "negate accelerometer", false,
       change_of<ImuSample>([](auto& s) { scale(s.specific_force_B_m_s2, -1.0); })},
      {"implausible_force_in_g", "9.80665", false,
       change_of<ImuSample>([](auto& s) { scale(s.specific_force_B_m_s2, 1.0 / 9.80665); })},
      {"implausible_force_along_x", "x and z", false, change_of<ImuSample>([](auto& s) {
         std::swap(s.specific_force_B_m_s2[0], s.specific_force_B_m_s2[2]);
       })},
      {"implausible_gyro_negated", "negate", false,
       change_of<ImuSample>([](auto& s) { scale(s.angular_rate_B_rad_s, -1.0); })},
      {"implausible_gyro_axes", "gyro x and y", true, change_of<ImuSample>([](auto& s) {
         std::swap(s.angular_rate_B_rad_s[0], s.angular_rate_B_rad_s[1]);
       })},
      {"implausible_gyro_in_degrees", "0.017453", false,
       change_of<ImuSample>([](auto& s) { scale(s.angular_rate_B_rad_s, 1.0 / kRadPerDeg); })},
      {"implausible_dvl_turned", "+45 deg", false, change_of<DvlSample>([](auto& s) {
         auto& v = s.velocity_D_m_s;
         v = {std::sqrt(0.5) * (v[0] + v[1]), std::sqrt(0.5) * (v[1] - v[0]), v[2]};
       })},
      {"implausible_dvl_unit", "0.001", false,
       change_of<DvlSample>([](auto& s) { scale(s.velocity_D_m_s, 1000.0); })},
      {"implausible_depth_unit", "10.0", true, change_of<DepthSample>([](auto& s) { s.depth_m *= 0.0993; })},
      {"implausible_gps_axes", "east, north, up", false, change_of<GpsSample>([](auto& s) {
         std::swap(s.velocity_N_m_s[0], s.velocity_N_m_s[1]);
         s.velocity_N_m_s[2] *= -1.0;
       })},
      {"implausible_heading_unit", "57.29", false,
       change_of<HeadingSample>([](auto& s) { s.heading_rad *= kRadPerDeg; })},
      {"implausible_heading_negated", "clockwise", false,
       change_of<HeadingSample>([](auto& s) { s.heading_rad = 2.0 * M_PI - s.heading_rad; })},
      {"implausible_gps_place_unit", "57.29", false, change_of<GpsSample>([](auto& s) {
         s.latitude_rad *= kRadPerDeg;
         s.longitude_rad *= kRadPerDeg;
       })},
      {"implausible_imu_rate", "110.0 Hz", false, change_of<ImuSample>([](auto& s) {
         const TimeNs first = test::kDriveEpoch_ns;
         s.header.stamp_ns = first + (s.header.stamp_ns - first) * 10 / 11;
       })},
  };
}

TEST(Plausibility, NamesTheGrossMistakesWithinAMinuteAndTakesTheAlignmentBack) {
  for (const Mistake& mistake : mistakes()) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Outcome found = run(scenario(mistake.dives), seed, mistake.change);
      // Figures 57 times too large turn gravity by chance as an exchange of axes would.
      if (std::string_view(mistake.name) != "implausible_gyro_in_degrees") {
        EXPECT_EQ(found.first_named, mistake.name) << "seed " << seed;
      }
      EXPECT_EQ(found.named, mistake.name) << "seed " << seed;
      EXPECT_NE(found.advice.find(mistake.words), std::string::npos) << mistake.name << ": " << found.advice;
      EXPECT_NE(found.phase, AlignmentPhase::aligned) << mistake.name;
      EXPECT_LT(found.named_at_s, 60.0) << mistake.name;
    }
  }
}

TEST(Plausibility, LeavesASoundVehicleAlone) {
  for (const bool dives : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Outcome found = run(scenario(dives), seed, [](auto&) {});
      EXPECT_EQ(found.named, "") << found.advice;
      EXPECT_EQ(found.phase, AlignmentPhase::aligned);
    }
  }
}

TEST(MovingStart, AnAuvWithoutCompassAlignsByGpsAndDvlAndIsHonestAboutItsHeading) {
  sim::Scenario without = scenario(false);
  without.sensors.of<HeadingSample>().enabled = false;
  double sum = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Outcome found = run(without, seed, [](auto&) {});
    ASSERT_LT(found.aligned_at_s, 30.0) << "seed " << seed;
    double mean = 0.0;
    for (const double one : found.heading_nees) mean += one / static_cast<double>(found.heading_nees.size());
    sum += mean;
    count += 1.0;
  }
  // Runs are independent and the errors within one are not: the mean of twenty chi squares.
  EXPECT_LT(sum / count, 1.0 + 3.0 * std::sqrt(2.0 / count));
  EXPECT_GT(sum / count, 0.1);
}

/// The sentence of an inertial unit alone, of which `kept` says which samples arrive, at this rate.
std::string heard(double rate_hz, const std::function<bool(int)>& kept) {
  FusionEngine engine(config());
  ImuSample imu;
  imu.specific_force_B_m_s2 = {0.0, 0.0, -9.8};
  imu.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
  for (int i = 0; i < static_cast<int>(20.0 * rate_hz); ++i) {
    imu.header.stamp_ns = 1'700'000'000 * kNsPerSecond + from_seconds(i / rate_hz);
    if (kept(i)) engine.add(imu);
  }
  AlignmentStatus status;
  engine.fill(status);
  return implausible(status) == nullptr ? "" : status.advice.data();
}

TEST(Plausibility, ARateThatAClockMayGiveIsNamedAndLostSamplesOrAnotherSettingAreNot) {
  EXPECT_EQ(heard(100.0, [](int) { return true; }), "");
  EXPECT_EQ(heard(100.0, [](int i) { return i % 5 != 0; }), "");
  EXPECT_EQ(heard(100.0, [](int i) { return i % 2 == 0; }), "");
  EXPECT_NE(heard(107.0, [](int) { return true; }).find("107.0 Hz"), std::string::npos);
  EXPECT_NE(heard(90.0, [](int) { return true; }).find("90.0 Hz"), std::string::npos);
  EXPECT_EQ(heard(120.0, [](int) { return true; }), "");
  EXPECT_EQ(heard(50.0, [](int) { return true; }), "");
  EXPECT_EQ(heard(1000.0, [](int) { return true; }), "");
}

/// The sentence after `seconds` with gravity felt along each of these, one after the other.
std::string felt(const std::vector<std::array<double, 3>>& forces_B_m_s2, double seconds) {
  FusionEngine engine(config());
  ImuSample imu;
  imu.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < forces_B_m_s2.size(); ++k) {
    for (int i = 0; i < static_cast<int>(100.0 * seconds); ++i) {
      imu.specific_force_B_m_s2 = forces_B_m_s2[k];
      imu.header.stamp_ns = 1'700'000'000 * kNsPerSecond +
                            from_seconds(static_cast<double>(k) * seconds + 0.01 * static_cast<double>(i));
      engine.add(imu);
    }
  }
  AlignmentStatus status;
  engine.fill(status);
  return implausible(status) == nullptr ? "" : status.advice.data();
}

TEST(Plausibility, WhoHasBeenUprightMayFlyInvertedAndStandOnHisNose) {
  EXPECT_NE(felt({{0.0, 0.0, 9.8}}, 10.0), "");
  EXPECT_NE(felt({{9.8, 0.0, 0.0}}, 10.0), "");
  EXPECT_EQ(felt({{0.0, 0.0, -9.8}, {0.0, 0.0, 9.8}}, 10.0), "");
  EXPECT_EQ(felt({{0.0, 0.0, -9.8}, {9.8, 0.0, 0.0}, {0.0, -9.8, 0.0}}, 10.0), "");
  EXPECT_EQ(felt({{0.0, 0.0, 9.8}, {0.0, 0.0, -9.8}}, 10.0), "") << "put right";
}

TEST(PairFit, BelievesAnotherFactorOnlyWhereItExplainsWhatTheConfiguredOneDoesNot) {
  sim::Random random(7, "pairs");
  PairFit right;
  PairFit wrong;
  PairFit silent;
  for (int i = 0; i < 30; ++i) {
    const double a = 0.5 + 0.1 * (i % 7);
    right.add(a, a + random.normal(0.02), 0.02, 0.1);
    wrong.add(a, -a + random.normal(0.02), 0.02, 0.1);
    silent.add(random.normal(0.02), random.normal(0.02), 0.02, 0.1);
  }
  EXPECT_EQ(right.evidence(-1.0, kProof), 0.0);
  EXPECT_GT(wrong.evidence(-1.0, kProof), 20.0);
  EXPECT_EQ(wrong.evidence(0.5, kProof), 0.0);
  EXPECT_EQ(silent.evidence(-1.0, kProof), 0.0);
}

TEST(PairFit, AsksForMoreBeforeItClaimsThanBeforeItDoubts) {
  constexpr Proof kDoubt{.fewest = 1.0, .most_left = 0.25, .claim = 0.0};
  PairFit fit;
  fit.add(0.5, -0.5, 0.02, 0.1);
  EXPECT_EQ(fit.evidence(-1.0, kProof), 0.0);
  EXPECT_GT(fit.evidence(-1.0, kDoubt), 0.0);
  EXPECT_EQ(fit.evidence(2.0, kDoubt), 0.0);
}

TEST(PairFit, FiguresThatHaveNothingToDoWithOneAnotherAreNoUnit) {
  sim::Random random(11, "unrelated");
  PairFit degrees;
  PairFit hangs;   // as a compass may, or a course where a vehicle turns on the spot
  PairFit strays;  // as a course where it goes wherever it likes
  for (int i = 0; i < 60; ++i) {
    const double turn = random.normal(1.0);
    degrees.add(turn / kRadPerDeg, turn + random.normal(0.05), 0.05, 0.4);
    hangs.add(turn, random.normal(0.05), 0.05, 0.4);
    strays.add(turn, random.normal(1.0), 0.05, 0.4);
  }
  EXPECT_TRUE(degrees.is_related(kRadPerDeg));
  EXPECT_TRUE(degrees.moves());
  EXPECT_FALSE(hangs.is_related(kRadPerDeg));
  EXPECT_FALSE(hangs.moves());
  EXPECT_GT(hangs.evidence(kRadPerDeg, kProof), 20.0) << "and yet it explains the misfit";
  EXPECT_FALSE(strays.is_related(kRadPerDeg));
  EXPECT_TRUE(strays.moves());
}

TEST(PairFit, KeepsWhatWasClaimedUntilTheConfigurationExplainsAsMuch) {
  constexpr Proof kStands{.fewest = 4.0, .most_left = 1.0, .claim = 0.0};
  PairFit fit;
  for (int i = 0; i < 40; ++i) fit.add(0.5, -0.5, 0.02, 0.1);
  ASSERT_GT(fit.evidence(-1.0, kProof), 0.0);
  // Turned about and put right: for as many pairs that is no more likely than that it is negated.
  int claimed = 0;
  int standing = 0;
  for (int i = 0; i < 100; ++i) {
    fit.add(0.5, 0.5, 0.02, 0.1);
    claimed += fit.evidence(-1.0, kProof) > 0.0 ? 1 : 0;
    standing += fit.evidence(-1.0, kStands) > 0.0 ? 1 : 0;
  }
  EXPECT_GT(claimed, 0);
  EXPECT_GT(standing, claimed + 5);
  EXPECT_LT(standing, 45) << "of 40 that were wrong, fading";
}

TEST(PairFit, FindsTheTurnOfAVelocity) {
  PairFit fit;
  for (int i = 0; i < 20; ++i) {
    const double course = 0.3 * i;
    fit.add(Vector2d(2.0 * std::cos(course), 2.0 * std::sin(course)),
            Vector2d(2.0 * std::cos(course + 0.8), 2.0 * std::sin(course + 0.8)), 0.1, 0.1);
  }
  EXPECT_NEAR(fit.turn_rad(), 0.8, 1e-9);
  Matrix2d turn;
  turn << std::cos(0.8), -std::sin(0.8), std::sin(0.8), std::cos(0.8);
  EXPECT_GT(fit.evidence(turn, kProof), 20.0);
}

TEST(Alignment, EveryConditionThatAVehicleWaitsForSaysWhatHelps) {
  FusionEngine engine(config());
  ImuSample imu;
  imu.header.stamp_ns = 1'700'000'000 * kNsPerSecond;
  imu.specific_force_B_m_s2 = {0.0, 0.0, -9.8};
  imu.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
  engine.add(imu);
  imu.header.stamp_ns += 10'000'000;
  engine.add(imu);
  AlignmentStatus status;
  engine.fill(status);
  ASSERT_GT(status.condition_count, 0U);
  for (std::uint32_t i = 0; i < status.condition_count; ++i)
    EXPECT_FALSE(help_of(status.conditions[i]).empty()) << status.conditions[i].name.view();
}

TEST(Plausibility, BlamesAnInstrumentForEachMistake) {
  constexpr std::array kKinds{"unit", "sign", "axes", "rate", "mounting"};
  for (std::size_t i = 1; i < kImplausibles; ++i) {
    const std::string name(to_string(static_cast<Implausible>(i)));
    AlignmentCondition condition;
    condition.name = std::string_view(std::string(kImplausiblePrefix) + name);
    const Blame blame = blame_of(condition);
    EXPECT_NE(std::find(kKinds.begin(), kKinds.end(), blame.kind), kKinds.end()) << name;
    const std::string source(to_string(blame.source));
    EXPECT_EQ(name.starts_with(source), source != "imu" || name == "imu_rate") << name << " of " << source;
  }
  EXPECT_EQ(blame_of(AlignmentCondition{}).kind, "");
}

}  // namespace
}  // namespace fathom::estimation
