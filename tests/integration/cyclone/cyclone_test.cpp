// Samples pass between fathom's bus and Cyclone DDS unharmed, both ways.

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/alignment_status.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/route.hpp"
#include "support/paths.hpp"

namespace fathom {
namespace {

bus::ParticipantOptions options(std::uint32_t domain) {
  bus::ParticipantOptions options;
  options.name = "cyclone_test";
  options.domain = domain;
  options.profiles_dir = test::source_dir() + "/deploy/dds";
  return options;
}

/// The Cyclone DDS peer as a process whose standard output we read.
class CyclonePeer {
 public:
  CyclonePeer(std::string role, std::uint32_t domain) {
    std::string program = FATHOM_CYCLONE_PEER;
    std::string number = std::to_string(domain);
    std::string uri = "CYCLONEDDS_URI=" FATHOM_CYCLONE_CONFIG;
    std::array<char*, 4> arguments{program.data(), role.data(), number.data(), nullptr};
    std::vector<char*> environment;
    for (char** entry = environ; *entry != nullptr; ++entry) environment.push_back(*entry);
    environment.push_back(uri.data());
    environment.push_back(nullptr);
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    output_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addclosefrom_np(&actions, 3);
    EXPECT_EQ(posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environment.data()),
              0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
  }
  ~CyclonePeer() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    close(output_);
  }
  CyclonePeer(const CyclonePeer&) = delete;
  CyclonePeer& operator=(const CyclonePeer&) = delete;

  /// Everything it prints until it ends.
  std::string output() {
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = read(output_, buffer.data(), buffer.size())) > 0;) text.append(buffer.data(), n);
    return text;
  }

 private:
  pid_t pid_ = -1;
  int output_ = -1;
};

std::string text(double value) {
  std::array<char, 40> buffer{};
  std::snprintf(buffer.data(), buffer.size(), " %.17g", value);
  return buffer.data();
}

template <std::size_t N>
std::string text(const std::array<double, N>& values) {
  std::string all;
  for (const double value : values) all += text(value);
  return all;
}

template <std::size_t N>
void count_up(std::array<double, N>& values, double from) {
  for (double& value : values) value = from += 0.125;
}

