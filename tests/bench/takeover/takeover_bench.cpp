// A vehicle with two fusion services under way; the one that leads is killed again and again. Prints what
// guidance sees of it: the gap in time and the step in position, also beside what an engine in this program
// makes of the same samples without any interruption: a fix that falls into the gap moves both.
// FATHOM_SOAK=1: a hundred times, with limits.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/service_config.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "guidance.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/status/replication.hpp"
#include "samples/usbl.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

/// Hears what the fusion services hear, and nobody kills it: an engine of their configuration.
class Witness {
 public:
  Witness()
      : engine_(config::engine_config(configuration())),
        participant_(options()),
        gps_(participant_, tell<GpsSample>()),
        dvl_(participant_, tell<DvlSample>()),
        depth_(participant_, tell<DepthSample>()),
        heading_(participant_, tell<HeadingSample>()),
        usbl_(participant_, tell<UsblSample>()),
        airspeed_(participant_, tell<AirspeedSample>()),
        propulsion_(participant_, tell<PropulsionSample>()),
        fins_(participant_, tell<FinsSample>()),
        imu_(participant_, [this](const ImuSample& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          if (engine_.add(sample)) states_[sample.header.stamp_ns] = engine_.nav_state();
          while (states_.size() > kKept) states_.erase(states_.begin());
          for (Verdict verdict; engine_.next_verdict(verdict);) continue;
        }) {}

