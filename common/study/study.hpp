#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Monte Carlo experiments. A study says what its cases, methods and metrics are and carries out one run; the
/// runner (runner.hpp) repeats it over seeds and threads and makes statistics of it.
namespace fathom::study {

/// How the values of all runs become one row.
enum class Summary : std::uint8_t {
  distribution = 0,      ///< mean, spread and percentiles of the values
  root_mean_square = 1,  ///< one figure, the rms over the runs; it stands in every column, with no spread
};

/// Whether each run of a method that has this metric yields a value.
enum class Presence : std::uint8_t {
  always = 0,         ///< a run without it has failed
  if_it_happens = 1,  ///< e.g. the time until something that may not happen
};

struct Metric {
  std::string_view name;
  std::string_view unit;  ///< "m", "deg", "s", "%", "1"
  Summary summary = Summary::distribution;
  Presence presence = Presence::always;
};

/// One run of one case.
struct RunRequest {
  std::string_view case_name;
  std::uint64_t seed = 0;            ///< all randomness of the run comes from it, whatever the thread
  std::vector<std::string> methods;  ///< those that are asked for

  [[nodiscard]] bool wants(std::string_view method) const {
    return std::find(methods.begin(), methods.end(), method) != methods.end();
  }
};

struct Score {
  std::string_view method;
  std::string_view metric;
  double value = 0.0;
};

/// Values that one run yields. Names must be those that the study declares. A metric that has no value in
/// this run is added as NaN: the row exists, its n is smaller, and the run counts as missing there. A method
/// that gives no solution in a run adds NaN as well, so that the run counts as failed.
class Scores {
 public:
  void add(std::string_view method, std::string_view metric, double value) {
    scores_.push_back({method, metric, value});
  }
  [[nodiscard]] const std::vector<Score>& all() const { return scores_; }

 private:
  std::vector<Score> scores_;
};

/// Implementations are immutable: run() is called from several threads at once. The names are literals, they
/// outlive every report.
class Study {
 public:
  virtual ~Study() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::string_view description() const = 0;
  /// In the order of the report.
  [[nodiscard]] virtual std::vector<std::string_view> cases() const = 0;
  [[nodiscard]] virtual std::vector<std::string_view> methods() const = 0;
  [[nodiscard]] virtual std::vector<Metric> metrics() const = 0;
  /// Runs of each case where the caller does not say.
  [[nodiscard]] virtual int default_runs() const = 0;
  /// The methods asked for, on one and the same truth and measurements. Same request, same scores, to the
  /// bit.
  virtual void run(const RunRequest& request, Scores& scores) const = 0;
};

}  // namespace fathom::study
