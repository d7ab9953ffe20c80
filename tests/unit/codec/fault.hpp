#pragma once

#include <string>

#include <gtest/gtest.h>

#include "capture.hpp"

namespace fathom::codec::capture {

/// A frame that cannot be.
struct Fault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

inline std::string name_of_fault(const ::testing::TestParamInfo<Fault>& info) {
  return info.param.name;
}

/// The fault is refused as one frame, and the good one behind it is the only sample.
inline void expect_refused_once(std::string_view protocol, const Fault& fault, const ByteVector& good) {
  ByteVector stream = fault.bytes;
  stream.insert(stream.end(), good.begin(), good.end());
  const Harvest run = decode(protocol, stream);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, fault.reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
  // Of a frame with an impossible length the header is refused and the rest skipped.
  EXPECT_EQ(run.rejected[0].length + run.totals.skipped_bytes, fault.bytes.size());
}

}  // namespace fathom::codec::capture