  [[nodiscard]] std::optional<NavState> at(TimeNs stamp_ns) const {
    const std::lock_guard lock(mutex_);
    const auto found = states_.find(stamp_ns);
    return found == states_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  static constexpr std::size_t kKept = 3000;

  static config::FusionConfig configuration() {
    return config::load_service_config<config::FusionConfig>(
               {source_dir() + "/deploy/config/fusion.json", {"engine.imu.nominal_rate_hz=100.0"}})
        .value;
  }
  static bus::ParticipantOptions options() {
    auto out = presence(kDomain, "takeover_bench_witness");
    out.low_priority = true;
    return out;
  }
  template <class T>
  typename bus::Reader<T>::Handler tell() {
    return [this](const T& sample, const bus::SampleInfo&) {
      const std::lock_guard lock(mutex_);
      engine_.add(sample);
    };
  }

  mutable std::mutex mutex_;
  estimation::FusionEngine engine_;
  std::map<TimeNs, NavState> states_;
  bus::Participant participant_;
  bus::Reader<GpsSample> gps_;
  bus::Reader<DvlSample> dvl_;
  bus::Reader<DepthSample> depth_;
  bus::Reader<HeadingSample> heading_;
  bus::Reader<UsblSample> usbl_;
  bus::Reader<AirspeedSample> airspeed_;
  bus::Reader<PropulsionSample> propulsion_;
  bus::Reader<FinsSample> fins_;
  bus::Reader<ImuSample> imu_;
};

/// From `from` to `to`: north, east, down, metres.
std::array<double, 3> between_m(const NavState& from, const NavState& to) {
  const geo::Radii radii = geo::radii(from.latitude_rad);
  return {(to.latitude_rad - from.latitude_rad) * (radii.meridian_m + from.altitude_m),
          (to.longitude_rad - from.longitude_rad) * (radii.normal_m + from.altitude_m) *
              std::cos(from.latitude_rad),
          from.altitude_m - to.altitude_m};
}

/// How much more the position moved from `before` to `after` than that of the engine that went on; nothing
/// where that has no state of one of the two instants.
std::optional<double> step_beside_m(const Witness& witness, const NavState& before, const NavState& after) {
  const auto first = witness.at(before.header.stamp_ns);
  const auto second = witness.at(after.header.stamp_ns);
  if (!first || !second) return std::nullopt;
  const auto a = between_m(*first, before);
  const auto b = between_m(*second, after);
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

/// How far `after` is from where `before` leads to at the mean of their velocities.
double step_m(const NavState& before, const NavState& after) {
  const double dt_s = to_seconds(after.header.stamp_ns - before.header.stamp_ns);
  auto step_m = between_m(before, after);
  for (std::size_t axis = 0; axis < step_m.size(); ++axis)
    step_m[axis] -= 0.5 * (before.velocity_N_m_s[axis] + after.velocity_N_m_s[axis]) * dt_s;
  return std::hypot(step_m[0], step_m[1], step_m[2]);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

TEST(Takeover, OfALeaderThatIsKilled) {
  const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
  const std::size_t times = soak ? 100 : 3;
  Guidance guidance;
  std::optional<Process> demo;
  std::optional<Witness> witness;
  std::vector<double> gaps_ms;
  std::vector<double> steps_mm;
  std::vector<double> beside_mm;
  std::vector<double> ordinary_mm;
  while (gaps_ms.size() < times) {
    ASSERT_TRUE(wait_until(
        [&] {
          return under_way(guidance, demo, soak, {"--standby"}, [&] {
            witness.reset();
            witness.emplace();
          });
        },
        3.0 * kPatienceS));
    const TimeNs since_ns = SystemClock().utc_ns();
    if (!wait_until([&] { return guidance.both_in_step(since_ns); }, kPatienceS)) {
      ASSERT_FALSE(demo->running()) << "not in step again";
      continue;
    }
    const NavState before = *guidance.newest();
    const std::string leader = before.header.sensor.str();
    const pid_t pid = guidance.pid(leader);
    ASSERT_GT(pid, 0);
    const std::size_t from = guidance.count() - 1;
    ASSERT_EQ(::kill(pid, SIGKILL), 0);
    const bool taken = wait_until(
        [&] {
          const auto newest = guidance.newest();
          return newest->header.sensor != Name(leader) || !demo->running();
        },
        10.0);
    if (!demo->running()) continue;
    ASSERT_TRUE(taken) << "nobody took over";
    // Half a second more: what an ordinary step is.
    const std::size_t taken_at = guidance.count();
    ASSERT_TRUE(wait_until([&] { return guidance.count() > taken_at + 50; }, kPatienceS));
    const auto heard = guidance.since(from);
    std::size_t first = 1;
    while (heard[first].state.header.sensor == Name(leader)) ++first;
    gaps_ms.push_back(1e3 * to_seconds(heard[first].arrived_ns - heard[first - 1].arrived_ns));
    steps_mm.push_back(1e3 * step_m(heard[first - 1].state, heard[first].state));
    const auto beside_m = step_beside_m(*witness, heard[first - 1].state, heard[first].state);
    ASSERT_TRUE(beside_m.has_value());
    beside_mm.push_back(1e3 * *beside_m);
    for (std::size_t i = first + 5; i + 5 < heard.size(); i += 5) {
      ordinary_mm.push_back(1e3 * step_m(heard[i].state, heard[i + 5].state));
    }
    if (soak) {
      EXPECT_EQ(heard[first].state.reset_counter, before.reset_counter);
    }
    // The life sign of the one that was started again has to be the newest.
    ASSERT_TRUE(wait_until([&] { return guidance.pid(leader) != pid || !demo->running(); }, kPatienceS));
  }
  std::printf("takeovers %zu, of them unprepared %llu\n", times,
              static_cast<unsigned long long>(guidance.unprepared()));
  std::printf("gap at guidance: median %.1f ms, 95 %% %.1f ms, max %.1f ms\n", quantile(gaps_ms, 0.5),
              quantile(gaps_ms, 0.95), quantile(gaps_ms, 1.0));
  std::printf(
      "step of the position: median %.3f mm, 95 %% %.3f mm, max %.3f mm; "
      "over 50 ms without a takeover: median %.3f mm, 95 %% %.3f mm, max %.3f mm\n",
      quantile(steps_mm, 0.5), quantile(steps_mm, 0.95), quantile(steps_mm, 1.0), quantile(ordinary_mm, 0.5),
      quantile(ordinary_mm, 0.95), quantile(ordinary_mm, 1.0));
  std::printf(
      "the same beside an engine that was not interrupted: median %.4f mm, 95 %% %.4f mm, max %.4f mm\n",
      quantile(beside_mm, 0.5), quantile(beside_mm, 0.95), quantile(beside_mm, 1.0));
  // What follows takes a machine that is not busy with other things.
  if (!soak) return;
  EXPECT_LE(quantile(beside_mm, 1.0), 1.0);
  EXPECT_EQ(guidance.unprepared(), 0U);
  EXPECT_LE(quantile(gaps_ms, 0.5), 40.0);
  EXPECT_LE(quantile(gaps_ms, 1.0), 100.0);
}

/// When a process began, by the clock that counts from the start of the machine; seconds, to 10 ms.
double began_s(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 19; ++i) fields >> skipped;
  double ticks = 0.0;
  fields >> ticks;
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double since_boot_s() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TEST(Restart, OfTheOnlyFusion) {
  const bool soak = std::getenv("FATHOM_SOAK") != nullptr;
  const std::size_t times = soak ? 30 : 1;
  Guidance guidance;
  std::optional<Process> demo;
  std::vector<double> first_ms;
  std::vector<double> gaps_s;
  std::vector<double> steps_sigma;
  while (first_ms.size() < times) {
    ASSERT_TRUE(wait_until([&] { return under_way(guidance, demo, soak, {}, [] {}); }, 3.0 * kPatienceS));
    // Long enough for a checkpoint, and for what the killed one said to be over.
    const std::size_t calm = guidance.count();
    ASSERT_TRUE(wait_until([&] { return guidance.count() > calm + 300; }, kPatienceS));
    const pid_t pid = guidance.pid("fusion");
    ASSERT_GT(pid, 0);
    const std::size_t from = guidance.count() - 1;
    ASSERT_EQ(::kill(pid, SIGKILL), 0);
    const double boot_minus_steady_s = since_boot_s() - to_seconds(SystemClock().monotonic_ns());
    if (!wait_until([&] { return guidance.pid("fusion") != pid || !demo->running(); }, kPatienceS))
      FAIL() << "not started again";
    if (!demo->running()) continue;
    const double start_s = began_s(guidance.pid("fusion"));
    const auto heard = guidance.since(from);
    std::size_t first = 1;
    while (first < heard.size() && to_seconds(heard[first].arrived_ns) + boot_minus_steady_s < start_s)
      ++first;
    if (first == heard.size()) continue;
    const NavState& after = heard[first].state;
    first_ms.push_back(1e3 * (to_seconds(heard[first].arrived_ns) + boot_minus_steady_s - start_s));
    gaps_s.push_back(to_seconds(heard[first].arrived_ns - heard[first - 1].arrived_ns));
    const double sigma_m = std::sqrt(after.position_covariance_N_m2[0] + after.position_covariance_N_m2[4]);
    steps_sigma.push_back(step_m(heard[first - 1].state, after) / sigma_m);
    // Aligned, or as good as: what is not known any more is a little of the heading.
    EXPECT_GE(after.alignment, AlignmentPhase::fine);
    EXPECT_LE(after.alignment, AlignmentPhase::aligned);
    EXPECT_GT(after.mode, NavMode::aligning);
    EXPECT_LT(steps_sigma.back(), 3.0);
  }
  std::printf("restarts of the only fusion %zu\n", times);
  std::printf(
      "from the start of the process to the first state at guidance: median %.0f ms, max %.0f ms; "
      "without navigation: median %.2f s, max %.2f s\n",
      quantile(first_ms, 0.5), quantile(first_ms, 1.0), quantile(gaps_s, 0.5), quantile(gaps_s, 1.0));
  std::printf("step of the position: median %.2f sigma, max %.2f sigma\n", quantile(steps_sigma, 0.5),
              quantile(steps_sigma, 1.0));
  if (!soak) return;
  EXPECT_LE(quantile(first_ms, 1.0), 500.0);
}

}  // namespace
}  // namespace fathom::test
