#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "study/statistics.hpp"
#include "study/study.hpp"

namespace fathom::study {

struct RunOptions {
  int runs = 1;
  std::uint64_t seed = 1;
  std::vector<std::string> cases;    ///< empty: all
  std::vector<std::string> methods;  ///< empty: all
  int threads = 1;
  /// Told after each run, from any thread but never from two at once.
  std::function<void(std::size_t done, std::size_t total)> progress;
};

struct Row {
  std::string_view case_name;
  std::string_view method;
  std::string_view metric;
  std::string_view unit;
  Statistics statistics;
  std::size_t missing = 0;  ///< values that were not finite: statistics are of the others
};

/// Metric that each method has in each case: the share of its runs that yielded no result.
inline constexpr std::string_view kFailedMetric = "failed";

/// Seed of run number `run`: the same in every case, so that cases differ by what they change and not by
/// their luck.
[[nodiscard]] std::uint64_t seed_of_run(std::uint64_t seed, int run);

/// One row per case, method and metric, in the study's order; a combination that no run scored has none.
/// Behind the metrics of a method stands kFailedMetric: a run counts as failed when a metric of
/// Presence::always, which other runs of the same case and method have, is missing there or not finite. The
/// rows are the same to the last bit whatever the number of threads. Throws std::invalid_argument for a case
/// or method that the study does not have, and what the study throws.
[[nodiscard]] std::vector<Row> run_study(const Study& study, const RunOptions& options);

}  // namespace fathom::study
