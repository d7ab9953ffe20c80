#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fusion_fixture.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST_F(FusionTest, GivesOneNavigationStatePerInertialSampleAndItsProductsEachSecond) {
  start(160);
  vehicle->run(800);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 800; }));
  const auto states = ear->all_states();
  EXPECT_EQ(states.size(), 800U);
  for (std::size_t i = 0; i < states.size(); ++i) {
    ASSERT_EQ(states[i].header.stamp_ns, kStart_ns + static_cast<TimeNs>(i + 1) * kPeriod_ns);
    ASSERT_EQ(states[i].header.vehicle, Name("auv"));
  }
  const NavState last = states.back();
  EXPECT_EQ(last.mode, NavMode::gps_aided);
  EXPECT_NEAR(last.latitude_rad, kStillLatitude_rad, 3.0 / 6.4e6);
  EXPECT_NEAR(last.longitude_rad, kStillLongitude_rad, 3.0 / 5.1e6);
  EXPECT_LT(std::hypot(last.velocity_N_m_s[0], last.velocity_N_m_s[1]), 0.1);
  EXPECT_GT(ear->count(SourceKind::gps, VerdictKind::used), 20);
  EXPECT_GT(ear->count(SourceKind::dvl, VerdictKind::used), 20);
  EXPECT_EQ(ear->count(SourceKind::imu, VerdictKind::duplicate), 0);
  ASSERT_TRUE(wait_until([&] { return ear->slow_count() > 0; }));
  EXPECT_GE(ear->last_detail().count, 15U);
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(20);
    const auto status = ear->service();
    return status && status->state == ServiceState::healthy && !status->rates.empty();
  })) << (ear->service() ? ear->service()->text : "no life sign");
  EXPECT_EQ(ear->writers(SourceKind::gps), std::set<std::string>{"still_vehicle"});
}

