#include "fusion/checkpoint/checkpoint.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "runtime/build_info.hpp"

namespace fathom::fusion {
namespace {

namespace fs = std::filesystem;

CheckpointLabel label(TimeNs stamp_ns = 1'700'000'000 * kNsPerSecond) {
  return {"auv", "fusion", "0123456789abcdef", "0.1.0+abc-89abcdef", stamp_ns};
}

std::vector<std::byte> archive(std::size_t size) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 37 >> 3);
  return out;
}

TEST(Checkpoint, ComesBackAsItWas) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100'000}}) {
    std::vector<std::byte> bytes;
    encode(label(), archive(size), bytes);
    const auto found = decode(bytes);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found.value().label.vehicle, "auv");
    EXPECT_EQ(found.value().label.service, "fusion");
    EXPECT_EQ(found.value().label.configuration, label().configuration);
    EXPECT_EQ(found.value().label.build, label().build);
    EXPECT_EQ(found.value().label.stamp_ns, label().stamp_ns);
    EXPECT_EQ(found.value().archive, archive(size));
  }
}

TEST(Checkpoint, EveryFlippedBitAndEveryCutIsNoticed) {
  std::vector<std::byte> good;
  encode(label(), archive(64), good);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::byte> bad = good;
    bad[i] ^= std::byte{0x10};
    EXPECT_FALSE(decode(bad)) << i;
    EXPECT_FALSE(decode(std::span(good).first(i))) << i;
  }
  good.push_back(std::byte{0});
  EXPECT_FALSE(decode(good));
}

TEST(Checkpoint, AnotherFormatIsNamed) {
  std::vector<std::byte> bytes;
  encode(label(), archive(8), bytes);
  bytes[8] = std::byte{9};
  EXPECT_EQ(decode(bytes).error().message, "is a checkpoint of format 9, format 2 was expected");
  EXPECT_EQ(decode(archive(500)).error().message, "is no checkpoint");
}

TEST(Checkpoint, WhoseAndWhenDecide) {
  const CheckpointLabel own = label();
  EXPECT_EQ(objection(label(own.stamp_ns - 5 * kNsPerSecond), own, 60.0), "");
  EXPECT_EQ(objection(label(own.stamp_ns - 61 * kNsPerSecond), own, 60.0),
            "is 61.0 s old, at most 60.0 s is gone on from");
  EXPECT_EQ(objection(label(own.stamp_ns + kNsPerSecond / 2), own, 60.0), "") << "clocks differ a little";
  EXPECT_EQ(objection(label(own.stamp_ns + 3600 * kNsPerSecond), own, 60.0), "is 3600.0 s from the future");
  CheckpointLabel other = own;
  other.vehicle = "auv2";
  EXPECT_EQ(objection(other, own, 60.0), "is of vehicle auv2, not of auv");
  other = own;
  other.service = "fusion_b";
  EXPECT_EQ(objection(other, own, 60.0), "is of service fusion_b, not of fusion");
  other = own;
  other.configuration = "fedc";
  EXPECT_EQ(objection(other, own, 60.0), "is of configuration fedc, not of 0123456789abcdef");
  other = own;
  other.build = "0.2.0";
  EXPECT_EQ(objection(other, own, 60.0), "") << "builds share states: the archive says itself what it holds";
}

class CheckpointFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "fathom-checkpoint-XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder;
};

TEST_F(CheckpointFile, IsReplacedWholeAndLeavesNothingBeside) {
  const fs::path path = folder / "deep" / "fusion.checkpoint";
  EXPECT_EQ(read_file(path).error().message, "is not there");
  EXPECT_EQ(replace_file(path, archive(1000), false), "");
  EXPECT_EQ(replace_file(path, archive(20), true), "");
  EXPECT_EQ(read_file(path).value(), archive(20));
  EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()), 1);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(CheckpointFile, AFullDiskLeavesTheOldOne) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const fs::path path = folder / "fusion.checkpoint";
  ASSERT_EQ(replace_file(path, archive(100), false), "");
  fs::create_symlink("/dev/full", folder / "fusion.checkpoint.new");
  const std::string why = replace_file(path, archive(200), false);
  EXPECT_NE(why.find("cannot be written"), std::string::npos) << why;
  EXPECT_NE(why.find("No space left"), std::string::npos) << why;
  EXPECT_EQ(read_file(path).value(), archive(100));
}

TEST_F(CheckpointFile, WhereNoFileCanBeItIsSaid) {
  std::ofstream(folder / "file") << "x";
  const std::string why = replace_file(folder / "file" / "fusion.checkpoint", archive(10), false);
  EXPECT_NE(why.find("cannot be written"), std::string::npos) << why;
  EXPECT_EQ(read_file(folder).error().message, "is no regular file");
}

TEST_F(CheckpointFile, TheBuildIsThatOfThisExecutable) {
  // The version, and the checksum of the whole file, here taken in one piece.
  std::ifstream in("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  ASSERT_GT(bytes.size(), 1U << 16U);
  const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  std::array<char, 16> expected{};
  std::snprintf(expected.data(), expected.size(), "-%08lx", sum);
  EXPECT_EQ(build_of_this_executable(), std::string(runtime::version()) + expected.data());
}

}  // namespace
}  // namespace fathom::fusion
