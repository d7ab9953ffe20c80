#include "fusion/intake/imu_source.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

constexpr DurationNs kMs = kNsPerMillisecond;

WriterGuid writer(std::uint8_t process, std::uint8_t entity = 1) {
  WriterGuid out{};
  out[0] = process;
  out[15] = entity;
  return out;
}

TEST(ImuSourceTest, ListensToOneUnitAndToOneProcess) {
  using enum ImuSource::Answer;
  ImuSource source("imu", 200 * kMs);
  EXPECT_EQ(source.take("imu_spare", writer(1), 0), other_unit) << "whichever comes first";
  for (int i = 1; i <= 50; ++i) {
    EXPECT_EQ(source.take("imu", writer(1), 10 * i * kMs), taken);
    EXPECT_EQ(source.take("imu", writer(2), (10 * i + 5) * kMs), other_writer);
  }
  EXPECT_EQ(source.rivals(), 50U);
  EXPECT_EQ(source.changes(), 0U);
}

TEST(ImuSourceTest, AWriterThatFollowsAnotherOfItsProcessIsNoChange) {
  ImuSource source("imu", 200 * kMs);
  EXPECT_EQ(source.take("imu", writer(1, 3), 0), ImuSource::Answer::taken);
  EXPECT_EQ(source.take("imu", writer(1, 4), kMs), ImuSource::Answer::taken);
  EXPECT_EQ(source.changes(), 0U);
}

TEST(ImuSourceTest, ABridgeStartedAgainIsHeardOnceTheOldOneIsSilent) {
  ImuSource source("imu", 200 * kMs);
  EXPECT_EQ(source.take("imu", writer(1), 0), ImuSource::Answer::taken);
  EXPECT_EQ(source.take("imu", writer(2), 200 * kMs), ImuSource::Answer::other_writer);
  EXPECT_EQ(source.take("imu", writer(2), 201 * kMs), ImuSource::Answer::taken);
  EXPECT_EQ(source.take("imu", writer(1), 202 * kMs), ImuSource::Answer::other_writer);
  EXPECT_EQ(source.changes(), 1U);
}

}  // namespace
}  // namespace fathom::fusion
