#include "fusion/intake/sample_gaps.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

SampleHeader numbered(const char* sensor, std::uint64_t sequence) {
  SampleHeader out;
  out.sensor = sensor;
  out.sequence = sequence;
  return out;
}

TEST(SampleGaps, CountsWhatIsMissingPerStream) {
  SampleGaps gaps;
  EXPECT_EQ(gaps.add(SourceKind::imu, numbered("imu", 500)), 0U)
      << "the first one says nothing of those before";
  EXPECT_EQ(gaps.add(SourceKind::imu, numbered("imu", 501)), 0U);
  EXPECT_EQ(gaps.add(SourceKind::gps, numbered("gps", 7)), 0U);
  EXPECT_EQ(gaps.add(SourceKind::imu, numbered("imu", 505)), 3U);
  EXPECT_EQ(gaps.add(SourceKind::gps, numbered("gps", 8)), 0U);
  EXPECT_EQ(gaps.add(SourceKind::imu, numbered("imu", 1)), 0U) << "its bridge began anew";
  EXPECT_EQ(gaps.add(SourceKind::imu, numbered("imu", 2)), 0U);
}

TEST(SampleGaps, GoOnFromWhatAnotherOneHasHeard) {
  SampleGaps theirs;
  (void)theirs.add(SourceKind::imu, numbered("imu", 500));
  (void)theirs.add(SourceKind::gps, numbered("gps", 7));
  SampleGaps own;
  (void)own.add(SourceKind::imu, numbered("imu", 510));
  own.go_on_from(theirs.last());
  EXPECT_EQ(own.add(SourceKind::imu, numbered("imu", 511)), 0U) << "of that it has its own";
  EXPECT_EQ(own.add(SourceKind::gps, numbered("gps", 10)), 2U);
}

}  // namespace
}  // namespace fathom::fusion
