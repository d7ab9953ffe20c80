#include "base/disk/regular_file.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

TEST(RegularFile, IsReadWhole) {
  const test::TemporaryFolder folder;
  const std::string all(200'000, 'x');
  std::ofstream(folder / "file") << all;
  EXPECT_EQ(no_regular_file(folder / "file"), "");
  EXPECT_EQ(read_regular_file(folder / "file", all.size()).value(), all);
  EXPECT_EQ(read_regular_file(folder / "file", all.size() - 1).error().message,
            "is larger, expected at most 199999 bytes");
  std::ofstream(folder / "nothing");
  EXPECT_EQ(read_regular_file(folder / "nothing", 1).value(), "");
}

TEST(RegularFile, WhatIsNoneIsNamedAndNotWaitedFor) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_EQ(no_regular_file(folder / "pipe"), "is a pipe, expected a regular file");
  EXPECT_EQ(no_regular_file(folder.path()), "is a folder, expected a regular file");
  EXPECT_EQ(no_regular_file("/dev/zero"), "is a device, expected a regular file");
  EXPECT_EQ(no_regular_file(folder / "loop"),
            "cannot be read: Too many levels of symbolic links, expected a regular file");
  EXPECT_EQ(read_regular_file(folder / "pipe", 1).error().message, "is a pipe, expected a regular file");
  EXPECT_EQ(read_regular_file(folder / "none", 1).error().message,
            "cannot be read: No such file or directory, expected a regular file");
}

}  // namespace
}  // namespace fathom
