// What a reader should have had and did not have is counted, and nothing else.

#include "bus/detail/lost_samples.hpp"

#include <cstdint>
#include <initializer_list>

#include <gtest/gtest.h>

namespace fathom::bus::detail {
namespace {

constexpr WriterGuid kOne{1};
constexpr WriterGuid kTwo{2};

class Lost : public testing::Test {
 protected:
  Lost() { samples.matched(kOne); }

  std::uint64_t after(std::initializer_list<std::uint64_t> numbers, const WriterGuid& writer = kOne) {
    for (const std::uint64_t number : numbers) samples.taken(writer, number);
    return samples.settle();
  }

  LostSamples samples;
};

TEST_F(Lost, NoneOfThoseThatFollowOneAnother) {
  EXPECT_EQ(samples.settle(), 0U);
  EXPECT_EQ(after({1000}), 0U);  // what was written before we came
  EXPECT_EQ(after({1001, 1002}), 0U);
  EXPECT_EQ(after({1003}), 0U);
}

TEST_F(Lost, NoneWhereSeveralKeysAreTakenOneAfterAnother) {
  EXPECT_EQ(after({2, 4, 6, 1, 3, 5}), 0U);
  EXPECT_EQ(after({8, 7, 9}), 0U);
}

TEST_F(Lost, EachIsCountedOnce) {
  EXPECT_EQ(after({1, 2, 5}), 2U);
  EXPECT_EQ(after({6}), 0U);
  EXPECT_EQ(after({10, 8}), 2U);
  EXPECT_EQ(samples.settle(), 0U);
}

TEST_F(Lost, WritersAreCountedApart) {
  samples.matched(kTwo);
  EXPECT_EQ(after({1, 2}), 0U);
  EXPECT_EQ(after({70, 72}, kTwo), 1U);
  EXPECT_EQ(after({3}), 0U);
}

TEST_F(Lost, AWriterThatLeftOwesNothing) {
  EXPECT_EQ(after({1, 2}), 0U);
  samples.unmatched(kOne);
  EXPECT_EQ(after({9}), 0U);
  samples.matched(kOne);
  EXPECT_EQ(after({20, 21}), 0U);
}

}  // namespace
}  // namespace fathom::bus::detail
