// From an inertial sample's publication to the navigation state at a subscriber, with every service of the
// survey running, beside two hops of as many bytes over Fast DDS alone, at the same time on the same machine:
// with one reader a hop, and with as many as the services' topics have. A hop to several readers is as many
// datagrams one after the other, and as many processes woken. Beside it the same from the arrival of the
// sample's bytes at the bridge, which has to decode them. Prints a table. FATHOM_SOAK=1: for a minute at each
// rate, with limits.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "bench/latency/raw_hops.hpp"
#include "bus/cdr.hpp"
#include "bus/network_map.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
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

/// The survey with another inertial rate, as a file.
std::string survey_at(double rate_hz, const TemporaryFolder& folder) {
  std::ifstream file(source_dir() + "/deploy/config/scenarios/survey.json");
  auto scenario = nlohmann::json::parse(file);
  scenario["sensors"]["imu"]["rate_hz"] = rate_hz;
  const std::string path = folder / "survey.json";
  std::ofstream(path) << scenario.dump(2);
  return path;
}

/// When each inertial sample was published, by its arrival at the bridge, which is in the state made of it.
class Publications {
 public:
  Publications()
      : participant_(options()),
        samples_(participant_, [this](const ImuSample& sample, const bus::SampleInfo& info) {
          const std::lock_guard lock(mutex_);
          published_ns_[sample.header.received_ns] = info.source_ns;
        }) {}

  [[nodiscard]] std::map<TimeNs, TimeNs> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(published_ns_, {});
  }

 private:
  static bus::ParticipantOptions options() {
    auto out = presence(kDomain, "latency_bench_publications");
    out.low_priority = true;
    return out;
  }
  std::mutex mutex_;
  std::map<TimeNs, TimeNs> published_ns_;
  bus::Participant participant_;
  bus::Reader<ImuSample> samples_;
};

/// A state that came.
struct Heard {
  TimeNs received_ns;  ///< its newest inertial sample, at the bridge
  TimeNs here_ns;
};

