#pragma once

#include <functional>
#include <memory>
#include <string>

#include "cli/solve/run.hpp"
#include "report/comparison.hpp"

namespace fathom::cli {

/// Two runs over one recording.
struct CompareRequest {
  const SolveRun* first = nullptr;   ///< its callbacks are not used
  const SolveRun* second = nullptr;  ///< likewise; over the same data
  TimeNs epoch_ns = 0;
  /// Each instant at which both have a state, where somebody wants them.
  std::function<void(const report::ComparedRow&)> on_row;
};

/// Hands each sample to both engines, one after the other, so that only figures are kept. Errors are against
/// the reference or, where there is none, against the smoother over the first run's settings. The texts of
/// the comparison are left to the caller.
[[nodiscard]] report::Comparison compare(const CompareRequest& request);

/// For a person.
[[nodiscard]] std::string to_text(const report::Comparison& comparison);
/// Indented, with a line end. Unknown figures are null.
[[nodiscard]] std::string to_json(const report::Comparison& comparison);

/// The rows as a file.
class CompareCsv {
 public:
  /// Throws DatasetError.
  explicit CompareCsv(const std::string& path);
  ~CompareCsv();
  CompareCsv(const CompareCsv&) = delete;
  CompareCsv& operator=(const CompareCsv&) = delete;
  void add(const report::ComparedRow& row);
  void close();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace fathom::cli
