#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "codec/codec.hpp"

namespace fathom::cli {

/// Refused frames in a row: `first` and, where there are more of them, how many and how many bytes they had.
struct RejectionRun {
  codec::Rejected first;    ///< its length is that of all frames of the run together
  std::uint64_t count = 1;  ///< frames
};

/// Keeps garbage readable. A stretch is what lies between two samples, and never more than kStretch bytes. In
/// a stretch the first refused frame of each reason is told at once, and the others of that reason as one run
/// at the stretch's end. The counts of all runs add up to the number of refused frames.
class RejectionRuns {
 public:
  static constexpr std::uint64_t kStretch = 1U << 20;  ///< bytes

  explicit RejectionRuns(std::function<void(const RejectionRun&)> tell) : tell_(std::move(tell)) {}

  void add(const codec::Rejected& rejected) {
    if (rejected.offset - began_ >= kStretch) end(rejected.offset);
    Reason& reason = reasons_.at(static_cast<std::size_t>(rejected.reason));
    if (!reason.told) {
      reason.told = true;
      tell_({rejected, 1});
    } else if (reason.others.count++ == 0) {
      reason.others.first = rejected;
    } else {
      reason.others.first.length += rejected.length;
    }
  }

  /// The stretch is over; the next one begins at `offset`.
  void end(std::uint64_t offset) {
    for (Reason& reason : reasons_) {
      if (reason.others.count > 0) tell_(reason.others);
      reason = {};
    }
    began_ = offset;
  }

 private:
  struct Reason {
    bool told = false;
    RejectionRun others{.first = {}, .count = 0};
  };

  std::function<void(const RejectionRun&)> tell_;
  std::array<Reason, 8> reasons_{};  // one each of codec::RejectReason
  std::uint64_t began_ = 0;
};

}  // namespace fathom::cli