class Guidance {
 public:
  Guidance()
      : participant_(presence(kDomain, "latency_bench")),
        states_(participant_,
                [this](const NavState& state, const bus::SampleInfo&) {
                  const TimeNs here_ns = clock_.utc_ns();
                  const std::lock_guard lock(mutex_);
                  aligned_ = state.alignment == AlignmentPhase::aligned;
                  heard_.push_back({state.header.received_ns, here_ns});
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
  /// As discovery knows them, those of this program among them.
  [[nodiscard]] int readers_of(const std::string& topic) {
    const auto all = bus::endpoints(participant_);
    return static_cast<int>(std::count_if(all.begin(), all.end(), [&](const bus::NetworkEndpoint& one) {
      return !one.writes && one.topic == topic;
    }));
  }
  [[nodiscard]] std::vector<Heard> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(heard_, {});
  }

 private:
  SystemClock clock_;
  mutable std::mutex mutex_;
  bool aligned_ = false;
  pid_t fusion_ = -1;
  std::vector<Heard> heard_;
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

/// Of the topics on the way, as a run of the survey with this program has them.
constexpr int kImuReaders = 4;
constexpr int kNavReaders = 6;

/// Raw samples come a little faster than inertial ones, so that the two do not meet, or miss, each other all
/// the time.
constexpr double kDrift = 1.013;

/// Taken by turns, a second each, while the services run all the time; a hop is compared with the states of
/// the same seconds.
struct Raw {
  RawHops one{"one", {sizes().imu}, {sizes().nav}};
  RawHops several{"several", {sizes().imu, kImuReaders}, {sizes().nav, kNavReaders}};
};

struct Latencies {
  std::vector<double> since_publication_us;
  std::vector<double> since_arrival_us;

  void add(const std::vector<Heard>& heard, const std::map<TimeNs, TimeNs>& published_ns) {
    for (const Heard& one : heard) {
      const auto published = published_ns.find(one.received_ns);
      if (published == published_ns.end()) continue;
      since_publication_us.push_back(1e-3 * static_cast<double>(one.here_ns - published->second));
      since_arrival_us.push_back(1e-3 * static_cast<double>(one.here_ns - one.received_ns));
    }
  }
};

struct Figures {
  explicit Figures(const std::vector<double>& us)
      : p50_us(percentile(us, 0.5)), p99_us(percentile(us, 0.99)) {}
  double p50_us;
  double p99_us;
};

void measure(Raw& raw, double rate_hz, int seconds, bool with_limits) {
  const TemporaryFolder folder;
  Process demo("fathom-demo", {"--scenario", survey_at(rate_hz, folder), "--domain", std::to_string(kDomain),
                               "--duration", "600"});
  Guidance guidance;
  Publications publications;
  ASSERT_TRUE(wait_until(
      [&] {
        return guidance.aligned() && guidance.fusion() > 0 && raw.one.matched() && raw.several.matched();
      },
      kPatienceS))
      << demo.err();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_EQ(guidance.readers_of("fathom/v1/imu"), kImuReaders);
  EXPECT_EQ(guidance.readers_of("fathom/v1/nav_state"), kNavReaders);
  (void)publications.take();
  (void)guidance.take();
  (void)raw.one.take_round_us();
  (void)raw.several.take_round_us();
  const double before_s = processor_s(guidance.fusion());
  const auto begin = std::chrono::steady_clock::now();
  const double raw_rate_hz = kDrift * rate_hz;
  Latencies all;
  Latencies beside_one;
  Latencies beside_several;
  for (int second = 1; second <= seconds; ++second) {
    const bool one = second % 2 == 1;
    raw.one.send(one ? raw_rate_hz : 0.0);
    raw.several.send(one ? 0.0 : raw_rate_hz);
    std::this_thread::sleep_until(begin + std::chrono::seconds(second));
    const auto heard = guidance.take();
    const auto published_ns = publications.take();
    all.add(heard, published_ns);
    (one ? beside_one : beside_several).add(heard, published_ns);
  }
  raw.several.send(0.0);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double used_s = processor_s(guidance.fusion()) - before_s;
  const double memory_MB = resident_MB(guidance.fusion());
  const auto one_us = raw.one.take_round_us();
  const auto several_us = raw.several.take_round_us();
  demo.kill(SIGINT);
  (void)demo.wait();
  const auto expected = static_cast<std::size_t>(0.9 * rate_hz * seconds);
  ASSERT_GE(all.since_publication_us.size(), expected);
  ASSERT_GE(one_us.size(), expected / 2);
  ASSERT_GE(several_us.size(), expected / 2);
  const Figures state(all.since_publication_us);
  const Figures whole(all.since_arrival_us);
  const double processor = used_s / took.count();
  std::printf(
      "%.0f Hz, %zu and %zu bytes: state p50 %.0f us, p99 %.0f us; fusion %.1f %% of a core, %.0f MB "
      "resident\n  from the arrival at the bridge: p50 %.0f us, p99 %.0f us\n",
      rate_hz, sizes().imu, sizes().nav, state.p50_us, state.p99_us, 100.0 * processor, memory_MB,
      whole.p50_us, whole.p99_us);
  const auto beside = [&](const char* what, const Figures& hops, const Figures& then) {
    std::printf("  raw hops, %s: p50 %.0f us, p99 %.0f us; ratio p50 %.2f, p99 %.2f\n", what, hops.p50_us,
                hops.p99_us, then.p50_us / hops.p50_us, then.p99_us / hops.p99_us);
  };
  const Figures state_beside_one(beside_one.since_publication_us);
  beside("one reader each", Figures(one_us), state_beside_one);
  beside("readers as many", Figures(several_us), Figures(beside_several.since_publication_us));
  if (!with_limits) return;
  EXPECT_LE(state_beside_one.p50_us, 1.35 * Figures(one_us).p50_us);
  EXPECT_LE(state_beside_one.p99_us, 2.0 * Figures(one_us).p99_us);
  EXPECT_LE(processor, 0.15);
  EXPECT_LE(memory_MB, 60.0);
}

TEST(LatencyBench, FromAnInertialSampleToTheNavigationState) {
  const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
  Raw raw;  // first of all: it forks, and this process has no threads yet
  for (const double rate_hz : {100.0, 400.0}) measure(raw, rate_hz, soak ? 60 : 4, soak);
}

}  // namespace
}  // namespace fathom::test