/// Publishes `sample` every 10 ms while the peer waits for it; what the peer printed.
template <class T>
std::string as_seen_by_peer(const char* role, std::uint32_t domain, T sample) {
  bus::Participant participant(options(domain));
  bus::Writer<T> writer(participant);
  CyclonePeer peer(role, domain);
  std::atomic<bool> done = false;
  std::thread publisher([&] {
    while (!done) {
      writer.write(sample);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  const std::string output = peer.output();
  done = true;
  publisher.join();
  EXPECT_EQ(participant.counters().incompatible_qos, 0U);
  return output;
}

TEST(Cyclone, ReceivesNavState) {
  NavState s;
  s.header = {"auv", "fusion", 1'700'000'000'000'000'001, 1'700'000'000'000'000'002, 0xF000'0000'0000'0003U};
  s.mode = NavMode::dead_reckoning;
  s.alignment = AlignmentPhase::aligned;
  s.latitude_rad = 0.6352998;
  s.longitude_rad = -2.2236;
  s.altitude_m = -81.25;
  s.depth_m = 99.75;
  count_up(s.velocity_N_m_s, 1);
  count_up(s.q_NB, 2);
  count_up(s.rpy_rad, 3);
  count_up(s.angular_rate_B_rad_s, 4);
  count_up(s.specific_force_B_m_s2, 5);
  count_up(s.position_covariance_N_m2, 6);
  count_up(s.velocity_covariance_N_m2_s2, 8);
  count_up(s.rpy_sigma_rad, 10);
  s.gps_outage_s = 12.5;  // dvl_outage_s stays unknown
  s.reset_counter = 4'000'000'000U;
  count_up(s.last_reset_delta_N_m, 11);

  EXPECT_EQ(
      as_seen_by_peer("nav_state", 130, s),
      "vehicle auv\nsensor fusion\nstamp_ns 1700000000000000001\nreceived_ns 1700000000000000002\n"
      "sequence_number 17293822569102704643\nmode 4\nalignment 5\nlatitude_rad" +
          text(s.latitude_rad) + "\nlongitude_rad" + text(s.longitude_rad) + "\naltitude_m" +
          text(s.altitude_m) + "\ndepth_m" + text(s.depth_m) + "\nvelocity_N_m_s" + text(s.velocity_N_m_s) +
          "\nq_NB" + text(s.q_NB) + "\nrpy_rad" + text(s.rpy_rad) + "\nangular_rate_B_rad_s" +
          text(s.angular_rate_B_rad_s) + "\nspecific_force_B_m_s2" + text(s.specific_force_B_m_s2) +
          "\nposition_covariance_N_m2" + text(s.position_covariance_N_m2) + "\nvelocity_covariance_N_m2_s2" +
          text(s.velocity_covariance_N_m2_s2) + "\nrpy_sigma_rad" + text(s.rpy_sigma_rad) + "\ngps_outage_s" +
          text(s.gps_outage_s) + "\ndvl_outage_s nan\nreset_counter 4000000000\nlast_reset_delta_N_m" +
          text(s.last_reset_delta_N_m) + "\n");
}

TEST(Cyclone, ReceivesListsAndTextOfAlignmentStatus) {
  AlignmentStatus s;
  s.header.vehicle = "auv";
  s.phase = AlignmentPhase::fine;
  s.in_phase_s = 3.5;
  s.condition_count = 2;
  s.conditions[0] = {"pitch_rad", 0.25, 0.5, 1.5, 2.5, true};
  s.conditions[1] = {"rate_rad_s", 0.125, 0.0625, 0, 4, false};
  s.time_to_aligned_s = 42;
  const std::string advice = "turn through a circle";
  std::copy(advice.begin(), advice.end(), s.advice.begin());
  EXPECT_EQ(as_seen_by_peer("alignment", 131, s),
            "vehicle auv\nphase 4\nin_phase_s 3.5\nconditions 2\n"
            "condition pitch_rad 0.25 0.5 1.5 2.5 1\ncondition rate_rad_s 0.125 0.0625 0 4 0\n"
            "rpy_sigma_rad nan nan nan\ntime_to_aligned_s 42\nadvice turn through a circle\n");
}

TEST(Cyclone, ReceivesTheWaypointsOfARoute) {
  Route s;
  s.header.vehicle = "auv";
  s.header.sensor = "guidance";
  s.active = 1;
  s.repeats = true;
  s.first_number = 9;
  s.mission_count = 40;
  s.leg_start_latitude_rad = 0.5;
  s.waypoints = {
      {.name = "A buoy", .latitude_rad = 0.625, .longitude_rad = -2.25, .depth_m = 5, .speed_m_s = 1.5},
      {.latitude_rad = 0.75, .longitude_rad = 2.5}};
  EXPECT_EQ(as_seen_by_peer("route", 133, s),
            "vehicle auv\npublisher guidance\nactive 1\nrepeats 1\nfirst_number 9\nmission_count 40\n"
            "leg_start_latitude_rad 0.5\nleg_start_longitude_rad nan\n"
            "waypoint 'A buoy' 0.625 -2.25 5 1.5\nwaypoint '' 0.75 2.5 nan nan\n");
}

/// What the peer counted, by name.
std::map<std::string, long> counts(const std::string& line) {
  std::map<std::string, long> found;
  std::istringstream words(line);
  std::string name;
  for (long value = 0; words >> name >> value;) found[name] = value;
  return found;
}

/// The peer counts while `writes` samples are written and successors take the writer's place.
template <class T>
std::map<std::string, long> counted_by_peer(const char* role, std::uint32_t domain, std::uint64_t each,
                                            std::chrono::microseconds period, std::uint64_t writes) {
  bus::Participant participant(options(domain));
  bus::WriterOptions followed;
  followed.successor_after = each;
  bus::Writer<T> writer(participant, followed);
  CyclonePeer peer(role, domain);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (writer.matched_readers() == 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // that the peer knows the writer as well
  T sample;
  sample.header.vehicle = "auv";
  sample.header.sensor = "one";
  auto next = std::chrono::steady_clock::now();
  for (std::uint64_t number = 1; number <= writes; ++number) {
    sample.header.sequence = number;
    EXPECT_TRUE(writer.write(sample));
    std::this_thread::sleep_until(next += period);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  sample.header.vehicle = "";
  EXPECT_TRUE(writer.write(sample));
  return counts(peer.output());
}

// A pause: as long as a busy machine keeps a program waiting, and far below what discovery would take.
constexpr long kPause_ms = 200;

/// What was written before the peer knew the writer is not its business; that takes a second at most.
void expect_all_from_the_first(std::map<std::string, long>& heard, std::uint64_t writes) {
  EXPECT_LT(heard["first"], static_cast<long>(writes) / 10);
  EXPECT_EQ(heard["received"], static_cast<long>(writes) - heard["first"] + 1);
  EXPECT_EQ(heard["missing"], 0);
  EXPECT_EQ(heard["not_in_order"], 0);
  EXPECT_GE(heard["writers"], 3);
  EXPECT_LT(heard["pause_ms"], kPause_ms);
}

TEST(Cyclone, HearsASuccessionWithoutAPauseOrALoss) {
  constexpr std::uint64_t kWrites = 8000;  // 20 s
  auto heard = counted_by_peer<ImuSample>("count_imu", 134, 1600, std::chrono::microseconds(2500), kWrites);
  expect_all_from_the_first(heard, kWrites);
}

TEST(Cyclone, HearsASuccessionOfTheNavigationState) {
  constexpr std::uint64_t kWrites = 3000;  // 30 s
  auto heard =
      counted_by_peer<NavState>("count_nav_state", 135, 600, std::chrono::microseconds(10000), kWrites);
  expect_all_from_the_first(heard, kWrites);
}

TEST(Cyclone, PublishesGpsToUs) {
  bus::Participant participant(options(68));
  std::mutex mutex;
  std::optional<GpsSample> received;
  bus::Reader<GpsSample> reader(participant, [&](const GpsSample& sample, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    received = sample;
  });
  const CyclonePeer peer("gps", 68);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const auto arrived = [&] {
    const std::lock_guard lock(mutex);
    return received.has_value();
  };
  while (!arrived() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const std::lock_guard lock(mutex);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->header.vehicle, Name("auv"));
  EXPECT_EQ(received->header.sensor, Name("gps-of-another-vendor"));
  EXPECT_EQ(received->header.stamp_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(received->fix, GpsFix::rtk_fixed);
  EXPECT_EQ(received->satellites, 17);
  EXPECT_EQ(received->latitude_rad, 0.635);
  EXPECT_EQ(received->longitude_rad, -1.25);
  EXPECT_EQ(received->velocity_N_m_s, (std::array<double, 3>{0.0, 0.5, 1.0}));
}

}  // namespace
}  // namespace fathom
