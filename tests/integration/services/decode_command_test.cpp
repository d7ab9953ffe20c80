// `fathom decode` as scripts use it: JSON lines, totals, exit codes.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "sim/encode/dvl/pd0.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "support/paths.hpp"

namespace fathom {
namespace {

using Json = nlohmann::json;

struct Answer {
  int code = -1;
  std::vector<std::string> lines;
};

Answer run(const std::string& arguments) {
  const std::string command = test::binary_dir() + "/bin/fathom " + arguments;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  Answer answer;
  if (pipe == nullptr) return answer;
  std::string all;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    all.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find('\n', at), all.size());
    answer.lines.push_back(all.substr(at, end - at));
    at = end + 1;
  }
  return answer;
}

class DecodeCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    // The build makes it before this test: its absence is a failure, not a reason to skip.
    ASSERT_TRUE(std::filesystem::exists(test::binary_dir() + "/bin/fathom"));
    path_ = std::filesystem::temp_directory_path() / ("fathom_decode_" + std::to_string(::getpid()));
  }
  void TearDown() override { std::filesystem::remove(path_); }

  void write(const std::vector<std::uint8_t>& bytes) {
    std::ofstream(path_, std::ios::binary | std::ios::app)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  std::filesystem::path path_;
};

TEST_F(DecodeCommand, OneLineASampleOneARefusalAndTotals) {
  DvlSample s;
  s.velocity_D_m_s = {1.25, -0.5, kUnknown};
  s.altitude_m = 20.0;
  s.recorded_frame = DvlFrame::instrument;
  const TimeNs clock_ns = 1'769'862'615'250'000'000;
  const auto good = sim::encode::pd0(s, clock_ns);
  auto damaged = good;
  damaged[40] ^= 1U;
  write(good);
  write(damaged);
  for (const std::string& input : {path_.string(), "- < " + path_.string()}) {
    const Answer answer = run("decode pd0 --json " + input);
    EXPECT_EQ(answer.code, 0);
    ASSERT_EQ(answer.lines.size(), 3U);
    const Json dvl = Json::parse(answer.lines[0]);
    EXPECT_EQ(dvl.at("kind"), "dvl");
    EXPECT_EQ(dvl.at("stamp_utc"), "2026-01-31T12:30:15.250000Z");
    EXPECT_EQ(dvl.at("offset"), 0);
    EXPECT_EQ(dvl.at("frame"), "instrument");
    EXPECT_EQ(dvl.at("mode"), "bottom");
    EXPECT_EQ(dvl.at("vx_m_s"), 1.25);
    EXPECT_EQ(dvl.at("vy_m_s"), -0.5);
    EXPECT_TRUE(dvl.at("vz_m_s").is_null());
    EXPECT_EQ(dvl.at("valid"), Json::parse("[true,true,false]"));
    EXPECT_TRUE(dvl.at("b1_m_s").is_null());
    EXPECT_EQ(dvl.at("altitude_m"), 20.0);
    const Json rejected = Json::parse(answer.lines[1]);
    EXPECT_EQ(rejected.at("rejected"), "checksum");
    EXPECT_EQ(rejected.at("offset"), good.size());
    EXPECT_EQ(rejected.at("length"), good.size());
    const Json totals = Json::parse(answer.lines[2]).at("totals");
    EXPECT_EQ(totals.at("bytes"), 2 * good.size());
    EXPECT_EQ(totals.at("samples"), 1);
    EXPECT_EQ(totals.at("rejected"), 1);
    EXPECT_EQ(totals.at("skipped_bytes"), 0);
  }
}

