#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/solve/course.hpp"
#include "cli/solve/outage.hpp"
#include "cli/solve/reference_placement.hpp"
#include "cli/solve/run.hpp"
#include "dataset/score.hpp"

namespace fathom::cli {

/// Everything that `fathom solve` found out.
struct SolveReport {
  std::string dataset;
  std::string config;
  std::string config_hash;
  std::string start;  ///< "configured" or "reference"
  SolveResult result;
  bool smoothed = false;
  std::uint64_t positions = 0;                      ///< navigation states with a position
  AlignmentPhase alignment = AlignmentPhase::none;  ///< at the end
  dataset::Score score;                             ///< against the reference; count 0 without one
  Placement placement;                              ///< of the reference
  dataset::Score filtered;                          ///< of the forward pass where smoothed
  FixErrors at_fixes;            ///< of the antenna at the fixes it was given, each at its own instant
  FixErrors filtered_at_fixes;   ///< likewise the forward pass where smoothed
  HeadingFigures heading;        ///< of the filter; nothing where smoothed
  double distance_m = kUnknown;  ///< horizontal, of the reference while it was scored
  std::vector<OutageFigures> outages;
  std::string calibration;  ///< for a person, where it was asked for
};

/// metrics.json, indented, with a line end. Unknown figures are null.
[[nodiscard]] std::string to_json(const SolveReport& report);

/// A few lines for a person.
[[nodiscard]] std::string to_text(const SolveReport& report);

}  // namespace fathom::cli
