#include "fusion/intake/imu_source.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

WriterGuid writer(std::uint8_t process, std::uint8_t entity = 1) {
  WriterGuid out{};
  out[0] = process;
  out[15] = entity;
  return out;
}

TEST(ImuSourceTest, ListensToOneUnitAndToOneProcess) {
  using enum ImuSource::Answer;
  ImuSource source("imu", 200 * kNsPerMillisecond);
  EXPECT_EQ(source.take("imu_spare", writer(1), 0), other_unit) << "whichever comes first";
  for (int i = 1; i <= 50; ++i) {
    EXPECT_EQ(source.take("imu", writer(1), 10 * i * kNsPerMillisecond), taken);
    EXPECT_EQ(source.take("imu", writer(2), (10 * i + 5) * kNsPerMillisecond), other_writer);
  }
  EXPECT_EQ(source.rivals(), 50U);
  EXPECT_EQ(source.changes(), 0U);
}

TEST(ImuSourceTest, AWriterThatFollowsAnotherOfItsProcessIsNoChange) {
  ImuSource source("imu", 200 * kNsPerMillisecond);
  EXPECT_EQ(source.take("imu", writer(1, 3), 0), ImuSource::Answer::taken);
  EXPECT_EQ(source.take("imu", writer(1, 4), kNsPerMillisecond), ImuSource::Answer::taken);
  EXPECT_EQ(source.changes(), 0U);
}

TEST(ImuSourceTest, ABridgeStartedAgainIsHeardOnceTheOldOneIsSilent) {
  ImuSource source("imu", 200 * kNsPerMillisecond);
  EXPECT_EQ(source.take("imu", writer(1), 0), ImuSource::Answer::taken);
  EXPECT_EQ(source.take("imu", writer(2), 200 * kNsPerMillisecond), ImuSource::Answer::other_writer);
  EXPECT_EQ(source.take("imu", writer(2), 201 * kNsPerMillisecond), ImuSource::Answer::taken);
  EXPECT_EQ(source.take("imu", writer(1), 202 * kNsPerMillisecond), ImuSource::Answer::other_writer);
  EXPECT_EQ(source.changes(), 1U);
}

}  // namespace
}  // namespace fathom::fusion
