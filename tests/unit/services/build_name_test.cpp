#include "fusion/checkpoint/build_name.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <zlib.h>

#include "runtime/build_info.hpp"

namespace fathom::fusion {
namespace {

TEST(BuildName, IsThatOfThisExecutable) {
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
