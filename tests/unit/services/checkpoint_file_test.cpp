#include <cstdint>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fusion/checkpoint/file.hpp"

namespace fathom::fusion {
namespace {

namespace fs = std::filesystem;

std::vector<std::byte> image(std::size_t size) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 37 >> 3);
  return out;
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
  EXPECT_EQ(replace_file(path, image(1000), false), "");
  EXPECT_EQ(replace_file(path, image(20), true), "");
  EXPECT_EQ(read_file(path).value(), image(20));
  EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()), 1);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(CheckpointFile, AFullDiskLeavesTheOldOne) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const fs::path path = folder / "fusion.checkpoint";
  ASSERT_EQ(replace_file(path, image(100), false), "");
  fs::create_symlink("/dev/full", folder / "fusion.checkpoint.new");
  const std::string why = replace_file(path, image(200), false);
  EXPECT_NE(why.find("cannot be written"), std::string::npos) << why;
  EXPECT_NE(why.find("No space left"), std::string::npos) << why;
  EXPECT_EQ(read_file(path).value(), image(100));
}

TEST_F(CheckpointFile, APipeInItsPlaceIsNotWaitedFor) {
  const fs::path path = folder / "fusion.checkpoint";
  ASSERT_EQ(::mkfifo((folder / "fusion.checkpoint.new").c_str(), 0600), 0);
  const std::string why = replace_file(path, image(10), false);
  EXPECT_NE(why.find("cannot be written"), std::string::npos) << why;
}

TEST_F(CheckpointFile, WhereNoFileCanBeItIsSaid) {
  std::ofstream(folder / "file") << "x";
  const std::string why = replace_file(folder / "file" / "fusion.checkpoint", image(10), false);
  EXPECT_NE(why.find("cannot be written"), std::string::npos) << why;
  EXPECT_EQ(read_file(folder).error().message, "is no regular file");
}

}  // namespace
}  // namespace fathom::fusion
