// The service fathom-mavlink-gateway over real DDS and UDP: what node-mavlink reads of it, and what it
// answers.

#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "mavlink/frame.hpp"
#include "mavlink/messages.hpp"
#include "mavlink/signing.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support/free_port.hpp"
#include "support/navigating.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 224;

/// Says where it is a hundred times a second.
class Vehicle {
 public:
  Vehicle() : participant_(presence(kDomain, "fusion")), states_(participant_) {
    thread_ = std::thread([this] {
      while (!stop_) {
        NavState out = navigating(SystemClock().utc_ns(), ++sequence_);
        out.reset_counter = resets_;
        states_.write(out);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    });
  }
  ~Vehicle() {
    stop_ = true;
    thread_.join();
  }
  void reset() { ++resets_; }

 private:
  bus::Participant participant_;
  bus::Writer<NavState> states_;
  std::uint64_t sequence_ = 0;
  std::atomic<std::uint32_t> resets_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

/// The autopilot's end of the link.
class Autopilot {
 public:
  explicit Autopilot(int port) : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in address = loopback(port);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Autopilot() { close(socket_); }
  Autopilot(const Autopilot&) = delete;
  Autopilot& operator=(const Autopilot&) = delete;

  /// Listens until `enough(frame)`; everything that came is kept.
  template <class Enough>
  bool listen(Enough&& enough, double seconds = 15.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      pollfd one{socket_, POLLIN, 0};
      if (poll(&one, 1, 100) <= 0) continue;
      std::array<std::uint8_t, 2048> bytes{};
      socklen_t length = sizeof from_;
      const ssize_t size =
          recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from_), &length);
      if (size <= 0) continue;
      heard_.insert(heard_.end(), bytes.begin(), bytes.begin() + size);
      const auto look = mavlink::look_at(std::span(bytes).first(static_cast<std::size_t>(size)));
      EXPECT_EQ(look.kind, mavlink::Look::Kind::frame);
      if (look.kind == mavlink::Look::Kind::frame && enough(look.frame)) return true;
    }
    return false;
  }
  void say(const std::vector<std::uint8_t>& frame) {
    EXPECT_EQ(sendto(socket_, frame.data(), frame.size(), 0, reinterpret_cast<const sockaddr*>(&from_),
                     sizeof from_),
              static_cast<ssize_t>(frame.size()));
  }
  [[nodiscard]] const std::vector<std::uint8_t>& heard() const { return heard_; }

 private:
  int socket_;
  sockaddr_in from_{};
  std::vector<std::uint8_t> heard_;
};

/// What the gateway last said of itself.
class Said {
 public:
  [[nodiscard]] std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  [[nodiscard]] std::uint64_t counter(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto found = counters_.find(name);
    return found == counters_.end() ? 0 : found->second;
  }

 private:
  void take(const ServiceStatus& status) {
    if (status.header.sensor.view() != "mavlink_gateway") return;
    const std::lock_guard lock(mutex_);
    text_ = std::string(status.text);
    for (const auto& counter : status.counters) counters_[counter.name.str()] = counter.value;
  }

  mutable std::mutex mutex_;
  std::string text_;
  std::map<std::string, std::uint64_t> counters_;
  bus::Participant participant_{presence(kDomain, "cli")};
  bus::Reader<ServiceStatus> reader_{
      participant_, [this](const ServiceStatus& status, const bus::SampleInfo&) { take(status); }};
};

std::vector<std::string> arguments(int port, const std::vector<std::string>& sets = {}) {
  std::vector<std::string> out{"--config", source_dir() + "/deploy/config/mavlink_gateway.json",
                               "--set",    "bus.domain=" + std::to_string(kDomain),
                               "--set",    "clock.anchor_file=",
                               "--set",    "link.port=" + std::to_string(port)};
  for (const std::string& set : sets) {
    out.emplace_back("--set");
    out.push_back(set);
  }
  return out;
}

/// What node-mavlink makes of the bytes, a line a frame.
std::vector<nlohmann::json> read_by_others(const std::vector<std::uint8_t>& bytes, const std::string& key) {
  TemporaryFolder folder;
  const std::string file = (folder.path() / "frames").string();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const std::string out = (folder.path() / "out").string();
  const std::string command = std::string("'") + FATHOM_NODE + "' '" + FATHOM_READ + "' '" + FATHOM_NPM +
                              "' '" + file + "' '" + key + "' > '" + out + "' 2>&1";
  const int code = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): a test's own
  std::vector<nlohmann::json> lines;
  std::ifstream in(out);
  std::stringstream said;
  for (std::string line; std::getline(in, line); said << line << "\n") {
    auto parsed = nlohmann::json::parse(line, nullptr, false);
    if (parsed.is_object()) lines.push_back(std::move(parsed));
  }
  EXPECT_EQ(code, 0) << said.str();
  return lines;
}

