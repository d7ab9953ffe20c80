#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "byte_listener.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "support.hpp"

namespace fathom::runtime {
namespace {

using test::bytes_of;
using test::eventually;
using test::Listener;
using test::quick;

class SharedPort : public testing::Test {
 protected:
  SharedPort() {
    config_ = quick(SourceType::serial);
    config_.silence_s = 60.0;
    config_.path = folder_ / "device";
    config_.shared = true;
    device_ = std::make_unique<test::SerialDevice>(config_.path);
  }
  std::unique_ptr<Listener> listener() const {
    auto out = std::make_unique<Listener>(config_);
    EXPECT_TRUE(eventually([&] { return out->state() == SourceState::connected; }));
    return out;
  }

  test::TemporaryFolder folder_;
  ByteSourceConfig config_;
  std::unique_ptr<test::SerialDevice> device_;
};

TEST_F(SharedPort, EveryReaderGetsEveryByte) {
  const auto one = listener();
  const auto two = listener();
  const auto three = listener();
  std::string all;
  for (int i = 0; i < 200; ++i) {
    const std::string line = "line " + std::to_string(i) + "\r\n";
    device_->send(bytes_of(line));
    all += line;
  }
  for (const auto* each : {one.get(), two.get(), three.get()}) {
    EXPECT_TRUE(eventually([&] { return each->heard(all); }));
    EXPECT_EQ(each->size(), all.size());
  }
}

TEST_F(SharedPort, WhoIsHeldUpKnowsWhenTheBytesArrived) {
  const auto one = listener();
  const auto two = listener();
  two->hold();
  device_->send(bytes_of("first"));
  ASSERT_TRUE(eventually([&] { return two->heard("first") && one->heard("first"); }));
  const TimeNs paused_ns = SystemClock().monotonic_ns();
  device_->send(bytes_of("second"));
  ASSERT_TRUE(eventually([&] { return one->heard("second"); }));
  const TimeNs read_ns = SystemClock().monotonic_ns();
  two->release();
  ASSERT_TRUE(eventually([&] { return two->heard("second"); }));
  EXPECT_GE(two->last().monotonic_ns, paused_ns);
  // It was read after this, and arrived before.
  EXPECT_LE(two->last().monotonic_ns, read_ns);
}

TEST_F(SharedPort, AnotherOpensItWhenTheOneThatReadsItEnds) {
  auto one = listener();
  const auto two = listener();
  const auto three = listener();
  one.reset();
  ASSERT_TRUE(eventually([&] {
    return two->status().connects == 2 && three->status().connects == 2 &&
           two->state() == SourceState::connected && three->state() == SourceState::connected;
  }));
  device_->send(bytes_of("after"));
  EXPECT_TRUE(eventually([&] { return two->heard("after") && three->heard("after"); }));
  const auto again = listener();
  device_->send(bytes_of("and again"));
  EXPECT_TRUE(eventually([&] { return again->heard("and again") && three->heard("and again"); }));
}

TEST_F(SharedPort, ADeviceThatVanishesIsLostToAllAndFoundByAll) {
  const auto one = listener();
  const auto two = listener();
  device_.reset();
  ASSERT_TRUE(eventually([&] {
    return one->state() == SourceState::lost && two->state() == SourceState::lost &&
           one->status().errors > 3 && two->status().errors > 3;
  }));
  device_ = std::make_unique<test::SerialDevice>(config_.path);
  ASSERT_TRUE(eventually(
      [&] { return one->state() == SourceState::connected && two->state() == SourceState::connected; }));
  device_->send(bytes_of("back"));
  EXPECT_TRUE(eventually([&] { return one->heard("back") && two->heard("back"); }));
}

TEST_F(SharedPort, OneThatDoesNotShareIsToldWhoHasIt) {
  const auto one = listener();
  ByteSourceConfig alone = config_;
  alone.shared = false;
  const Listener other(alone);
  ASSERT_TRUE(eventually([&] { return other.status().errors > 0; }));
  EXPECT_NE(other.status().detail.find("in use"), std::string::npos) << other.status().detail;
}

TEST_F(SharedPort, AReaderThatStandsStillHoldsUpNobodyAndComesBack) {
  const auto one = listener();
  const auto two = listener();
  two->hold();
  const std::string much(2'000, 'x');
  for (int i = 0; i < 200; ++i) {
    device_->send(bytes_of(much));
    ASSERT_TRUE(eventually([&] { return one->size() == (static_cast<std::size_t>(i) + 1) * much.size(); }));
  }
  two->release();
  // It was let go when its socket was full, reads what is left there and connects anew.
  ASSERT_TRUE(
      eventually([&] { return two->status().connects == 2 && two->state() == SourceState::connected; }));
  EXPECT_LT(two->size(), one->size());
  device_->send(bytes_of("and on"));
  EXPECT_TRUE(eventually([&] { return two->heard("and on"); }));
}

TEST_F(SharedPort, DatagramsComeWhole) {
  ByteSourceConfig udp = quick(SourceType::udp);
  udp.silence_s = 60.0;
  udp.port = test::free_port(SOCK_DGRAM);
  udp.shared = true;
  const Listener one(udp);
  ASSERT_TRUE(eventually([&] { return one.state() == SourceState::connected; }));
  const Listener two(udp);
  ASSERT_TRUE(eventually([&] { return two.state() == SourceState::connected; }));
  const std::string longest(60'000, 'y');
  test::send_udp(udp.port, bytes_of(longest));
  EXPECT_TRUE(eventually([&] { return one.heard(longest) && two.heard(longest); }));
}

// A unit with a receiver inside, on one line, and a bridge for each.
TEST(SharedPortOfBridges, OneOutlivesTheOtherAndBothReadAgain) {
  constexpr int kDomain = 147;
  const test::TemporaryFolder folder;
  bus::Participant participant(test::test_participant(kDomain));
  const test::Collector<ImuSample> imu(participant);
  const test::Collector<GpsSample> gps(participant);
  const test::SerialDevice unit(folder / "unit");
  const std::string source = R"(sensors.0.source={"type":"serial","path":")" + (folder / "unit") +
                             R"(","shared":true,"backoff_most_s":0.2})";
  const auto start = [&](const std::string& kind, const std::string& log) {
    return std::make_unique<test::Process>(
        "fathom-" + kind + "-bridge",
        test::bridge_arguments(kind, kDomain, {source, "sensors.0.protocol=vectornav"}), folder / log);
  };
  DurationNs startup_ns = 1000 * kNsPerSecond;
  std::uint64_t sent = 0;
  const auto talk = [&] {
    startup_ns += 10 * kNsPerMillisecond;
    ImuSample inertial;
    inertial.angular_rate_B_rad_s = {0.125, -0.25, 0.5};
    inertial.specific_force_B_m_s2 = {1.0, 2.0, -9.75};
    sim::encode::VectornavFix fix;
    fix.utc_ns = test::utc_now() - kNsPerMillisecond;
    fix.sample.fix = GpsFix::fix_3d;
    fix.sample.latitude_rad = 0.625;
    fix.sample.longitude_rad = 2.25;
    fix.sample.altitude_m = 12.5;
    unit.send(sim::encode::vectornav(inertial, startup_ns, std::nullopt, ++sent % 20 == 0 ? &fix : nullptr));
  };
  const auto heard = [&](const auto& collector) {
    const std::size_t before = collector.count();
    return eventually([&] {
      talk();
      return collector.count() >= before + 3;
    });
  };
  auto first = start("imu", "imu.log");
  ASSERT_TRUE(heard(imu)) << first->output();
  const auto second = start("gps", "gps.log");
  ASSERT_TRUE(heard(gps)) << second->output();
  ASSERT_TRUE(heard(imu)) << "the receiver's bridge takes nothing from the unit's: " << first->output();
  EXPECT_NEAR(gps.all().back().latitude_rad, 0.625, 1e-12);
  first->signal(SIGKILL);
  EXPECT_EQ(first->wait(), -1);
  ASSERT_TRUE(heard(gps)) << second->output();
  first = start("imu", "imu_again.log");
  EXPECT_TRUE(heard(imu)) << first->output();
  EXPECT_TRUE(heard(gps)) << second->output();
}

}  // namespace
}  // namespace fathom::runtime