TEST_F(DecodeCommand, GarbageIsARunAndNotALineAFrame) {
  // Noise, short lines and what looks like the beginning of frames: 6 MB in all.
  std::uint64_t state = 1;
  std::vector<std::uint8_t> garbage;
  for (int i = 0; i < 2'000'000; ++i) {
    state = state * 6'364'136'223'846'793'005U + 1'442'695'040'888'963'407U;
    garbage.push_back(static_cast<std::uint8_t>(state >> 56U));
  }
  for (int i = 0; i < 1'000'000; ++i) garbage.insert(garbage.end(), {'x', '\n'});
  for (int i = 0; i < 200'000; ++i)
    garbage.insert(garbage.end(), {'$', 'G', 'P', 'G', 'G', 'A', ',', '*', '0', '\n'});
  write(garbage);
  for (const char* protocol :
       {"nmea0183", "ubx", "pd0", "waterlinked", "vectornav", "paroscientific", "ascii_depth", "psimssb"}) {
    const Answer answer = run(std::string("decode --json ") + protocol + " " + path_.string());
    EXPECT_EQ(answer.code, 0);
    EXPECT_LT(answer.lines.size(), 2000U) << protocol;
    std::uint64_t count = 0;
    std::uint64_t length = 0;
    std::uint64_t samples = 0;
    for (const std::string& line : answer.lines) {
      const Json json = Json::parse(line);
      samples += json.contains("kind") ? 1U : 0U;
      if (!json.contains("rejected")) continue;
      count += json.value("count", std::uint64_t{1});
      length += json.at("length").get<std::uint64_t>();
    }
    const Json totals = Json::parse(answer.lines.back()).at("totals");
    EXPECT_EQ(totals.at("bytes"), garbage.size()) << protocol;
    EXPECT_EQ(totals.at("rejected"), count) << protocol;
    EXPECT_EQ(totals.at("samples"), samples) << protocol;
    EXPECT_LE(length, garbage.size()) << protocol;
  }
}

TEST_F(DecodeCommand, AFewRefusalsInARowKeepTheirPlaces) {
  const auto good = sim::encode::pd0(DvlSample{}, 1'769'862'615'250'000'000);
  auto damaged = good;
  damaged[40] ^= 1U;
  for (const auto& bytes : {damaged, damaged, damaged, good, damaged}) write(bytes);
  const Answer answer = run("decode pd0 --json " + path_.string());
  ASSERT_EQ(answer.lines.size(), 5U);
  const Json first = Json::parse(answer.lines[0]);
  EXPECT_EQ(first.at("offset"), 0);
  EXPECT_FALSE(first.contains("count"));
  const Json others = Json::parse(answer.lines[1]);
  EXPECT_EQ(others.at("offset"), good.size());
  EXPECT_EQ(others.at("length"), 2 * good.size());
  EXPECT_EQ(others.at("count"), 2);
  EXPECT_EQ(Json::parse(answer.lines[2]).at("kind"), "dvl");
  EXPECT_EQ(Json::parse(answer.lines[3]).at("offset"), 4 * good.size());
}

TEST_F(DecodeCommand, CountSinceStartIsNoUtc) {
  ImuSample s;
  s.angular_rate_B_rad_s = {0.1, 0.2, 0.3};
  s.specific_force_B_m_s2 = {0.0, 0.0, -9.81};
  write(sim::encode::vectornav(s, 12'345));
  const Answer answer = run("decode VN " + path_.string() + " --json");
  ASSERT_EQ(answer.lines.size(), 2U);
  const Json imu = Json::parse(answer.lines[0]);
  EXPECT_TRUE(imu.at("stamp_utc").is_null());
  EXPECT_EQ(imu.at("device_clock_ns"), 12'345);
  // Single precision on the wire, printed so that it reads back to the same bits.
  EXPECT_EQ(imu.at("az_m_s2").get<double>(), static_cast<double>(-9.81F));
}

TEST_F(DecodeCommand, ExitCodes) {
  EXPECT_EQ(run("decode nonesuch /dev/null 2>/dev/null").code, 2);
  EXPECT_EQ(run("decode pd0 2>/dev/null").code, 2);
  EXPECT_EQ(run("decode pd0 /dev/null --bogus 2>/dev/null").code, 2);
  EXPECT_EQ(run("decode pd0 /nonexistent 2>/dev/null").code, 3);
  EXPECT_EQ(run("decode pd0 / 2>/dev/null").code, 3);
  EXPECT_EQ(run("decode pd0 /dev/null").code, 0);
  const Answer unknown = run("decode nonesuch /dev/null 2>&1");
  ASSERT_EQ(unknown.lines.size(), 1U);
  EXPECT_TRUE(unknown.lines[0].starts_with("fathom: ")) << unknown.lines[0];
  EXPECT_NE(unknown.lines[0].find("pd0"), std::string::npos);
  const Answer list = run("decode --list");
  EXPECT_EQ(list.code, 0);
  EXPECT_GE(list.lines.size(), 8U);
}

TEST(Command, ARecordingHasAName) {
  const Answer answer = run("record --out recording 2>&1");
  EXPECT_EQ(answer.code, 2);
  ASSERT_EQ(answer.lines.size(), 1U);
  EXPECT_EQ(answer.lines[0], "fathom: --out recording: expected a name that ends in .mcap");
  EXPECT_EQ(run("record --recover /absent 2>/dev/null").code, 3);
}

}  // namespace
}  // namespace fathom