TEST_F(FusionTest, GarbageGetsAVerdictAndMovesNothing) {
  start(161);
  vehicle->run(400);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 400; }));

  ImuSample bad = vehicle->imu();
  bad.header.sequence = 100'001;
  bad.header.stamp_ns += kPeriod_ns / 2;
  bad.angular_rate_B_rad_s[1] = kUnknown;
  vehicle->write(bad);
  EXPECT_EQ(verdict_on(SourceKind::imu, 100'001), VerdictKind::out_of_range);
  bad = vehicle->imu();
  bad.header.sequence = 100'002;
  bad.header.stamp_ns += kPeriod_ns / 2;
  bad.specific_force_B_m_s2[2] = -kInfinite;
  vehicle->write(bad);
  EXPECT_EQ(verdict_on(SourceKind::imu, 100'002), VerdictKind::out_of_range);
  bad = vehicle->imu();
  bad.header.sequence = 100'003;
  bad.angular_rate_B_rad_s[0] = 3.0;  // would turn the vehicle if it were taken
  vehicle->write(bad);
  EXPECT_EQ(verdict_on(SourceKind::imu, 100'003), VerdictKind::duplicate);
  bad.header.sequence = 100'004;
  bad.header.stamp_ns -= kNsPerSecond;
  vehicle->write(bad);
  EXPECT_NE(verdict_on(SourceKind::imu, 100'004), VerdictKind::used);

  const auto expect = [&](const GpsSample& sample, VerdictKind kind) {
    vehicle->write(sample);
    vehicle->run(10, false);
    EXPECT_EQ(to_string(verdict_on(SourceKind::gps, sample.header.sequence)), to_string(kind));
  };
  vehicle->run(10, false);  // away from the stamp of the last good fix
  GpsSample gps = vehicle->gps();
  gps.latitude_rad = kUnknown;
  gps.velocity_N_m_s = {kUnknown, kUnknown, kUnknown};
  expect(gps, VerdictKind::out_of_range);
  gps = vehicle->gps();
  gps.longitude_rad = kInfinite;
  expect(gps, VerdictKind::out_of_range);
  gps = vehicle->gps();
  gps.latitude_rad = 5.0;
  expect(gps, VerdictKind::out_of_range);
  gps = vehicle->gps();
  gps.header.stamp_ns += 3600 * kNsPerSecond;
  expect(gps, VerdictKind::from_the_future);
  gps = vehicle->gps();
  gps.header.stamp_ns -= 3600 * kNsPerSecond;
  expect(gps, VerdictKind::late);
  gps = vehicle->gps();
  gps.latitude_rad += 0.01;  // 64 km off
  expect(gps, VerdictKind::rejected);
  DvlSample twice = vehicle->dvl();
  vehicle->write(twice);
  vehicle->write(twice);
  vehicle->run(10, false);
  EXPECT_TRUE(wait_until([&] { return ear->of(SourceKind::dvl, twice.header.sequence).size() == 2; }));
  EXPECT_EQ(ear->count(SourceKind::dvl, VerdictKind::duplicate), 1);

  GpsSample other = vehicle->gps();
  other.header.vehicle = "neighbour";
  other.latitude_rad += 1e-4;
  vehicle->write(other);
  vehicle->run(100);
  EXPECT_TRUE(ear->of(SourceKind::gps, other.header.sequence).empty());

  const int sent = vehicle->ticks();
  ASSERT_TRUE(wait_until([&] { return ear->last_state().header.stamp_ns == kStart_ns + sent * kPeriod_ns; }));
  const NavState last = ear->last_state();
  EXPECT_NEAR(last.latitude_rad, kStillLatitude_rad, 3.0 / 6.4e6);
  EXPECT_NEAR(last.longitude_rad, kStillLongitude_rad, 3.0 / 5.1e6);
  EXPECT_LT(std::abs(last.rpy_rad[0]) + std::abs(last.rpy_rad[1]), 0.02);
}

TEST_F(FusionTest, ObeysCommandsAndPinsItsInertialUnit) {
  start(162);
  vehicle->run(300);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 300; }));
  const std::uint32_t resets = ear->last_state().reset_counter;

  vehicle->write(vehicle->command(CommandKind::disable_source, "gps"));
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(40);
    return ear->count(SourceKind::gps, VerdictKind::source_disabled) > 0;
  }));
  Command position = vehicle->command(CommandKind::set_position);
  position.latitude_rad = kStillLatitude_rad + 100.0 / 6.36e6;
  position.longitude_rad = kStillLongitude_rad;
  position.depth_m = 0.0;
  position.sigma_m = 1.0;
  vehicle->write(position);
  const auto counter = [&](const char* name) {
    const auto status = ear->service();
    return status ? status->counter(name) : 0;
  };
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(20);
    return counter("orders_held") == 1;
  }));
  EXPECT_EQ(ear->last_state().reset_counter, resets) << "far from where navigation is, and not confirmed";
  EXPECT_TRUE(fusion->says("order set_position of operator: held: it lies 1")) << fusion->err();
  position.header = vehicle->header("operator");
  position.confirmed = true;
  vehicle->write(position);
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(20);
    return ear->last_state().reset_counter > resets;
  }));
  EXPECT_NEAR(ear->last_state().latitude_rad, kStillLatitude_rad + 100.0 / 6.36e6, 3.0 / 6.4e6);

  Command old = vehicle->command(CommandKind::enable_source, "gps");
  old.header.stamp_ns -= 20 * kNsPerSecond;
  vehicle->write(old);
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(20);
    const auto status = ear->service();
    return counter("orders_refused") == 1 && status && status->text.find(": refused: ") != std::string::npos;
  }));
  EXPECT_TRUE(fusion->says("before the newest inertial sample")) << fusion->err();

  ImuSample second = vehicle->imu("imu_spare");
  second.header.sequence = 200'001;
  vehicle->write(second);
  EXPECT_EQ(verdict_on(SourceKind::imu, 200'001), VerdictKind::source_disabled);
}

TEST_F(FusionTest, ASecondWriterOfItsUnitIsNotMixedInAndFollowsOneThatFellSilent) {
  start(175);
  vehicle->run(300);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 300; }));
  const auto counter = [&](const char* name) {
    const auto status = ear->service();
    return status ? status->counter(name) : 0;
  };
  auto rogue = std::make_unique<bus::Participant>(presence(175, "rogue"));
  bus::Writer<ImuSample> wrong(*rogue);
  // The unit goes on meanwhile: one that fell silent would be followed.
  ASSERT_TRUE(wait_until([&] {
    vehicle->run(1);
    return wrong.matched_readers() > 0;
  }));
  // A unit that turns on its head, between the samples of the one that lies still.
  for (int i = 0; i < 100; ++i) {
    ImuSample sample = vehicle->imu();
    sample.header.stamp_ns += kPeriod_ns / 2;
    sample.header.sequence = 300'000 + static_cast<std::uint64_t>(i);
    sample.angular_rate_B_rad_s = {3.0, 0.0, 0.0};
    wrong.write(sample);
    vehicle->run(1);
  }
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(20);
    return counter("imu_rival_samples") == 100;
  })) << counter("imu_rival_samples");
  EXPECT_EQ(counter("imu_writer_changes"), 0U);
  EXPECT_EQ(verdict_on(SourceKind::imu, 300'050), VerdictKind::source_disabled);
  EXPECT_EQ(ear->writers(SourceKind::imu), std::set<std::string>{"rogue"});
  EXPECT_LT(std::abs(ear->last_state().rpy_rad[0]), 0.02);

  // The first one falls silent: as if its bridge had been started anew.
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  ImuSample next = vehicle->imu();
  next.header.stamp_ns += 45 * kPeriod_ns;
  wrong.write(next);
  EXPECT_TRUE(wait_until([&] { return counter("imu_writer_changes") == 1; }));
  EXPECT_TRUE(wait_until([&] { return ear->last_state().header.stamp_ns == next.header.stamp_ns; }));
}

TEST_F(FusionTest, SaysThatInertialSamplesAreMissing) {
  start(163);
  vehicle->run(100);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 100; }));
  ASSERT_TRUE(wait_until([&] {
    const auto status = ear->service();
    return status && status->state == ServiceState::degraded;
  }));
  EXPECT_NE(ear->service()->text.find("no usable inertial sample from imu"), std::string::npos)
      << ear->service()->text;
  EXPECT_TRUE(wait_until([&] {
    vehicle->run(20);
    const auto status = ear->service();
    return status && status->state == ServiceState::healthy;
  }));
}

