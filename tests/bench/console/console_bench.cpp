// What the console costs: navigation states at 400 Hz, three browsers. Prints figures; a machine that is busy
// with other things is no reason to fail.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include "base/clock.hpp"
#include "bus/writer.hpp"
#include "integration/console/console_fixture.hpp"
#include "samples/verdict.hpp"
#include "support/process_usage.hpp"

namespace fathom::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kMeasuredS = 20.0;

class ConsoleBench : public ConsoleTest {};

TEST_F(ConsoleBench, FourHundredHertzAndThreeBrowsers) {
  start_and_wait(33);
  std::array<std::atomic<int>, 3> ticks{};
  std::atomic<bool> over{false};
  std::vector<std::thread> threads;
  for (auto& count : ticks) {
    threads.emplace_back([this, &count, &over] {
      HttpPeer peer(port);
      peer.say("GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
      while (!over && peer.event("tick")) ++count;
    });
  }
  std::atomic<int> states{0};
  threads.emplace_back([&] {
    bus::Writer<Verdict> verdicts(network->participant());
    auto next = Clock::now();
    while (!over) {
      network->nav();
      if (++states % 13 == 0) {
        Verdict verdict;
        verdict.header = network->header("dvl");
        verdict.source = SourceKind::dvl;
        verdict.model = "dvl_velocity";
        verdict.dimensions = 3;
        verdicts.write(verdict);
      }
      next += std::chrono::microseconds(2500);
      std::this_thread::sleep_until(next);
    }
  });
  EXPECT_TRUE(wait_until([&] { return ticks[0] > 10 && ticks[1] > 10 && ticks[2] > 10; }, kPatienceS));
  const auto began = Clock::now();
  const double used_before_s = processor_s(console->pid());
  const int states_before = states;
  const int ticks_before = ticks[0];
  std::this_thread::sleep_for(std::chrono::duration<double>(kMeasuredS));
  const double span_s = std::chrono::duration<double>(Clock::now() - began).count();
  const double share = (processor_s(console->pid()) - used_before_s) / span_s;
  std::printf(
      "{\"rows\": [{\"name\": \"console, 3 browsers, %.0f Hz\", \"unit\": \"%% of a core\", \"value\": "
      "%.2f}, "
      "{\"name\": \"console, updates to each browser\", \"unit\": \"Hz\", \"value\": %.2f}, "
      "{\"name\": \"console, resident memory\", \"unit\": \"MB\", \"value\": %.1f}]}\n",
      (states - states_before) / span_s, 100.0 * share, (ticks[0] - ticks_before) / span_s,
      resident_MB(console->pid()));
  over = true;
  for (auto& thread : threads) thread.join();
}

// Twelve hours of vehicle time in some minutes, with a browser listening. Takes its time, so only when asked:
//   FATHOM_SOAK=1 build/tests/bench_console --gtest_filter=*TwelveHours*
TEST_F(ConsoleBench, TwelveHours) {
  if (std::getenv("FATHOM_SOAK") == nullptr)
    GTEST_SKIP() << "FATHOM_SOAK is not set, and twelve hours of the vehicle take minutes";
  constexpr double kRate = 100.0;
  constexpr double kVehicleS = 12.0 * 3600.0;
  const TimeNs epoch_ns = clock.utc_ns();
  const ScaledClock fast(epoch_ns, kRate);
  start_and_wait(34, {"clock.rate=100.0", "clock.epoch_ns=" + std::to_string(epoch_ns)});
  VehicleNetwork vehicle(34, fast, "fast_vehicle");
  ASSERT_TRUE(wait_until([&] { return vehicle.nav_heard_by_someone(); }, kPatienceS));
  std::atomic<bool> over{false};
  std::thread browser([&] {
    HttpPeer peer(port);
    peer.say("GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
    while (!over && peer.event("tick")) continue;
  });
  const TimeNs began_ns = fast.utc_ns();
  TimeNs next_look_ns = began_ns;
  std::uint64_t states = 0;
  std::vector<double> resident;
  for (TimeNs now = began_ns; to_seconds(now - began_ns) < kVehicleS; now = fast.utc_ns()) {
    vehicle.nav();
    ++states;
    if (states % 2000 == 0) vehicle.gps(states % 4000 == 0);
    if (now < next_look_ns) continue;
    next_look_ns += 3600 * kNsPerSecond;
    resident.push_back(resident_MB(console->pid()));
    std::printf("%5.2f h: %.1f MB resident, %llu states\n", to_seconds(now - began_ns) / 3600.0,
                resident.back(), static_cast<unsigned long long>(states));
    std::fflush(stdout);
  }
  over = true;
  browser.join();
  // The first hour fills the rings.
  ASSERT_GT(resident.size(), 3U);
  const auto [least, most] = std::minmax_element(resident.begin() + 1, resident.end());
  std::printf("from the first hour on %.1f to %.1f MB\n", *least, *most);
  EXPECT_LT(*most, 1.1 * *least);
}

}  // namespace
}  // namespace fathom::test
