// What guidance software sees of the navigation state, as text for a script: each gap longer than --gap, each
// change of the source with the step in position that came with it, and once a second the error.
// With --latencies FILE each state's as well: monotonic time, seconds from the arrival of its inertial sample
// at the bridge, where both clocks are this host's. Usage: soak_nav_watch --domain N --interface ADDRESS
// --peer ADDRESS ... --gap SECONDS

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>
#include <fathom/client.hpp>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "geo/wgs84.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/truth.hpp"

namespace {

using namespace fathom;

std::atomic<bool> over{false};

/// North, east, down from `a` to `b`, near each other.
std::array<double, 3> apart_m(const NavState& a, double latitude_rad, double longitude_rad,
                              double altitude_m) {
  const geo::Radii radii = geo::radii(a.latitude_rad);
  return {(latitude_rad - a.latitude_rad) * (radii.meridian_m + a.altitude_m),
          (longitude_rad - a.longitude_rad) * (radii.normal_m + a.altitude_m) * std::cos(a.latitude_rad),
          a.altitude_m - altitude_m};
}

class Watch {
 public:
  Watch(double gap_s, const std::string& latencies) : gap_s_(gap_s) {
    if (!latencies.empty()) latencies_.open(latencies);
  }

  void on_state(const NavState& state) {
    const std::lock_guard lock(mutex_);
    const TimeNs now_ns = clock_.monotonic_ns();
    if (latencies_.is_open()) {
      latencies_ << std::setprecision(12) << 1e-9 * static_cast<double>(now_ns) << ' '
                 << to_seconds(clock_.utc_ns() - state.header.received_ns) << '\n';
    }
    if (last_) {
      const double gap_s = to_seconds(now_ns - arrived_ns_);
      if (gap_s > gap_s_) say("gap %.3f s", gap_s);
      if (state.header.sensor != last_->header.sensor) say_source(state, gap_s);
      if (state.header.stamp_ns < last_->header.stamp_ns) {
        say("backwards %.3f s", to_seconds(last_->header.stamp_ns - state.header.stamp_ns));
      }
    } else {
      say("first from %s", state.header.sensor.c_str());
    }
    ++states_;
    last_ = state;
    arrived_ns_ = now_ns;
  }

  void on_truth(const Truth& truth) {
    const std::lock_guard lock(mutex_);
    if (!last_) return;
    const double dt_s = to_seconds(truth.header.stamp_ns - last_->header.stamp_ns);
    if (std::abs(dt_s) > 0.2) return;
    auto error = apart_m(*last_, truth.latitude_rad, truth.longitude_rad, truth.altitude_m);
    for (std::size_t i = 0; i < 2; ++i) error[i] -= truth.velocity_N_m_s[i] * dt_s;
    error_m_ = std::hypot(error[0], error[1]);
  }

  void on_service(const ServiceStatus& status) {
    const std::lock_guard lock(mutex_);
    services_[status.header.sensor.str()] = {status.state, clock_.monotonic_ns()};
  }

  void each_second() {
    const std::lock_guard lock(mutex_);
    const double age_s = last_ ? to_seconds(clock_.monotonic_ns() - arrived_ns_) : kUnknown;
    const double sigma_m =
        last_ ? std::sqrt(last_->position_covariance_N_m2[0] + last_->position_covariance_N_m2[4]) : kUnknown;
    std::string unwell;
    for (const auto& [name, heard] : services_) {
      const bool silent = clock_.monotonic_ns() - heard.second > 3 * kNsPerSecond;
      if (silent || heard.first != ServiceState::healthy) unwell += (unwell.empty() ? "" : ",") + name;
    }
    say("state %s age %.3f s rate %d error %.2f m sigma %.2f m resets %u mode %s services %zu unwell %s",
        last_ ? last_->header.sensor.c_str() : "nobody", age_s, states_ - said_states_, error_m_, sigma_m,
        last_ ? last_->reset_counter : 0U, last_ ? std::string(to_string(last_->mode)).c_str() : "none",
        services_.size(), unwell.empty() ? "none" : unwell.c_str());
    said_states_ = states_;
  }

 private:
  void say_source(const NavState& state, double gap_s) {
    const double dt_s = to_seconds(state.header.stamp_ns - last_->header.stamp_ns);
    auto step = apart_m(*last_, state.latitude_rad, state.longitude_rad, state.altitude_m);
    for (std::size_t i = 0; i < 3; ++i) {
      step[i] -= 0.5 * (last_->velocity_N_m_s[i] + state.velocity_N_m_s[i]) * dt_s;
    }
    say("source %s to %s gap %.3f s step %.2f mm", last_->header.sensor.c_str(), state.header.sensor.c_str(),
        gap_s, 1e3 * std::hypot(step[0], step[1], step[2]));
  }

  template <class... Values>
  void say(const char* format, Values... values) {
    std::printf("%.3f ", 1e-9 * static_cast<double>(clock_.monotonic_ns()));
    if constexpr (sizeof...(values) == 0) {
      std::fputs(format, stdout);
    } else {
      std::printf(format, values...);  // NOLINT(cppcoreguidelines-pro-type-vararg)
    }
    std::printf("\n");
    std::fflush(stdout);
  }

  const double gap_s_;
  std::ofstream latencies_;
  SystemClock clock_;
  std::mutex mutex_;
  std::optional<NavState> last_;
  TimeNs arrived_ns_ = 0;
  int states_ = 0;
  int said_states_ = 0;
  double error_m_ = kUnknown;
  std::map<std::string, std::pair<ServiceState, TimeNs>> services_;
};

}  // namespace

int main(int argc, char** argv) {
  bus::ParticipantOptions options;
  options.name = "nav_watch";
  double gap_s = 0.1;
  std::string latencies;
  CLI::App app{"Watches the navigation state"};
  app.add_option("--domain", options.domain);
  app.add_option("--interface", options.interfaces);
  app.add_option("--peer", options.peers);
  app.add_option("--gap", gap_s);
  app.add_option("--latencies", latencies);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGTERM, [](int) { over = true; });
  std::signal(SIGINT, [](int) { over = true; });
  Watch watch(gap_s, latencies);
  bus::Participant participant(options);
  ClientOptions as_guidance;
  as_guidance.domain = options.domain;
  as_guidance.name = options.name;
  as_guidance.interfaces = options.interfaces;
  as_guidance.peers = options.peers;
  Client client(as_guidance);
  client.on_nav_state([&](const NavState& state) { watch.on_state(state); });
  const bus::Reader<Truth> truths(participant,
                                  [&](const Truth& truth, const bus::SampleInfo&) { watch.on_truth(truth); });
  const bus::Reader<ServiceStatus> services(
      participant, [&](const ServiceStatus& status, const bus::SampleInfo&) { watch.on_service(status); });
  while (!over) {
    for (int i = 0; i < 10 && !over; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    watch.each_second();
  }
  return 0;
}