TEST(MavlinkGateway, AnIndependentReaderFindsWhatWasSaid) {
  const int port = free_port(SOCK_DGRAM);
  Autopilot autopilot(port);
  Vehicle vehicle;
  Process gateway(
      "fathom-mavlink-gateway",
      arguments(port, {"messages.vision_position_hz=10", "messages.gps_input_hz=5", "geoid_height_m=10"}));
  std::map<std::uint32_t, int> count;
  bool navigating = false;  // told once a second; the first heartbeat may come before the first state
  EXPECT_TRUE(autopilot.listen([&](const mavlink::Frame& frame) {
    if (frame.id == mavlink::Heartbeat::kId)
      navigating = mavlink::message_of<mavlink::Heartbeat>(frame.payload).system_status == 4;
    count[frame.id]++;
    return count[mavlink::Odometry::kId] >= 30 && count.size() >= 4 && navigating;
  })) << gateway.err();
  vehicle.reset();
  EXPECT_TRUE(autopilot.listen([&](const mavlink::Frame& frame) {
    return frame.id == mavlink::Odometry::kId &&
           mavlink::message_of<mavlink::Odometry>(frame.payload).reset_counter == 1;
  })) << "the autopilot has to hear of a step";
  const auto lines = read_by_others(autopilot.heard(), "");
  ASSERT_GE(lines.size(), 30U);
  EXPECT_EQ(lines.back().at("invalid"), 0);
  EXPECT_EQ(lines.back().at("unknown"), 0);
  std::map<std::string, nlohmann::json> last;
  for (const auto& line : lines)
    if (line.contains("name")) last[line.at("name")] = line;
  ASSERT_TRUE(last.contains("ODOMETRY") && last.contains("VISION_POSITION_ESTIMATE") &&
              last.contains("GPS_INPUT") && last.contains("HEARTBEAT"));
  const auto& odometry = last["ODOMETRY"].at("fields");
  EXPECT_EQ(last["ODOMETRY"].at("system"), 1);
  EXPECT_EQ(last["ODOMETRY"].at("component"), 197);
  EXPECT_NEAR(odometry.at("vx").get<double>(), 1.5, 1e-6);
  EXPECT_EQ(odometry.at("frameId"), 20);
  EXPECT_EQ(odometry.at("childFrameId"), 12);
  EXPECT_EQ(odometry.at("resetCounter"), 1);
  EXPECT_GT(odometry.at("quality").get<int>(), 0);
  EXPECT_NEAR(odometry.at("poseCovariance").at(0).get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(odometry.at("poseCovariance").at(20).get<double>(), 1e-4, 1e-8);
  EXPECT_NEAR(last["GPS_INPUT"].at("fields").at("alt").get<double>(), -15.0, 1e-4);
  EXPECT_EQ(last["GPS_INPUT"].at("fields").at("lat").get<int>(), -286'478'898);
  EXPECT_EQ(last["HEARTBEAT"].at("fields").at("systemStatus"), 4);
  EXPECT_NEAR(last["VISION_POSITION_ESTIMATE"].at("fields").at("z").get<double>(), 0.0, 1e-6);
}

TEST(MavlinkGateway, AnswersAboutTimeAndSeesTheAutopilot) {
  const int port = free_port(SOCK_DGRAM);
  Autopilot autopilot(port);
  Vehicle vehicle;
  std::atomic<bool> seen = false;
  bus::Participant participant(presence(kDomain, "cli"));
  bus::Reader<ServiceStatus> statuses(participant, [&](const ServiceStatus& status, const bus::SampleInfo&) {
    if (status.header.sensor.view() == "mavlink_gateway" && status.text == "the autopilot is there")
      seen = true;
  });
  Process gateway("fathom-mavlink-gateway", arguments(port));
  ASSERT_TRUE(autopilot.listen([](const mavlink::Frame&) { return true; })) << gateway.err();
  // Garbage and damage first: they must not cost what follows.
  autopilot.say({0xFD, 0xFF, 0xFE, 0x00, 0x01});
  mavlink::Heartbeat heartbeat;
  heartbeat.type = 12;  // a submarine
  heartbeat.autopilot = 3;
  auto damaged = mavlink::frame_of(heartbeat, {1, 1}, 0);
  damaged.back() ^= 0xFFU;
  autopilot.say(damaged);
  for (int i = 0; i < 3; ++i) autopilot.say(mavlink::frame_of(heartbeat, {1, 1}, 1));
  mavlink::Timesync question;
  question.ts1 = 123'456'789;
  autopilot.say(mavlink::frame_of(question, {1, 1}, 2));
  TimeNs answered_ns = 0;
  EXPECT_TRUE(autopilot.listen([&](const mavlink::Frame& frame) {
    if (frame.id != mavlink::Timesync::kId) return false;
    const auto answer = mavlink::message_of<mavlink::Timesync>(frame.payload);
    answered_ns = answer.tc1;
    return answer.ts1 == question.ts1;
  }));
  EXPECT_NEAR(to_seconds(SystemClock().utc_ns() - answered_ns), 0.0, 5.0);
  EXPECT_TRUE(wait_until([&] { return seen.load(); })) << gateway.err();
}

TEST(MavlinkGateway, WhoIsOfAnotherSystemIsNamed) {
  const int port = free_port(SOCK_DGRAM);
  Autopilot autopilot(port);
  const Vehicle vehicle;
  const Said said;
  Process gateway("fathom-mavlink-gateway", arguments(port));
  ASSERT_TRUE(autopilot.listen([](const mavlink::Frame&) { return true; })) << gateway.err();
  mavlink::Heartbeat heartbeat;
  heartbeat.type = 12;
  EXPECT_TRUE(wait_until([&] {
    autopilot.say(mavlink::frame_of(heartbeat, {7, 1}, 0));
    return said.text() ==
           "no heartbeat of the autopilot is heard, but one of system 7; expected of system 1 (system_id)";
  })) << said.text();
}

TEST(MavlinkGateway, HearsEachFrameOfAFlood) {
  const int port = free_port(SOCK_STREAM);
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(port);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  const Said said;
  Process gateway("fathom-mavlink-gateway", arguments(port, {"link.type=tcp_client"}));
  const int there = ::accept(listener, nullptr, nullptr);
  ASSERT_GE(there, 0) << gateway.err();
  constexpr std::size_t kFrames = 20'000;
  std::vector<std::uint8_t> flood;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const auto frame = mavlink::frame_of(mavlink::Heartbeat{}, {1, 1}, static_cast<std::uint8_t>(i));
    flood.insert(flood.end(), frame.begin(), frame.end());
  }
  for (std::size_t at = 0; at < flood.size();) {
    const ssize_t sent = ::send(there, flood.data() + at, flood.size() - at, MSG_NOSIGNAL);
    ASSERT_GT(sent, 0) << gateway.err();
    at += static_cast<std::size_t>(sent);
  }
  EXPECT_TRUE(wait_until([&] { return said.counter("frames_heard") == kFrames; }))
      << said.counter("frames_heard");
  EXPECT_EQ(said.counter("frames_refused"), 0U);
  ::close(there);
  ::close(listener);
}

