#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/unknown.hpp"
#include "samples/header.hpp"
#include "samples/kinds.hpp"

namespace fathom {

/// What became of one measurement.
enum class VerdictKind : std::uint8_t {
  used = 0,
  rejected = 1,      ///< by the gate: test ratio above 1
  late = 2,          ///< older than the horizon
  duplicate = 3,     ///< same stamp or sequence as one already seen
  frozen = 4,        ///< value repeats while the vehicle moves
  out_of_range = 5,  ///< not finite, or outside what the instrument can measure
  not_aligned = 6,   ///< the filter has no attitude or position to test it against
  source_disabled = 7,
  unknown_frame = 8,
  from_the_future = 9,  ///< stamped further ahead of the newest inertial sample than clocks can differ
  no_fix = 10,          ///< a satellite receiver says itself that it has no fix of the quality asked for
  /// Rejected as well, for so long that either the receiver or navigation is far wrong: a person has to
  /// decide.
  disputed = 11,
};
inline constexpr std::size_t kVerdictKinds = 12;

/// The word used on the command line and in reports, e.g. "not_aligned".
[[nodiscard]] std::string_view to_string(VerdictKind kind);

/// A judgement of one measurement. The first one (revision 0) is given as soon as the measurement has been
/// judged. A late neighbour may change the judgement: then another verdict of the same measurement follows.
/// Exactly one verdict of each measurement is final, and it is the last one.
///
/// Who counts measurements as they are judged counts each first verdict, and moves it from `previous` to
/// `kind` with each later one (VerdictTally). Who needs totals that never fall counts the final ones.
///
/// header: stamp and sequence of the measurement; received_ns: its arrival.
struct Verdict {
  SampleHeader header;
  SourceKind source = SourceKind::imu;
  Name model;   ///< aiding model that judged it, e.g. "dvl_velocity"
  Name writer;  ///< who published it, where known
  VerdictKind kind = VerdictKind::used;
  std::uint32_t dimensions = 0;  ///< of what follows, 0 to 6
  std::array<double, 6> innovation{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  std::array<double, 6> innovation_sigma{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  double test_ratio = kUnknown;  ///< below 1 accepted
  double limit = kUnknown;       ///< chi-square threshold behind the ratio, or the bound that was broken
  std::uint32_t revision = 0;    ///< number of this verdict among those of its measurement, from 0
  VerdictKind previous = VerdictKind::used;  ///< kind of the revision before; `kind` itself in revision 0
  bool is_final = false;                     ///< the measurement cannot be judged again
};

/// The first verdict of a measurement, or one that differs in kind from the one before: something happened.
[[nodiscard]] constexpr bool is_news(const Verdict& verdict) {
  return verdict.revision == 0 || verdict.kind != verdict.previous;
}

/// How many measurements were judged how. Each is counted once, with its first verdict, and moves when a
/// later verdict differs. Verdicts of a measurement whose first was not heard change nothing in the sum.
class VerdictTally {
 public:
  void add(const Verdict& verdict) {
    const auto kind = static_cast<std::size_t>(verdict.kind);
    const auto previous = static_cast<std::size_t>(verdict.previous);
    if (kind >= kVerdictKinds || previous >= kVerdictKinds || !is_news(verdict)) return;
    if (verdict.revision > 0) {
      // Where nothing has been counted as that, its first verdict was not heard.
      if (counts_[previous] == 0) return;
      --counts_[previous];
    }
    ++counts_[kind];
  }
  [[nodiscard]] const std::array<std::uint64_t, kVerdictKinds>& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t operator[](VerdictKind kind) const {
    return counts_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] std::uint64_t sum() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts_) sum += count;
    return sum;
  }

 private:
  std::array<std::uint64_t, kVerdictKinds> counts_{};
};

}  // namespace fathom
