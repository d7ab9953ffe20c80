// From an inertial sample's arrival at its bridge to the navigation state at a subscriber, with every service
// of the survey running, beside two hops of as many bytes over Fast DDS alone, at the same time on the same
// machine. Prints a table. FATHOM_SOAK=1: for a minute at each rate, with limits.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "bench/latency/raw_hops.hpp"
#include "bus/cdr.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "samples/health.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "support/process.hpp"
#include "support/process_usage.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 96;
constexpr double kPatienceS = 120.0;

double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The relay, in a process of its own until the end of the scope.
class Relay {
 public:
  Relay(std::size_t first_bytes, std::size_t second_bytes) : pid_(fork()) {
    if (pid_ == 0) RawHops::relay(first_bytes, second_bytes);
  }
  ~Relay() {
    ::kill(pid_, SIGKILL);
    (void)waitpid(pid_, nullptr, 0);
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

 private:
  pid_t pid_;
};

/// The survey with another inertial rate, as a file.
std::string survey_at(double rate_hz, const TemporaryFolder& folder) {
  std::ifstream file(std::string(FATHOM_SOURCE_DIR) + "/deploy/config/scenarios/survey.json");
  auto scenario = nlohmann::json::parse(file);
  scenario["sensors"]["imu"]["rate_hz"] = rate_hz;
  const std::string path = folder / "survey.json";
  std::ofstream(path) << scenario.dump(2);
  return path;
}

class Guidance {
 public:
  Guidance()
      : participant_(options()),
        states_(
            participant_,
            [this](const NavState& state, const bus::SampleInfo&) {
              const std::lock_guard lock(mutex_);
              aligned_ = state.alignment == AlignmentPhase::aligned;
              latencies_us_.push_back(1e-3 * static_cast<double>(clock_.utc_ns() - state.header.received_ns));
            }),
        services_(participant_, [this](const ServiceStatus& status, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          if (status.header.sensor == Name("fusion")) fusion_ = static_cast<pid_t>(status.pid);
        }) {}

  [[nodiscard]] bool aligned() const {
    const std::lock_guard lock(mutex_);
    return aligned_;
  }
  [[nodiscard]] pid_t fusion() const {
    const std::lock_guard lock(mutex_);
    return fusion_;
  }
  [[nodiscard]] std::vector<double> take_latencies_us() {
    const std::lock_guard lock(mutex_);
    return std::exchange(latencies_us_, {});
  }

 private:
  static bus::ParticipantOptions options() {
    bus::ParticipantOptions out;
    out.name = "latency_bench";
    out.domain = kDomain;
    out.profiles_dir = std::string(FATHOM_SOURCE_DIR) + "/deploy/dds";
    return out;
  }
  SystemClock clock_;
  mutable std::mutex mutex_;
  bool aligned_ = false;
  pid_t fusion_ = -1;
  std::vector<double> latencies_us_;
  bus::Participant participant_;
  bus::Reader<NavState> states_;
  bus::Reader<ServiceStatus> services_;
};

/// On the wire: an inertial sample, and a navigation state.
struct Sizes {
  std::size_t imu = 0;
  std::size_t nav = 0;
};
Sizes sizes() {
  ImuSample imu;
  imu.header.vehicle = "auv";
  imu.header.sensor = "imu";
  NavState nav;
  nav.header.vehicle = "auv";
  nav.header.sensor = "fusion";
  return {bus::to_cdr(imu).size(), bus::to_cdr(nav).size()};
}

void measure(double rate_hz, double seconds, bool with_limits) {
  const TemporaryFolder folder;
  Process demo("fathom-demo", {"--scenario", survey_at(rate_hz, folder), "--domain", std::to_string(kDomain),
                               "--duration", "600"});
  Guidance guidance;  // before the hops, which take the number of a participant that is left
  RawHops raw(sizes().imu, sizes().nav);
  ASSERT_TRUE(
      wait_until([&] { return guidance.aligned() && guidance.fusion() > 0 && raw.matched(); }, kPatienceS))
      << demo.err();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  (void)guidance.take_latencies_us();
  (void)raw.take_round_us();
  const double before_s = processor_s(guidance.fusion());
  const auto begin = std::chrono::steady_clock::now();
  auto next = begin;
  while (next - begin < std::chrono::duration<double>(seconds)) {
    raw.send();
    next += std::chrono::nanoseconds(from_seconds(1.0 / rate_hz));
    std::this_thread::sleep_until(next);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double used_s = processor_s(guidance.fusion()) - before_s;
  const double memory_MB = resident_MB(guidance.fusion());
  const auto states_us = guidance.take_latencies_us();
  const auto rounds_us = raw.take_round_us();
  demo.kill(SIGINT);
  (void)demo.wait();
  const auto expected = static_cast<std::size_t>(0.9 * rate_hz * seconds);
  ASSERT_GE(states_us.size(), expected);
  ASSERT_GE(rounds_us.size(), expected);
  const double processor = used_s / took.count();
  std::printf(
      "%6.0f Hz  state p50 %4.0f us  p99 %5.0f us   raw hops (%zu and %zu bytes) p50 %4.0f us  p99 %5.0f us  "
      " "
      "ratio p50 %.2f  p99 %.2f   fusion %.1f %% of a core, %.0f MB resident\n",
      rate_hz, percentile(states_us, 0.5), percentile(states_us, 0.99), sizes().imu, sizes().nav,
      percentile(rounds_us, 0.5), percentile(rounds_us, 0.99),
      percentile(states_us, 0.5) / percentile(rounds_us, 0.5),
      percentile(states_us, 0.99) / percentile(rounds_us, 0.99), 100.0 * processor, memory_MB);
  if (!with_limits) return;
  EXPECT_LE(percentile(states_us, 0.5), 1.35 * percentile(rounds_us, 0.5));
  EXPECT_LE(percentile(states_us, 0.99), 2.0 * percentile(rounds_us, 0.99));
  EXPECT_LE(processor, 0.15);
  EXPECT_LE(memory_MB, 60.0);
}

TEST(LatencyBench, FromAnInertialSampleToTheNavigationState) {
  const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
  const Relay relay(sizes().imu, sizes().nav);  // first of all: it is forked from a process without threads
  for (const double rate_hz : {100.0, 400.0}) measure(rate_hz, soak ? 60.0 : 3.0, soak);
}

}  // namespace
}  // namespace fathom::test
