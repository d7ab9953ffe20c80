// Every door beside a navigating vehicle: the monitor sees it come, die and come back, and navigation and the
// other doors do not notice.

#include <atomic>
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support/free_port.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"
#include "unit/ros2/state.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 227;
constexpr std::uint32_t kGraph = 228;

std::vector<std::string> arguments(const std::string& service, std::vector<std::string> sets) {
  sets.insert(sets.end(), {"bus.domain=" + std::to_string(kDomain),
                           "bus.profiles_dir=" + source_dir() + "/deploy/dds", "clock.anchor_file="});
  std::vector<std::string> out{"--config", source_dir() + "/deploy/config/" + service + ".json"};
  for (const std::string& set : sets) out.insert(out.end(), {"--set", set});
  return out;
}

/// Says where it is a hundred times a second, and hears itself as guidance would.
class Vehicle {
 public:
  Vehicle()
      : speaks_(presence(kDomain, "fusion")),
        hears_(presence(kDomain, "guidance")),
        states_(speaks_),
        reader_(hears_, [this](const NavState& state, const bus::SampleInfo&) {
          if (last_ != 0 && state.header.sequence != last_ + 1) ++gaps_;
          last_ = state.header.sequence;
        }) {
    thread_ = std::thread([this] { run(); });
  }
  ~Vehicle() {
    stop_ = true;
    thread_.join();
  }
  [[nodiscard]] int gaps() const { return gaps_; }
  [[nodiscard]] std::uint64_t heard() const { return last_; }

 private:
  void run() {
    auto next = std::chrono::steady_clock::now();
    NavState state = ros2::test::state_at({0.6, 0.1, -3.0});
    while (!stop_) {
      const TimeNs now_ns = clock_.utc_ns();
      state.header = {"auv", "fusion", now_ns, now_ns, state.header.sequence + 1};
      states_.write(state);
      std::this_thread::sleep_until(next += std::chrono::milliseconds(10));
    }
  }

  SystemClock clock_;
  std::atomic<std::uint64_t> last_ = 0;
  std::atomic<int> gaps_ = 0;
  std::atomic<bool> stop_ = false;
  bus::Participant speaks_;
  bus::Participant hears_;
  bus::Writer<NavState> states_;
  bus::Reader<NavState> reader_;
  std::thread thread_;
};

/// What the monitor says of a service.
class Watch {
 public:
  Watch()
      : participant_(presence(kDomain, "console")),
        reader_(participant_, [this](const MonitorStatus& status, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          for (const WatchedItem& one : status.services) presence_[one.name.str()] = one.presence;
        }) {}
  bool becomes(const std::string& service, Presence wanted) {
    return wait_until(
        [&] {
          const std::lock_guard lock(mutex_);
          const auto at = presence_.find(service);
          return at != presence_.end() && at->second == wanted;
        },
        30.0);
  }
  bool is(const std::string& service, Presence wanted) {
    const std::lock_guard lock(mutex_);
    return presence_[service] == wanted;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, Presence> presence_;
  bus::Participant participant_;
  bus::Reader<MonitorStatus> reader_;
};

TEST(Doors, MayDieAndComeBackWithoutHarm) {
  struct Door {
    std::string service;
    std::string program;
    std::vector<std::string> sets;
  };
  const std::vector<Door> doors{
      {"ros2_gateway", "fathom-ros2-gateway", {"ros.domain=" + std::to_string(kGraph)}},
      {"nmea_out",
       "fathom-nmea-out",
       {R"(outputs=[{"type":"tcp_server","address":"127.0.0.1","port":)" +
        std::to_string(free_port(SOCK_STREAM)) + "}]"}},
      {"mavlink_gateway", "fathom-mavlink-gateway", {"link.port=" + std::to_string(free_port(SOCK_DGRAM))}},
      {"foxglove", "fathom-foxglove", {"port=" + std::to_string(free_port(SOCK_STREAM))}}};
  const Process monitor(
      "fathom-monitor",
      arguments("monitor",
                {"metrics.enabled=false", "journal.path=",
                 R"(services=[{"name":"ros2_gateway"},{"name":"nmea_out"},{"name":"mavlink_gateway"},)"
                 R"({"name":"foxglove"}])"}));
  const auto start = [](const Door& door) {
    return std::make_unique<Process>(door.program, arguments(door.service, door.sets));
  };
  Vehicle vehicle;
  Watch watch;
  std::map<std::string, std::unique_ptr<Process>> running;
  for (const Door& door : doors) running[door.service] = start(door);
  for (const Door& door : doors)
    ASSERT_TRUE(watch.becomes(door.service, Presence::present))
        << running[door.service]->err() << monitor.err();
  for (const Door& door : doors) {
    Process& process = *running[door.service];
    process.kill(SIGKILL);
    (void)process.wait();
    ASSERT_TRUE(watch.becomes(door.service, Presence::missing)) << door.service;
    for (const Door& other : doors) {
      if (other.service == door.service) continue;
      EXPECT_TRUE(watch.is(other.service, Presence::present)) << other.service << " beside " << door.service;
    }
    running[door.service] = start(door);
    ASSERT_TRUE(watch.becomes(door.service, Presence::present)) << running[door.service]->err();
  }
  EXPECT_GT(vehicle.heard(), 500U);
  EXPECT_EQ(vehicle.gaps(), 0) << "of what guidance hears";
  for (const Door& door : doors) {
    Process& process = *running[door.service];
    process.kill(SIGTERM);
    EXPECT_EQ(process.wait(), 0) << process.err();
  }
}

TEST(Foxglove, ATlsFileThatIsAPipeIsNotWaitedFor) {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path() / "key").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);  // nobody ever writes into it
  std::vector<std::string> all =
      arguments("foxglove", {"tls.certificate_file=" + source_dir() + "/README.md", "tls.key_file=" + pipe});
  all.emplace_back("--check");
  Process process("fathom-foxglove", all);
  EXPECT_EQ(process.wait(), 2);
  EXPECT_NE(
      process.err().find("tls.key_file: is \"" + pipe + "\", expected a file that can be read; it is a pipe"),
      std::string::npos)
      << process.err();
}

}  // namespace
}  // namespace fathom::test
