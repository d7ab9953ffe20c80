// What protection costs: NavState from write() to the reader's handler over UDP on the loopback interface,
// plain, with messages signed and with messages encrypted (samples are encrypted in both), and the processor
// time of it all. Prints a table; fails only when a sample is lost. FATHOM_SOAK=1: seven times as long.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/clock.hpp"
#include "bus/writer.hpp"
#include "integration/bus/support.hpp"
#include "samples/nav_state.hpp"
#include "security/keygen.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 218;
const bool kSoak = std::getenv("FATHOM_SOAK") != nullptr;
const int kRounds = kSoak ? 3 : 1;  // the ways take turns, so that a busy machine is busy for all
const double kSecondsARound = kSoak ? 5.0 : 2.0;

struct Way {
  const char* name;
  std::optional<security::MessageProtection> protection;
};
constexpr std::array kWays{Way{"plain", std::nullopt}, Way{"sign", security::MessageProtection::sign},
                           Way{"encrypt", security::MessageProtection::encrypt}};

struct Measured {
  std::vector<double> latencies_us;
  double processor_us = 0.0;
  std::size_t samples = 0;
};

double processor_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double percentile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

void measure(const Way& way, double rate_hz, int readers, Measured& into) {
  const TemporaryFolder folder;
  const auto presence = [&](const std::string& name) {
    bus::ParticipantOptions out = options(kDomain, name);
    if (way.protection) out.security.folder = folder.path().string() + "/credentials";
    return out;
  };
  if (way.protection) {
    security::KeygenOptions keygen;
    keygen.folder = folder / "credentials";
    keygen.protection = *way.protection;
    security::make_credentials(keygen, SystemClock().utc_ns());
  }
  const SystemClock clock;
  std::mutex mutex;
  bus::Participant fusion(presence("fusion"));
  std::vector<std::unique_ptr<bus::Participant>> participants;
  std::vector<std::unique_ptr<bus::Reader<NavState>>> listeners;
  std::atomic<std::size_t> received = 0;
  std::atomic<bool> counting = false;
  for (int i = 0; i < readers; ++i) {
    participants.push_back(std::make_unique<bus::Participant>(presence("guidance")));
    listeners.push_back(std::make_unique<bus::Reader<NavState>>(
        *participants.back(), [&](const NavState& state, const bus::SampleInfo&) {
          const double latency_us = to_seconds(clock.monotonic_ns() - state.header.stamp_ns) * 1e6;
          if (counting) {
            const std::lock_guard lock(mutex);
            into.latencies_us.push_back(latency_us);
          }
          ++received;
        }));
  }
  bus::Writer<NavState> writer(fusion);
  ASSERT_TRUE(eventually(
      [&] {
        return writer.matched_readers() == readers &&
               std::all_of(listeners.begin(), listeners.end(),
                           [](const auto& listener) { return listener->matched_writers() == 1; });
      },
      milliseconds(60'000)))
      << writer.matched_readers() << " of " << readers << ", " << way.name;
  NavState state;
  state.header.vehicle = "auv";
  const auto write = [&](int samples) {
    auto next = std::chrono::steady_clock::now();
    for (int i = 0; i < samples; ++i) {
      ++state.header.sequence;
      state.header.stamp_ns = clock.monotonic_ns();
      ASSERT_TRUE(writer.write(state));
      next += std::chrono::nanoseconds(from_seconds(1.0 / rate_hz));
      std::this_thread::sleep_until(next);
    }
  };
  const int samples = static_cast<int>(kSecondsARound * rate_hz);
  const auto all = [&](int count) {
    return static_cast<std::size_t>(count) * static_cast<std::size_t>(readers);
  };
  write(100);
  ASSERT_TRUE(eventually([&] { return received >= all(100); }, milliseconds(60'000)));
  counting = true;
  const double before_s = processor_s();
  write(samples);
  ASSERT_TRUE(eventually([&] { return received >= all(100 + samples); }, milliseconds(60'000)));
  into.processor_us += (processor_s() - before_s) * 1e6;
  into.samples += static_cast<std::size_t>(samples);
  EXPECT_EQ(received, all(100 + samples));
}

TEST(SecurityBench, LatencyOfTheNavigationState) {
  std::printf("%-8s %8s %8s %10s %10s %10s %22s\n", "messages", "rate Hz", "readers", "p50 us", "p99 us",
              "p99.9 us", "processor us a sample");
  for (const auto& [rate_hz, readers] : {std::pair(100.0, 1), std::pair(400.0, 1), std::pair(100.0, 8)}) {
    std::array<Measured, kWays.size()> measured;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < kWays.size(); ++i) measure(kWays[i], rate_hz, readers, measured[i]);
    }
    for (std::size_t i = 0; i < kWays.size(); ++i) {
      Measured& one = measured[i];
      ASSERT_FALSE(one.latencies_us.empty());
      std::printf("%-8s %8.0f %8d %10.0f %10.0f %10.0f %22.0f\n", kWays[i].name, rate_hz, readers,
                  percentile(one.latencies_us, 0.5), percentile(one.latencies_us, 0.99),
                  percentile(one.latencies_us, 0.999), one.processor_us / static_cast<double>(one.samples));
    }
  }
}

}  // namespace
}  // namespace fathom::test