TEST_F(FusionTest, SaysAgainWhatALateFixChangesAndOnceWhatIsFinal) {
  start(174, {"engine.horizon_s=2"});
  vehicle->run(100, false);
  Command somewhere = vehicle->command(CommandKind::set_position);
  somewhere.latitude_rad = kStillLatitude_rad;
  somewhere.longitude_rad = kStillLongitude_rad;
  somewhere.sigma_m = 200.0;
  vehicle->write(somewhere);
  ASSERT_TRUE(wait_until([&] {
    vehicle->run(10, false);
    return ear->state_count() > 0 && ear->last_state().position_covariance_N_m2[0] > 1e4;
  }));
  vehicle->run(20, false);
  GpsSample good = vehicle->gps();
  good.position_sigma_N_m = {2.0, 2.0, 4.0};
  vehicle->run(20, false);
  GpsSample wrong = vehicle->gps();
  wrong.position_sigma_N_m = {2.0, 2.0, 4.0};
  wrong.latitude_rad += 250.0 / 6.36e6;
  vehicle->write(wrong);
  vehicle->run(10, false);
  EXPECT_EQ(to_string(verdict_on(SourceKind::gps, wrong.header.sequence)), "used");

  vehicle->write(good);
  vehicle->run(10, false);
  EXPECT_EQ(to_string(verdict_on(SourceKind::gps, good.header.sequence)), "used");
  ASSERT_TRUE(wait_until([&] { return ear->of(SourceKind::gps, wrong.header.sequence).size() == 2; }));
  const Verdict revised = ear->of(SourceKind::gps, wrong.header.sequence).back();
  EXPECT_EQ(to_string(revised.kind), "rejected");
  EXPECT_EQ(to_string(revised.previous), "used");
  EXPECT_EQ(revised.revision, 1U);
  EXPECT_FALSE(revised.is_final);
  ASSERT_TRUE(wait_until([&] { return ear->last_state().header.stamp_ns == vehicle->now_ns(); }));
  EXPECT_NEAR((ear->last_state().latitude_rad - kStillLatitude_rad) * 6.36e6, 0.0, 3.0);

  vehicle->run(220, false);
  ASSERT_TRUE(wait_until([&] { return ear->of(SourceKind::gps, wrong.header.sequence).size() == 3; }));
  const Verdict last = ear->of(SourceKind::gps, wrong.header.sequence).back();
  EXPECT_EQ(to_string(last.kind), "rejected");
  EXPECT_EQ(last.revision, 2U);
  EXPECT_TRUE(last.is_final);
  EXPECT_EQ(last.writer, Name("still_vehicle"));
  EXPECT_EQ(ear->of(SourceKind::gps, good.header.sequence).size(), 2U);
  EXPECT_EQ(ear->finals(SourceKind::gps, good.header.stamp_ns), 1);
}

TEST_F(FusionTest, AnOrderlyEndIsFinal) {
  start(175);
  vehicle->run(200);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 200; }));
  EXPECT_EQ(ear->finals(SourceKind::gps, kStart_ns + 100 * kPeriod_ns), 0) << "the horizon is five seconds";
  fusion->kill(SIGTERM);
  EXPECT_EQ(fusion->wait(), 0) << fusion->err();
  for (int tick = 40; tick < 200; tick += 20) {  // the last of all may still be under way
    const TimeNs stamp_ns = kStart_ns + tick * kPeriod_ns;
    EXPECT_TRUE(wait_until([&] {
      return ear->finals(SourceKind::gps, stamp_ns) == 1 && ear->finals(SourceKind::dvl, stamp_ns) == 1;
    })) << tick;
  }
  launch();
}

TEST(FusionExecutable, RefusesABadConfigurationBeforeAnythingStarts) {
  Process fusion("fathom-fusion", {"--config", source_dir() + "/deploy/config/fusion.json", "--set",
                                   "engine.horizon_s=often"});
  EXPECT_EQ(fusion.wait(), 2);
  EXPECT_NE(fusion.err().find("fusion.json: engine.horizon_s: is \"often\", expected a number"),
            std::string::npos)
      << fusion.err();
}

}  // namespace
}  // namespace fathom::test
