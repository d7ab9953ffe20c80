#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dataset/score.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

/// Two solutions of one recording side by side.
namespace fathom::report {

/// What one of the two did.
struct ComparedSolution {
  std::string settings;  ///< for a person: the file, the overrides
  std::string config_hash;
  std::uint64_t positions = 0;        ///< navigation states with a position
  double aligned_after_s = kUnknown;  ///< since its first inertial sample; unknown where it never was
  AlignmentPhase alignment = AlignmentPhase::none;  ///< at the end
  dataset::Score score;                             ///< against what Comparison::against says
  double horizontal_sigma_rms_m = kUnknown;
  double horizontal_sigma_end_m = kUnknown;
};

/// The two at one instant. Times are seconds of the data set; differences are second minus first.
struct ComparedRow {
  double t_s = 0.0;
  double latitude_rad = kUnknown;  ///< of the first
  double longitude_rad = kUnknown;
  dataset::NavError difference;
  std::array<std::array<double, 3>, 2> position_sigma_N_m{};
  std::array<dataset::NavError, 2> error;
  std::array<NavMode, 2> mode{};
};

/// A measurement that the two judged differently; nothing where one of them did not judge it.
struct VerdictChange {
  double t_s = 0.0;
  SourceKind source = SourceKind::gps;
  std::string sensor;
  std::uint64_t sequence = 0;
  std::string model;
  std::optional<VerdictKind> first;
  std::optional<VerdictKind> second;
  std::array<double, 2> test_ratio{kUnknown, kUnknown};
};
/// The word of a verdict, "not judged" without one.
[[nodiscard]] std::string word_of(const std::optional<VerdictKind>& kind);

/// Changes of one sensor, alike, with no measurement of that sensor between them that differs.
struct ChangedRun {
  double begin_s = 0.0;
  double end_s = 0.0;
  std::uint64_t count = 0;
  std::string sensor;
  std::string model;
  std::optional<VerdictKind> first;
  std::optional<VerdictKind> second;
};

struct Comparison {
  std::string title;
  std::string source;
  std::string version;
  std::string against;  ///< what the errors are against: "the reference", "the smoother ..."; empty: none
  double begin_s = kUnknown;
  double end_s = kUnknown;
  std::array<ComparedSolution, 2> solutions;
  std::uint64_t compared = 0;     ///< instants at which both have a position
  dataset::Score difference;      ///< over these
  double farthest_s = kUnknown;   ///< when they were farthest apart
  std::vector<ComparedRow> rows;  ///< evenly thinned
  std::uint64_t measurements = 0;
  std::vector<VerdictChange> changes;
  std::vector<ChangedRun> runs;
};

/// Whether the two are equal wherever they were compared, and judged every measurement alike.
[[nodiscard]] bool equal(const Comparison& comparison);

/// A whole page, without anything from elsewhere.
[[nodiscard]] std::string page(const Comparison& comparison);

}  // namespace fathom::report
