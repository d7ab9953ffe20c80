#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/name.hpp"
#include "base/time.hpp"
#include "config/fusion/fusion_config.hpp"
#include "dataset/dataset.hpp"
#include "estimation/engine_config.hpp"
#include "samples/alignment/help.hpp"
#include "samples/alignment_status.hpp"
#include "samples/forecast.hpp"
#include "samples/innovation_tally.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

namespace fathom::estimation {
class FusionEngine;
}

namespace fathom::cli {

/// Verdicts counted per kind of source.
using VerdictCounts = std::map<SourceKind, std::array<std::uint64_t, kVerdictKinds>>;

/// A span of time without GPS, [begin_ns, end_ns).
struct GpsWindow {
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
  [[nodiscard]] bool contains(TimeNs stamp_ns) const { return stamp_ns >= begin_ns && stamp_ns < end_ns; }
};

/// Samples of one source that are left out, [begin_ns, end_ns) by their stamps.
struct Withheld {
  std::string source;  ///< a kind, "gps", or a sensor, "gps0"
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
};

/// SOURCE or SOURCE@FROM:TO, seconds of the data set; either may be left out. Throws Failure where it is none
/// of these, or the data have no such source.
[[nodiscard]] Withheld parse_without(const std::string& text, const dataset::Dataset& data, TimeNs epoch_ns);

/// One run of a data set through the engine.
struct SolveRun {
  const config::FusionConfig* config = nullptr;
  const dataset::Dataset* data = nullptr;
  const std::vector<dataset::Arrival>* arrivals = nullptr;
  std::optional<estimation::InitialState> start;  ///< instead of what the configuration says
  std::vector<GpsWindow> gps_removed;             ///< fixes with stamps in these never reach the engine
  std::vector<Withheld> withheld;                 ///< samples that never reach the engine
  std::string label;                              ///< of the progress bar
  /// Called with each navigation state. The engine may be asked for more.
  std::function<void(const NavState&, estimation::FusionEngine&)> on_state;

  /// Called with each final verdict, where somebody wants them.
  std::function<void(const Verdict&)> on_verdict;

  [[nodiscard]] bool removes(const GpsSample& fix) const;
  [[nodiscard]] bool withholds(SourceKind kind, const SampleHeader& header) const;
  /// Whether a sample never reaches the engine.
  template <class Sample>
  [[nodiscard]] bool withholds(const Sample& sample) const {
    if constexpr (std::is_same_v<Sample, GpsSample>)
      if (!gps_removed.empty() && removes(sample)) return true;
    return !withheld.empty() && withholds(kSourceOf<Sample>, sample.header);
  }
};

/// Its engine's configuration. What only late fixes need is left out where the data have none.
[[nodiscard]] estimation::EngineConfig engine_of(const SolveRun& solve_run);

/// Calls `consumer` with each sample in the order of arrival, without those that are left out.
template <class Consumer>
void for_each_sample(const SolveRun& solve_run, Consumer&& consumer) {
  for (const dataset::Arrival& arrival : *solve_run.arrivals) {
    dataset::visit(*solve_run.data, arrival, [&](const auto& sample) {
      if (!solve_run.withholds(sample)) consumer(sample);
    });
  }
}

/// The state that the run or its configuration gives to start from, if any.
[[nodiscard]] std::optional<estimation::InitialState> start_of(const SolveRun& solve_run);

/// What was not plausible for a while: see samples/alignment/help.hpp. Seconds since the first inertial
/// sample.
struct ImplausibleSpan {
  std::string name;
  Blame blame;
  std::string sensor;  ///< of the configuration; the word of the kind where none is named there
  std::string text;    ///< one sentence that says what would make it right
  double first_s = 0.0;
  double last_s = 0.0;
  double value = 0.0;
};

/// By sensor and model.
using InnovationTallies = std::map<std::pair<Name, Name>, InnovationTally>;
[[nodiscard]] inline std::string text_of(const std::pair<Name, Name>& sensor_and_model) {
  return sensor_and_model.first.str() + "." + sensor_and_model.second.str();
}

struct SolveResult {
  VerdictCounts verdicts;
  InnovationTallies innovations;
  std::uint64_t imu_samples = 0;
  std::uint64_t nav_states = 0;
  double wall_s = 0.0;
  double gps_latency_s = 0.0;  ///< found beyond the configured one, at the end
  AlignmentStatus alignment;   ///< at the end; of the engine only, not of the smoother

  bool ever_aligned = false;
  std::vector<ImplausibleSpan> implausibles;
  /// By sensor, the largest of the run: see samples/alignment/help.hpp.
  std::map<std::string, double> noise_factors;

  /// By axis, what they are at the end: see samples/alignment/help.hpp.
  std::map<std::string_view, FoundBias> biases;

  struct SlowError {
    double sigma_m = 0.0;
    double configured_m = 0.0;
  };
  /// By kind, what they are at the end: see samples/alignment/help.hpp.
  std::map<std::string, SlowError> slow_errors;

  /// Keeps what a status finds implausible, noisy, biased or slow.
  void note(const AlignmentStatus& status, const estimation::EngineConfig& config, double at_s);
  /// Counts a final verdict; others change nothing.
  void add(const Verdict& verdict);
};

/// Of a filter that estimates it; 0 of others.
[[nodiscard]] double gps_latency_s(const NavDetail& detail);

/// Hands every sample to the engine in the order of its arrival: what the fusion service does on the network.
[[nodiscard]] SolveResult run(const SolveRun& solve_run);

/// The state at the first row of the reference at or after the first inertial sample, with the configured
/// sigmas. Throws Failure when the reference cannot give it.
[[nodiscard]] estimation::InitialState start_from_reference(const dataset::Dataset& data,
                                                            const config::FusionConfig& config,
                                                            const std::string& directory);

}  // namespace fathom::cli
