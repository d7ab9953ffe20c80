#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "codec/registry.hpp"
#include "samples/truth.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

/// Domain and ports of these tests alone.
constexpr int kDomain = 201;
constexpr int kPortOffset = 3200;

std::vector<std::string> arguments(const fs::path& links) {
  const std::string source = test::source_dir();
  return {"--config", source + "/deploy/config/simulator.json",
          "--set",    "scenario_dir=" + source + "/deploy/config/scenarios",
          "--set",    "bus.profiles_dir=" + source + "/deploy/dds",
          "--set",    "bus.domain=" + std::to_string(kDomain),
          "--set",    "port_offset=" + std::to_string(kPortOffset),
          "--set",    "link_dir=" + links.string()};
}

struct Collected : codec::Sink {
  void on_sample(const codec::Decoded& decoded) override { samples.push_back(decoded); }
  void on_rejected(const codec::Rejected&) override { ++rejected; }
  std::vector<codec::Decoded> samples;
  int rejected = 0;
};

/// Reads a device for some time as a bridge does and decodes what it says.
Collected listen(const fs::path& device, double seconds) {
  Collected out;
  const int fd = ::open(device.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return out;
  const auto codec = codec::find_protocol("vectornav")->make({});
  (void)test::wait_until(
      [&] {
        pollfd ready{fd, POLLIN, 0};
        std::array<std::uint8_t, 4096> buffer{};
        if (::poll(&ready, 1, 20) > 0) {
          const ssize_t n = ::read(fd, buffer.data(), buffer.size());
          if (n > 0) codec->feed({buffer.data(), static_cast<std::size_t>(n)}, out);
        }
        return false;
      },
      seconds);
  ::close(fd);
  return out;
}

class Simulator : public testing::Test {
 protected:
  void SetUp() override {
    links_ = fs::temp_directory_path() / ("fathom-simulator-test-" + std::to_string(::getpid()));
    fs::create_directories(links_);
  }
  void TearDown() override { fs::remove_all(links_); }
  fs::path links_;
};

TEST_F(Simulator, ThePseudoTerminalSurvivesItsReader) {
  test::Process simulator("fathom-simulator", arguments(links_));
  const fs::path imu = links_ / "imu";
  ASSERT_TRUE(test::wait_until([&] { return fs::is_symlink(imu); }, 20.0)) << simulator.err();

  Collected first;
  ASSERT_TRUE(test::wait_until(
      [&] {
        first = listen(imu, 1.0);
        return first.samples.size() > 50;
      },
      20.0))
      << simulator.err();
  // Nobody reads for so long that a terminal's buffer overflows several times.
  (void)test::wait_until([] { return false; }, 2.0);
  const Collected second = listen(imu, 1.5);
  ASSERT_GT(second.samples.size(), 80U);
  EXPECT_LE(second.rejected, 1);  // what was in the buffer may have been cut
  // A new reader starts with fresh bytes: what nobody read is gone, not queued.
  const double silent_s =
      to_seconds(*second.samples.front().time.clock_ns - *first.samples.back().time.clock_ns);
  EXPECT_GT(silent_s, 1.0);
  EXPECT_TRUE(simulator.running());

  simulator.kill(SIGINT);
  EXPECT_EQ(simulator.wait(), 0) << simulator.err();
  EXPECT_FALSE(fs::exists(fs::symlink_status(imu)));  // no dead link is left behind
}

TEST_F(Simulator, ALinkLeftByAKilledSimulatorIsReplaced) {
  const fs::path imu = links_ / "imu";
  {
    test::Process killed("fathom-simulator", arguments(links_));
    ASSERT_TRUE(test::wait_until([&] { return fs::is_symlink(imu); }, 20.0)) << killed.err();
  }
  EXPECT_TRUE(fs::is_symlink(imu));
  test::Process again("fathom-simulator", arguments(links_));
  ASSERT_TRUE(test::wait_until([&] { return listen(imu, 0.5).samples.size() > 20; }, 20.0)) << again.err();
}

TEST_F(Simulator, TheTruthIsOnItsTopic) {
  bus::Participant participant(test::presence(kDomain, "test"));
  std::atomic<int> received{0};
  const bus::Reader<Truth> reader(participant, [&](const Truth& truth, const bus::SampleInfo&) {
    if (known(truth.latitude_rad)) ++received;
  });
  test::Process simulator("fathom-simulator", arguments(links_));
  EXPECT_TRUE(test::wait_until([&] { return received > 20; }, 30.0)) << simulator.err();
}

TEST_F(Simulator, AnUnknownScenarioEndsItBeforeAnythingStarts) {
  auto words = arguments(links_);
  words.insert(words.end(), {"--set", "scenario=nowhere"});
  test::Process simulator("fathom-simulator", words);
  EXPECT_EQ(simulator.wait(), 2);
  EXPECT_NE(simulator.err().find("nowhere"), std::string::npos);
  EXPECT_NE(simulator.err().find("survey"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(links_));
}

}  // namespace
}  // namespace fathom