TEST(MavlinkGateway, SignsAndHearsOnlyWhatIsSigned) {
  const int port = free_port(SOCK_DGRAM);
  TemporaryFolder folder;
  const std::string digits(64, '7');
  const std::string file = (folder.path() / "key").string();
  std::ofstream(file) << digits << "\n";
  Autopilot autopilot(port);
  Vehicle vehicle;
  Process gateway("fathom-mavlink-gateway", arguments(port, {"signing.key_file=" + file, "signing.link=5"}));
  int frames = 0;
  ASSERT_TRUE(autopilot.listen([&](const mavlink::Frame& frame) {
    return frame.is_signed && ++frames == 20;
  })) << gateway.err();
  for (const auto& line : read_by_others(autopilot.heard(), digits)) {
    if (line.contains("name")) {
      EXPECT_EQ(line.at("signed"), true) << line;
    }
  }
  mavlink::Timesync question;
  question.ts1 = 42;
  autopilot.say(mavlink::frame_of(question, {1, 1}, 0));
  question.ts1 = 43;
  auto signed_question = mavlink::frame_of(question, {1, 1}, 1, mavlink::kFlagSigned);
  mavlink::Signer signer(mavlink::key_of(digits).value(), 1);
  signer.sign(signed_question, SystemClock().utc_ns());
  autopilot.say(signed_question);
  std::int64_t first = 0;
  EXPECT_TRUE(autopilot.listen([&](const mavlink::Frame& frame) {
    if (frame.id != mavlink::Timesync::kId) return false;
    first = mavlink::message_of<mavlink::Timesync>(frame.payload).ts1;
    return true;
  }));
  EXPECT_EQ(first, 43) << "the one without a signature is not answered";
  EXPECT_TRUE(gateway.says("is not signed")) << gateway.err();
  auto forged = mavlink::frame_of(question, {1, 1}, 2, mavlink::kFlagSigned);
  mavlink::Signer stranger(mavlink::key_of(std::string(64, '8')).value(), 1);
  stranger.sign(forged, SystemClock().utc_ns());
  autopilot.say(forged);
  EXPECT_TRUE(gateway.says("is signed with another key"))
      << "another reason is said as well: " << gateway.err();

  std::ofstream(file) << "short";
  Process refused("fathom-mavlink-gateway", arguments(port, {"signing.key_file=" + file}));
  EXPECT_EQ(refused.wait(), 2);
  EXPECT_NE(refused.err().find("expected 64 hexadecimal digits"), std::string::npos) << refused.err();
}

}  // namespace
}  // namespace fathom::test
