// From a navigation state's publication to the odometry at a node of ROS 2, through the gateway, beside two
// hops of as many bytes over Fast DDS alone through a relay that does nothing, at the same time on the same
// machine. What the gateway adds is the difference. Prints a table. FATHOM_SOAK=1: for a minute, with a
// limit.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "bench/latency/raw_hops.hpp"
#include "bus/cdr.hpp"
#include "bus/ros2/node.hpp"
#include "bus/writer.hpp"
#include "ros2/messages/geometry.hpp"
#include "samples/nav_state.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "unit/ros2/state.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kVehicle = 75;
constexpr std::uint32_t kGraph = 76;
constexpr double kRate_hz = 100.0;
constexpr double kDrift = 1.013;             // the two do not meet, or miss, each other all the time
constexpr std::size_t kOdometryBytes = 732;  // as it travels, with the names of frames that are shipped

double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

NavState a_state() {
  return ros2::test::state_at({0.6, 0.1, -3.0}, {0.01, 0.02, 0.5});
}

TEST(Ros2GatewayBench, FromTheNavigationStateToTheOdometry) {
  const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
  const std::size_t nav_bytes = bus::to_cdr(a_state()).size();
  RawHops raw("ros2", {nav_bytes}, {kOdometryBytes});  // first: it forks, and there are no threads yet
  std::vector<std::string> arguments{"--config", FATHOM_SOURCE_DIR "/deploy/config/ros2_gateway.json"};
  for (const std::string& set :
       {"bus.domain=" + std::to_string(kVehicle), "ros.domain=" + std::to_string(kGraph),
        std::string("bus.profiles_dir=" FATHOM_SOURCE_DIR "/deploy/dds"), std::string("clock.anchor_file="),
        std::string("outputs.odometry.rate_hz=0")}) {
    arguments.insert(arguments.end(), {"--set", set});
  }
  Process gateway("fathom-ros2-gateway", arguments);

  const SystemClock clock;
  std::mutex mutex;
  std::vector<double> through_us;
  std::vector<double> second_us;  // of them, from the gateway's write on
  bus::ParticipantOptions graph_options = presence(kGraph, "gateway_bench");
  graph_options.user_data = bus::ros2::kUserData;
  bus::Participant graph(graph_options);
  bus::ros2::Node node(graph, {"/", "gateway_bench", ros2::Distro::jazzy});
  const bus::ros2::Subscription<ros2::Odometry> odometry(
      node, "/fathom/odometry", bus::ros2::Quality::reliable,
      [&](const ros2::Odometry& message, const bus::SampleInfo& info) {
        const TimeNs now_ns = clock.utc_ns();
        const TimeNs sent_ns = message.header.stamp.sec * kNsPerSecond + message.header.stamp.nanosec;
        const std::lock_guard lock(mutex);
        through_us.push_back(1e-3 * static_cast<double>(now_ns - sent_ns));
        second_us.push_back(1e-3 * static_cast<double>(now_ns - info.source_ns));
      });
  bus::Participant vehicle(presence(kVehicle, "gateway_bench"));
  bus::Writer<NavState> writer(vehicle);
  ASSERT_TRUE(wait_until(
      [&] { return writer.matched_readers() > 0 && odometry.matched_publishers() > 0 && raw.matched(); },
      60.0))
      << gateway.err();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  raw.send(kDrift * kRate_hz);
  (void)raw.take_round_us();
  const int count = static_cast<int>(kRate_hz) * (soak ? 60 : 10);
  NavState state = a_state();
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) {
    state.header.sequence = static_cast<std::uint64_t>(i + 1);
    state.header.stamp_ns = clock.utc_ns();
    writer.write(state);
    std::this_thread::sleep_until(next += std::chrono::microseconds(static_cast<int>(1e6 / kRate_hz)));
  }
  const std::vector<double> raw_us = raw.take_round_us();
  raw.send(0.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  gateway.kill(SIGTERM);
  EXPECT_EQ(gateway.wait(), 0) << gateway.err();
  const std::lock_guard lock(mutex);
  ASSERT_GE(through_us.size(), static_cast<std::size_t>(0.9 * count));
  ASSERT_GE(raw_us.size(), static_cast<std::size_t>(0.9 * count));
  const double through = percentile(through_us, 0.5);
  const double relay = percentile(raw_us, 0.5);
  std::printf(
      "%.0f Hz, %zu and %zu bytes: through the gateway p50 %.0f us (%.0f us from its write on), p99 %.0f us\n"
      "  raw relay p50 %.0f us, p99 %.0f us; the gateway adds %.2f raw hops (p50)\n",
      kRate_hz, nav_bytes, kOdometryBytes, through, percentile(second_us, 0.5), percentile(through_us, 0.99),
      relay, percentile(raw_us, 0.99), (through - relay) / (0.5 * relay));
  if (!soak) return;
  EXPECT_LE(through - relay, 0.5 * relay);
}

}  // namespace
}  // namespace fathom::test
