#include "fusion/intake/intake.hpp"

#include <variant>

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

template <class Sample>
Arrival arrival(const Name& sensor, std::uint64_t sequence, TimeNs received_ns, std::uint8_t process = 1) {
  Sample sample;
  sample.header.vehicle = "auv";
  sample.header.sensor = sensor;
  sample.header.sequence = sequence;
  WriterGuid writer{};
  writer[0] = process;
  return {sample, writer, "bridge", received_ns};
}

TEST(Intake, LogsWhatItTakesWithItsWriterAndNothingElse) {
  Intake intake("auv", "imu", 200 * kNsPerMillisecond);
  intake.keep(true);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 1, 0)).fate, Intake::Fate::taken);
  EXPECT_EQ(intake.take(arrival<GpsSample>("gps", 1, kNsPerMillisecond)).fate, Intake::Fate::taken);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu_spare", 1, 2 * kNsPerMillisecond)).fate,
            Intake::Fate::other_imu);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 2, 3 * kNsPerMillisecond, 2)).fate,
            Intake::Fate::other_imu);
  Arrival other = arrival<GpsSample>("gps", 2, 4 * kNsPerMillisecond);
  std::get<GpsSample>(other.sample).header.vehicle = "another";
  EXPECT_EQ(intake.take(other).fate, Intake::Fate::other_vehicle);

  const auto& log = intake.log().arrivals();
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0].source(), SourceKind::imu);
  EXPECT_EQ(log[1].source(), SourceKind::gps);
  EXPECT_EQ(log[1].writer, "bridge");
  EXPECT_EQ(log[1].received_ns, kNsPerMillisecond);
  const Intake::Counts counts = intake.counts();
  EXPECT_EQ(counts.imu_samples, 1U);
  EXPECT_EQ(counts.other_vehicle, 1U);
  EXPECT_EQ(counts.imu_rivals, 1U);
  EXPECT_EQ(counts.imu_changes, 0U);
}

TEST(Intake, AnotherUnitOfAnotherKindIsNoOtherImu) {
  Intake intake("auv", "imu", 200 * kNsPerMillisecond);
  EXPECT_EQ(intake.take(arrival<GpsSample>("gps", 1, 0, 1)).fate, Intake::Fate::taken);
  EXPECT_EQ(intake.take(arrival<GpsSample>("gps_aft", 1, 0, 2)).fate, Intake::Fate::taken)
      << "only the inertial unit is one";
}

TEST(Intake, WhatIsLeftOutLeavesNoGap) {
  Intake intake("auv", "imu", 200 * kNsPerMillisecond);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 10, 0)).missed, 0U);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 500, kNsPerMillisecond, 2)).missed, 0U)
      << "another process";
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 11, 2 * kNsPerMillisecond)).missed, 0U);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 15, 3 * kNsPerMillisecond)).missed, 3U);
  EXPECT_EQ(intake.last().at({SourceKind::imu, "imu"}), 15U);
}

TEST(Intake, AfterItsPatienceItTakesTheProcessThatFollows) {
  Intake intake("auv", "imu", 200 * kNsPerMillisecond);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 1, 0)).fate, Intake::Fate::taken);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 1, 200 * kNsPerMillisecond, 2)).fate,
            Intake::Fate::other_imu);
  EXPECT_EQ(intake.take(arrival<ImuSample>("imu", 2, 201 * kNsPerMillisecond, 2)).fate, Intake::Fate::taken);
  EXPECT_EQ(intake.counts().imu_changes, 1U);
}

TEST(ArrivalLog, KeepsOrdersThatHoldWheneverTheyAreGiven) {
  ArrivalLog log;
  const auto order = [](CommandKind kind) {
    Command out;
    out.kind = kind;
    return out;
  };
  log.add(order(CommandKind::disable_source));
  EXPECT_TRUE(log.orders().empty());
  log.keep(true);
  log.add(order(CommandKind::realign));
  for (int i = 0; i < 100; ++i) log.add(order(CommandKind::disable_source));
  log.add(order(CommandKind::enable_source));
  ASSERT_EQ(log.orders().size(), 64U);
  EXPECT_EQ(log.orders().back().kind, CommandKind::enable_source);
}

TEST(ArrivalLog, KeepsTheLatestArrivals) {
  ArrivalLog log;
  log.add(arrival<ImuSample>("imu", 1, 0));
  EXPECT_TRUE(log.arrivals().empty()) << "nobody asked for them";
  log.keep(true);
  for (std::uint64_t i = 0; i < 9000; ++i) log.add(arrival<ImuSample>("imu", i, 0));
  ASSERT_EQ(log.arrivals().size(), 8192U);
  EXPECT_EQ(log.arrivals().back().header().sequence, 8999U);
  log.keep(false);
  EXPECT_TRUE(log.arrivals().empty());
}

}  // namespace
}  // namespace fathom::fusion
