// From a navigation state's publication to who hears it behind a door: a node of ROS 2, a chart plotter, an
// autopilot, Foxglove. Beside it, at the same time on the same machine, two hops of as many bytes over Fast
// DDS alone through a relay that does nothing, and datagrams through a socket. A gateway needs one hop to
// hear the state, and to say it another one, or a socket: what is left is what it adds. Prints a line a door.
// FATHOM_SOAK=1: for a minute each, with a limit.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "base/clock.hpp"
#include "bench/doors/listeners.hpp"
#include "bench/latency/raw_hops.hpp"
#include "bus/cdr.hpp"
#include "bus/writer.hpp"
#include "samples/nav_state.hpp"
#include "support/free_port.hpp"
#include "support/paths.hpp"
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

struct Door {
  std::string service;  ///< its configuration is SERVICE.json
  std::string program;
  std::vector<std::string> sets;
  std::optional<SocketHop::Kind> by;  ///< it says by such a socket what it hears; none: by DDS
  std::function<std::unique_ptr<Listener>(Arrivals&)> listen;
};

class Doors : public ::testing::Test {
 protected:
  // It forks: before this process has threads.
  static void SetUpTestSuite() {
    raw = new RawHops("doors", {bus::to_cdr(a_state()).size()}, {kOdometryBytes});
  }
  static void TearDownTestSuite() { delete raw; }

  void measure(const Door& door) {
    const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
    std::vector<std::string> arguments{"--config", source_dir() + "/deploy/config/" + door.service + ".json"};
    std::vector<std::string> sets = door.sets;
    sets.insert(sets.end(), {"bus.domain=" + std::to_string(kVehicle),
                             "bus.profiles_dir=" + source_dir() + "/deploy/dds", "clock.anchor_file="});
    for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
    Process gateway(door.program, arguments);
    Arrivals arrivals;
    const auto listener = door.listen(arrivals);
    bus::Participant vehicle(presence(kVehicle, "doors_bench"));
    bus::Writer<NavState> writer(vehicle);
    const bool met = wait_until(
        [&] { return writer.matched_readers() > 0 && listener->connected() && raw->matched(); }, 60.0);
    ASSERT_TRUE(met) << gateway.err();
    SocketHop socket(door.by.value_or(SocketHop::Kind::udp), kOdometryBytes);
    say(writer, arrivals, socket, static_cast<int>(kRate_hz));  // until all are awake
    (void)arrivals.take_us();
    (void)socket.take_us();
    raw->send(kDrift * kRate_hz);
    (void)raw->take_round_us();
    const int count = static_cast<int>(kRate_hz) * (soak ? 60 : 5);
    say(writer, arrivals, socket, count);
    const std::vector<double> raw_us = raw->take_round_us();
    raw->send(0.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const std::vector<double> through_us = arrivals.take_us();
    gateway.kill(SIGTERM);
    EXPECT_EQ(gateway.wait(), 0) << gateway.err();
    ASSERT_GE(through_us.size(), static_cast<std::size_t>(0.9 * count)) << gateway.err();
    ASSERT_GE(raw_us.size(), static_cast<std::size_t>(0.9 * count));
    const double hop = 0.5 * percentile(raw_us, 0.5);
    const double out = percentile(socket.take_us(), 0.5);
    const double through = percentile(through_us, 0.5);
    const double added_hops = (through - hop - (door.by ? out : hop)) / hop;
    std::printf(
        "%s, %.0f Hz: p50 %.0f us, p99 %.0f us; a raw hop p50 %.0f us, a socket %.0f us; adds %.2f raw hops "
        "(p50)\n",
        door.program.c_str(), kRate_hz, through, percentile(through_us, 0.99), hop, out, added_hops);
    if (!soak) return;
    EXPECT_LE(added_hops, 1.0);
  }

 private:
  static void say(bus::Writer<NavState>& writer, Arrivals& arrivals, SocketHop& socket, int count) {
    const SystemClock clock;
    NavState state = a_state();
    auto next = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
      state.header.sequence = static_cast<std::uint64_t>(i + 1);
      const TimeNs now_ns = clock.utc_ns();
      state.header.stamp_ns = now_ns / kNsPerMillisecond * kNsPerMillisecond;
      arrivals.said(state.header.stamp_ns, now_ns);
      writer.write(state);
      std::this_thread::sleep_until(next += std::chrono::microseconds(static_cast<int>(0.5e6 / kRate_hz)));
      socket.send();
      std::this_thread::sleep_until(next += std::chrono::microseconds(static_cast<int>(0.5e6 / kRate_hz)));
    }
  }

  static RawHops* raw;
};
RawHops* Doors::raw = nullptr;

TEST_F(Doors, Ros2) {
  measure({"ros2_gateway",
           "fathom-ros2-gateway",
           {"ros.domain=" + std::to_string(kGraph), "outputs.odometry.rate_hz=0"},
           std::nullopt,
           [](Arrivals& arrivals) { return hear_ros2(kGraph, arrivals); }});
}

TEST_F(Doors, NmeaOut) {
  const int port = free_port(SOCK_DGRAM);
  measure({"nmea_out",
           "fathom-nmea-out",
           {R"(outputs=[{"type":"udp","address":"127.0.0.1","port":)" + std::to_string(port) +
            R"(,"sentences":[{"sentence":"GGA","rate_hz":100}]}])"},
           SocketHop::Kind::udp,
           [port](Arrivals& arrivals) { return hear_nmea(port, arrivals); }});
}

TEST_F(Doors, MavlinkGateway) {
  const int port = free_port(SOCK_DGRAM);
  measure({"mavlink_gateway",
           "fathom-mavlink-gateway",
           {"link.port=" + std::to_string(port), "messages.odometry_hz=200"},
           SocketHop::Kind::udp,
           [port](Arrivals& arrivals) { return hear_mavlink(port, arrivals); }});
}

TEST_F(Doors, Foxglove) {
  const int port = free_port(SOCK_STREAM);
  measure({"foxglove",
           "fathom-foxglove",
           {"port=" + std::to_string(port)},
           SocketHop::Kind::tcp,
           [port](Arrivals& arrivals) { return hear_foxglove(port, arrivals); }});
}

}  // namespace
}  // namespace fathom::test
