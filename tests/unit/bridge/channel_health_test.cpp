#include "bridge/channel_health.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fathom::bridge {
namespace {

using runtime::SourceState;

// An instrument that is asked once a second.
class Instrument {
 public:
  Instrument(double rate_hz, double stale_s, double first_sample_s = 0.0)
      : health_(rate_hz, stale_s, first_sample_s, 0) {
    totals_.state = SourceState::connected;
  }
  std::optional<std::string> second(std::uint64_t samples, std::uint64_t waste = 0) {
    now_ += kNsPerSecond;
    totals_.samples += samples;
    totals_.bytes += samples * 100 + waste;
    totals_.waste_bytes += waste;
    if (samples > 0) totals_.last_sample_ns = now_;
    return health_.judge(totals_, now_);
  }
  ChannelTotals& totals() { return totals_; }
  double rate_hz() const { return health_.rate_hz(); }

 private:
  ChannelHealth health_;
  ChannelTotals totals_;
  TimeNs now_ = 0;
};

TEST(ChannelHealth, AtItsRateAllIsWell) {
  Instrument imu(100.0, 2.0);
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(imu.second(100));
  EXPECT_NEAR(imu.rate_hz(), 100.0, 1e-9);
}

TEST(ChannelHealth, SlowIsSaidAfterAWindow) {
  Instrument imu(100.0, 2.0);
  std::optional<std::string> said;
  for (int i = 0; i < 10; ++i) said = imu.second(40);
  EXPECT_EQ(said, "slow: 40.00 Hz instead of 100.00 Hz");
  for (int i = 0; i < 10; ++i) said = imu.second(100);
  EXPECT_FALSE(said);
}

TEST(ChannelHealth, AnInstrumentEveryFiveSecondsIsNotSlow) {
  Instrument usbl(0.2, 60.0);
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(usbl.second(i % 5 == 0 ? 1 : 0)) << i;
}

TEST(ChannelHealth, AnInstrumentThatWaterSwitchesOnMayBeSilentBefore) {
  Instrument depth(10.0, 2.0, 30.0);
  for (int i = 0; i < 29; ++i) EXPECT_FALSE(depth.second(0)) << i;
  EXPECT_EQ(depth.second(0), "no usable sample for 30.0 s");
  EXPECT_FALSE(depth.second(10));
  EXPECT_FALSE(depth.second(0));
  EXPECT_FALSE(depth.second(0));
  EXPECT_EQ(depth.second(0), "no usable sample for 3.0 s") << "once it has spoken it must go on";
}

TEST(ChannelHealth, BeforeItsFirstSampleGarbageAndALostSourceAreSaid) {
  Instrument babbling(10.0, 2.0, 30.0);
  std::optional<std::string> said;
  for (int i = 0; i < 5; ++i) said = babbling.second(0, 500);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->find("garbage"), 0U) << *said;
  Instrument lost(10.0, 2.0, 30.0);
  lost.totals().state = SourceState::lost;
  lost.totals().detail = "serial port /dev/ttyS9: No such file or directory";
  for (int i = 0; i < 3; ++i) said = lost.second(0);
  EXPECT_EQ(said, lost.totals().detail);
}

TEST(ChannelHealth, StaleAndBackAgain) {
  Instrument depth(10.0, 2.0);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(depth.second(10));
  EXPECT_FALSE(depth.second(0));
  EXPECT_FALSE(depth.second(0));
  EXPECT_EQ(depth.second(0), "no usable sample for 3.0 s");
  std::optional<std::string> said;
  for (int i = 0; i < 10; ++i) said = depth.second(10);
  EXPECT_FALSE(said);
}

TEST(ChannelHealth, BabbleIsNamed) {
  Instrument gps(2.0, 2.5);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(gps.second(2));
  std::optional<std::string> said;
  for (int i = 0; i < 5; ++i) said = gps.second(0, 5000);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->substr(0, 8), "garbage:");
}

TEST(ChannelHealth, ForeignBytesBesideAFullRateAreNoProblem) {
  Instrument gps(2.0, 2.5);
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(gps.second(2, 5000));
}

TEST(ChannelHealth, ALostSourceGivesItsReasonOnceTheStartIsOver) {
  Instrument dvl(5.0, 3.0);
  dvl.totals().state = SourceState::lost;
  dvl.totals().detail = "tcp 10.0.0.7:16171: Connection refused";
  EXPECT_FALSE(dvl.second(0));
  EXPECT_FALSE(dvl.second(0));
  EXPECT_EQ(dvl.second(0), "tcp 10.0.0.7:16171: Connection refused");
}

TEST(ChannelHealth, ASourceThatIsLostWhileRunningIsSaidAtOnce) {
  Instrument dvl(5.0, 3.0);
  EXPECT_FALSE(dvl.second(5));
  dvl.totals().state = SourceState::silent;
  dvl.totals().detail = "silent";
  EXPECT_EQ(dvl.second(0), "silent");
}

}  // namespace
}  // namespace fathom::bridge
