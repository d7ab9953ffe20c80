#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "report/comparison.hpp"
#include "samples/verdict.hpp"

namespace fathom::cli {

/// Puts the final verdicts of two runs over one recording side by side. A measurement is known by its source,
/// sensor, stamp and sequence; where several have all of these in common, the first of one run is the first
/// of the other. Verdicts come in any order and wait until their like has come.
class VerdictChanges {
 public:
  explicit VerdictChanges(TimeNs epoch_ns) : epoch_ns_(epoch_ns) {}

  /// A final verdict of the first (0) or second (1) run.
  void add(std::size_t run, const Verdict& verdict);
  /// No more will come: what is without its like was not judged by the other run.
  void finish();

  /// After finish(), in the order of time, then of source and sensor.
  [[nodiscard]] const std::vector<report::VerdictChange>& changes() const { return changes_; }
  /// After finish(): changes of one sensor that are alike and follow each other, as one.
  [[nodiscard]] std::vector<report::ChangedRun> runs() const;
  /// Measurements that either run judged.
  [[nodiscard]] std::uint64_t measurements() const { return measurements_; }

 private:
  using Key = std::tuple<TimeNs, SourceKind, std::string, std::uint64_t>;
  struct Judged {
    VerdictKind kind = VerdictKind::used;
    std::string model;
    double test_ratio = kUnknown;
  };
  void close(const Key& key, const Judged* first, const Judged* second);

  TimeNs epoch_ns_;
  std::map<Key, std::array<std::deque<Judged>, 2>> waiting_;
  std::vector<report::VerdictChange> changes_;
  std::map<std::string, std::vector<double>> unchanged_;  ///< instants, by sensor
  std::uint64_t measurements_ = 0;
};

}  // namespace fathom::cli
