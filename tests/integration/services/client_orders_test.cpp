// Orders and told positions of a guidance program, as whoever takes them hears them.

#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fathom/client.hpp>
#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "samples/command.hpp"
#include "samples/position/fix.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "vehicle_network.hpp"

namespace fathom::test {
namespace {

ClientOptions planner_options(std::uint32_t domain) {
  ClientOptions out;
  out.domain = domain;
  out.vehicle = "auv";
  out.name = "planner";
  out.profiles_dir = source_dir() + "/deploy/dds";
  return out;
}

/// What fusion would hear.
class Listening {
 public:
  explicit Listening(std::uint32_t domain)
      : participant_(presence(domain, "listening")),
        commands_(participant_,
                  [this](const Command& command, const bus::SampleInfo&) {
                    const std::lock_guard lock(mutex_);
                    command_ = command;
                  }),
        fixes_(participant_, [this](const FixSample& fix, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          fix_ = fix;
        }) {}
  std::optional<Command> command() {
    (void)wait_until([this] { return has(command_); });
    const std::lock_guard lock(mutex_);
    return std::exchange(command_, std::nullopt);
  }
  std::optional<FixSample> fix() {
    (void)wait_until([this] { return has(fix_); });
    const std::lock_guard lock(mutex_);
    return std::exchange(fix_, std::nullopt);
  }

 private:
  template <class T>
  bool has(const std::optional<T>& one) {
    const std::lock_guard lock(mutex_);
    return one.has_value();
  }

  bus::Participant participant_;
  std::mutex mutex_;
  std::optional<Command> command_;
  std::optional<FixSample> fix_;
  bus::Reader<Command> commands_;
  bus::Reader<FixSample> fixes_;
};

Command position(double latitude_rad) {
  Command out;
  out.kind = CommandKind::set_position;
  out.latitude_rad = latitude_rad;
  out.longitude_rad = 2.2;
  out.depth_m = 5.0;
  out.sigma_m = 10.0;
  return out;
}

TEST(ClientOrders, AreGivenInItsNameAndAtTheTimeOfTheVehicle) {
  const SystemClock clock;
  VehicleNetwork network(184, clock);
  Client client(planner_options(184));
  Listening listening(184);
  ASSERT_TRUE(wait_until([&] {
    network.nav();
    return client.latest().has_value();
  }));
  client.order(position(0.63), 20.0);
  const auto heard = listening.command();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->kind, CommandKind::set_position);
  EXPECT_EQ(heard->latitude_rad, 0.63);
  EXPECT_EQ(heard->depth_m, 5.0);
  EXPECT_EQ(heard->header.vehicle, Name("auv"));
  EXPECT_EQ(heard->header.sensor, Name("planner"));
  EXPECT_NEAR(to_seconds(clock.utc_ns() - heard->header.stamp_ns), 0.0, 5.0);
  Command off;
  off.kind = CommandKind::disable_source;
  off.target = "gps";
  client.order(off, 20.0);
  const auto next = listening.command();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->target, Name("gps"));
  EXPECT_EQ(next->header.sequence, heard->header.sequence + 1);
}

TEST(ClientOrders, APositionIsToldOfThenAndOfThoseWhoSaySo) {
  Client client(planner_options(184));
  Listening listening(184);
  FixSample fix;
  fix.latitude_rad = 0.63;
  fix.longitude_rad = 2.2;
  fix.sigma_m = 20.0;
  client.tell(fix, 20.0);
  const auto now = listening.fix();
  ASSERT_TRUE(now);
  EXPECT_EQ(now->header.sensor, Name("planner"));
  EXPECT_EQ(now->header.stamp_ns, now->header.received_ns);
  EXPECT_TRUE(std::isnan(now->depth_m));
  fix.header.sensor = "ship";
  fix.header.stamp_ns = now->header.stamp_ns - 600 * kNsPerSecond;
  client.tell(fix, 20.0);
  const auto then = listening.fix();
  ASSERT_TRUE(then);
  EXPECT_EQ(then->header.sensor, Name("ship"));
  EXPECT_EQ(then->header.stamp_ns, fix.header.stamp_ns);
  EXPECT_GT(then->header.sequence, now->header.sequence);
  fix.header.stamp_ns = now->header.stamp_ns - 3 * 3600 * kNsPerSecond;
  EXPECT_THROW(client.tell(fix, 20.0), std::invalid_argument) << "nobody remembers for so long";
}

TEST(ClientOrders, ThatNobodyTakesOrCanBeMeantSaySo) {
  Client client(planner_options(184));
  EXPECT_THROW(client.order(position(0.63), 0.1), NobodyListens);
  try {
    client.order(position(36.4), 0.1);
    FAIL() << "degrees for radians";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("latitude_rad is 36.4"), std::string::npos) << error.what();
  }
  EXPECT_THROW(client.order(position(std::nan("")), 0.1), std::invalid_argument);
  Command nothing;
  nothing.kind = CommandKind::disable_source;
  EXPECT_THROW(client.order(nothing, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace fathom::test
