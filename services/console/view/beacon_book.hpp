#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "console/view/ring.hpp"
#include "health/instant.hpp"
#include "samples/range.hpp"
#include "samples/verdict.hpp"

namespace fathom::console {

/// The newest range to one beacon, with its age and what became of it.
struct BeaconLine {
  RangeSample range;
  double age_s = kUnknown;             ///< since it was heard, by the console's own clock
  std::optional<VerdictKind> verdict;  ///< none: fusion said nothing about it
};

/// Beacons for the map: those that lie where the bridge was told. Pure: times are arguments. Memory is
/// bounded whatever comes from the network. Not thread-safe.
class BeaconBook {
 public:
  static constexpr std::size_t kMostBeacons = 32;
  /// A range this old says nothing about where the vehicle is.
  static constexpr double kForgottenS = 60.0;

  /// A range without the place of its beacon, or without a length, cannot be drawn and is left out.
  void add(const RangeSample& sample, const health::Instant& at);
  /// Verdicts on other sources are none of its business. A verdict may come before its range.
  void judge(const Verdict& verdict);
  /// By sensor and beacon.
  [[nodiscard]] std::vector<BeaconLine> lines(const health::Instant& at);

 private:
  struct Heard {
    RangeSample range;
    std::optional<VerdictKind> verdict;
    TimeNs at_ns = 0;  ///< monotonic
  };
  struct Judged {
    Name sensor;
    TimeNs stamp_ns = 0;
    VerdictKind kind = VerdictKind::used;
  };
  void forget(TimeNs monotonic_ns);

  std::map<std::pair<Name, Name>, Heard> beacons_;
  Ring<Judged> judged_{64};
};

}  // namespace fathom::console
