#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "base/units.hpp"
#include "bus/writer.hpp"
#include "integration/ros2/peer.hpp"
#include "samples/nav_state.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "unit/ros2/state.hpp"

/// The gateway as a process, and the vehicle on its other side.
namespace fathom::test {

constexpr std::uint32_t kVehicle = 73;
constexpr std::uint32_t kGraph = 74;
inline const geo::Geodetic kOrigin{36.4 * kRadPerDeg, -121.5 * kRadPerDeg, -3.0};

inline std::vector<std::string> arguments(std::vector<std::string> sets = {}) {
  std::vector<std::string> out{"--config", source_dir() + "/deploy/config/ros2_gateway.json"};
  const std::string number = std::to_string(kVehicle);
  for (const std::string& set : {"bus.domain=" + number, "bus.profiles_dir=" + source_dir() + "/deploy/dds",
                                 "ros.domain=" + std::to_string(kGraph), std::string("clock.anchor_file=")}) {
    sets.insert(sets.begin(), set);
  }
  for (const std::string& set : sets) {
    out.push_back("--set");
    out.push_back(set);
  }
  return out;
}

/// A vehicle that navigates at 100 Hz, 1 m/s to the north; what of it is said can be changed on the way.
class Navigating {
 public:
  Navigating() : participant_(presence(kVehicle, "navigating")), writer_(participant_, options()) {
    thread_ = std::thread([this] { run(); });
  }
  ~Navigating() {
    done_ = true;
    thread_.join();
  }
  bus::Participant& participant() { return participant_; }
  [[nodiscard]] bool heard() const { return writer_.matched_readers() > 0; }
  /// A step of the position that is not motion.
  void step(double north_m) {
    const std::lock_guard lock(mutex_);
    offset_m_ += north_m;
    ++resets_;
  }
  /// Says what was valid `seconds` ago, as a service that is behind does.
  void lag(double seconds) {
    const std::lock_guard lock(mutex_);
    lag_ns_ = from_seconds(seconds);
  }

 private:
  static bus::WriterOptions options() {
    bus::WriterOptions out;
    out.ownership_strength = 10;
    return out;
  }
  void run() {
    auto next = std::chrono::steady_clock::now();
    const TimeNs begin_ns = clock_.utc_ns();
    for (std::uint64_t number = 1; !done_; ++number) {
      NavState state;
      {
        const std::lock_guard lock(mutex_);
        const TimeNs stamp_ns = clock_.utc_ns() - lag_ns_;
        const double north_m = to_seconds(stamp_ns - begin_ns) + offset_m_;
        state = ros2::test::state_at(geo::moved_by(kOrigin, {north_m, 0.0, 0.0}));
        state.header.stamp_ns = stamp_ns;
        state.header.received_ns = stamp_ns;
        state.reset_counter = resets_;
      }
      state.header.sequence = number;
      state.velocity_N_m_s = {1.0, 0.0, 0.0};
      state.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
      writer_.write(state);
      std::this_thread::sleep_until(next += std::chrono::milliseconds(10));
    }
  }

  SystemClock clock_;
  bus::Participant participant_;
  bus::Writer<NavState> writer_;
  std::mutex mutex_;
  double offset_m_ = 0.0;
  std::uint32_t resets_ = 0;
  DurationNs lag_ns_ = 0;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

inline double number(const std::vector<std::string>& words, std::size_t index) {
  return index < words.size() ? std::stod(words[index]) : std::nan("");
}

/// The instant of a message, s before now.
inline double age_s(const std::vector<std::string>& stamp) {
  return to_seconds(SystemClock().utc_ns()) - number(stamp, 0) - 1e-9 * number(stamp, 1);
}

class Ros2Gateway : public ::testing::Test {
 protected:
  void start(std::vector<std::string> sets = {}) {
    gateway = std::make_unique<Process>("fathom-ros2-gateway", arguments(std::move(sets)));
    ASSERT_TRUE(wait_until([&] { return vehicle.heard() || !gateway->running(); }));
    ASSERT_TRUE(gateway->running()) << gateway->err();
  }
  std::map<std::string, std::vector<std::string>> first(const char* type, const char* topic,
                                                        const char* how = nullptr) {
    std::vector<std::string> more{type, topic};
    if (how != nullptr) more.emplace_back(how);
    Peer peer("read", kGraph, more);
    const std::string text = peer.output();
    EXPECT_NE(text, "") << topic << "\n" << gateway->err();
    return said(text);
  }

  Navigating vehicle;
  std::unique_ptr<Process> gateway;
};

}  // namespace fathom::test
