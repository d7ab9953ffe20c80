#include "cli/solve/run.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/clock.hpp"
#include "base/unknown.hpp"
#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/alignment/help.hpp"

namespace fathom::cli {
namespace {

/// Inertial samples from one look at the alignment to the next.
constexpr std::uint64_t kStatusEvery = 20;

}  // namespace

void SolveResult::add(const Verdict& verdict) {
  if (!verdict.is_final) return;
  ++verdicts[verdict.source][static_cast<std::size_t>(verdict.kind)];
  if (verdict.dimensions > 0) innovations[{verdict.header.sensor, verdict.model}].add(verdict);
}

bool SolveRun::removes(const GpsSample& fix) const {
  return std::any_of(gps_removed.begin(), gps_removed.end(),
                     [&](const GpsWindow& window) { return window.contains(fix.header.stamp_ns); });
}

bool SolveRun::withholds(SourceKind kind, const SampleHeader& header) const {
  return std::any_of(withheld.begin(), withheld.end(), [&](const Withheld& one) {
    return header.stamp_ns >= one.begin_ns && header.stamp_ns < one.end_ns &&
           (one.source == to_string(kind) || one.source == header.sensor.view());
  });
}

Withheld parse_without(const std::string& text, const dataset::Dataset& data, TimeNs epoch_ns) {
  const auto refuse = [&text](const std::string& expectation) -> Failure {
    return {ExitCode::bad_configuration, "--without: is '" + text + "', expected " + expectation};
  };
  constexpr const char* kForm = "SOURCE or SOURCE@FROM:TO, FROM before TO in seconds of the data set";
  Withheld out{text.substr(0, text.find('@')), std::numeric_limits<TimeNs>::min(),
               std::numeric_limits<TimeNs>::max()};
  if (const std::size_t at = text.find('@'); at != std::string::npos) {
    const std::size_t colon = text.find(':', at);
    if (colon == std::string::npos) throw refuse(kForm);
    const auto instant = [&](const std::string& word, TimeNs& into) {
      if (word.empty()) return;
      double seconds = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), seconds);
      if (error != std::errc() || end != word.data() + word.size() || !(std::abs(seconds) < 4e9))
        throw refuse(kForm);
      into = epoch_ns + from_seconds(seconds);
    };
    instant(text.substr(at + 1, colon - at - 1), out.begin_ns);
    instant(text.substr(colon + 1), out.end_ns);
    if (out.begin_ns >= out.end_ns) throw refuse(kForm);
  }
  std::vector<std::string> known_sources;
  for_each_aiding_kind([&](auto kind) {
    for (const auto& sample : data.of<typename decltype(kind)::Sample>()) {
      for (const std::string& name : {std::string(kind.kWord), sample.header.sensor.str()})
        if (std::find(known_sources.begin(), known_sources.end(), name) == known_sources.end())
          known_sources.push_back(name);
    }
  });
  if (std::find(known_sources.begin(), known_sources.end(), out.source) == known_sources.end()) {
    std::string words;
    for (const std::string& name : known_sources) words += (words.empty() ? "" : ", ") + name;
    throw refuse("a source of the data: " + (words.empty() ? "there is none" : words));
  }
  return out;
}

std::optional<estimation::InitialState> start_of(const SolveRun& solve_run) {
  if (solve_run.start) return solve_run.start;
  if (config::starts_from_state(solve_run.config->start.mode))
    return config::initial_state(*solve_run.config);
  return std::nullopt;
}

/// The name of the first instrument of a kind.
static std::string sensor_of(const estimation::EngineConfig& config, SourceKind kind) {
  const auto at = std::find_if(config.sensors.begin(), config.sensors.end(),
                               [&](const auto& one) { return one.kind == kind; });
  return at == config.sensors.end() ? std::string(to_string(kind)) : at->sensor;
}

void SolveResult::note(const AlignmentStatus& status, const estimation::EngineConfig& config, double at_s) {
  for (const NoiseFactor& one : fathom::noise_factors(status)) {
    double& largest = noise_factors[std::string(one.sensor)];
    largest = std::max(largest, one.factor);
  }
  for (const FoundBias& one : found_biases(status)) biases[one.axis] = one;
  for (const SlowFixes& one : slow_fixes(status))
    slow_errors[std::string(one.kind)] = {one.sigma_m, one.configured_m};
  const AlignmentCondition* found = implausible(status);
  if (found == nullptr) return;
  auto known = std::find_if(implausibles.begin(), implausibles.end(),
                            [&](const ImplausibleSpan& one) { return one.name == found->name.view(); });
  if (known == implausibles.end()) {
    const Blame blame = blame_of(*found);
    known = implausibles.insert(
        known, {std::string(found->name.view()), blame, sensor_of(config, blame.source), {}, at_s});
  }
  known->text.assign(status.advice.data(), strnlen(status.advice.data(), status.advice.size()));
  known->value = found->value;
  known->last_s = at_s;
}

estimation::EngineConfig engine_of(const SolveRun& solve_run) {
  estimation::EngineConfig out = config::engine_config(*solve_run.config);
  if (solve_run.data->of<FixSample>().empty()) out.late_fix_memory_s = 0.0;
  return out;
}

SolveResult run(const SolveRun& solve_run) {
  const estimation::EngineConfig config = engine_of(solve_run);
  estimation::FusionEngine engine(config);
  if (const auto start = start_of(solve_run)) engine.start_from(*start);
  SolveResult result;
  Progress progress(solve_run.label, solve_run.arrivals->size());
  const SystemClock clock;
  const TimeNs begin_ns = clock.monotonic_ns();
  const auto take_verdicts = [&] {
    Verdict verdict;
    while (engine.next_verdict(verdict)) {
      result.add(verdict);
      if (verdict.is_final && solve_run.on_verdict) solve_run.on_verdict(verdict);
    }
  };
  std::uint64_t done = 0;
  TimeNs first_ns = 0;
  bool ever_aligned = false;
  for_each_sample(solve_run, [&](const auto& sample) {
    progress.update(++done);
    if constexpr (std::is_same_v<std::decay_t<decltype(sample)>, ImuSample>) {
      ++result.imu_samples;
      if (engine.add(sample)) {
        if (result.nav_states++ == 0) first_ns = sample.header.stamp_ns;
        ever_aligned = ever_aligned || engine.nav_state().alignment == AlignmentPhase::aligned;
        if (result.nav_states % kStatusEvery == 0) {
          engine.fill(result.alignment);
          result.note(result.alignment, config, to_seconds(sample.header.stamp_ns - first_ns));
        }
        if (solve_run.on_state) solve_run.on_state(engine.nav_state(), engine);
      }
    } else {
      engine.add(sample);
    }
    take_verdicts();
  });
  engine.finish();
  take_verdicts();
  result.wall_s = to_seconds(clock.monotonic_ns() - begin_ns);
  NavDetail detail;
  engine.fill(detail);
  result.gps_latency_s = gps_latency_s(detail);
  engine.fill(result.alignment);
  result.ever_aligned = ever_aligned;
  return result;
}

double gps_latency_s(const NavDetail& detail) {
  for (std::uint32_t i = 0; i < detail.count; ++i)
    if (detail.states[i].name == Name("gps_latency_s") && known(detail.states[i].value))
      return detail.states[i].value;
  return 0.0;
}

estimation::InitialState start_from_reference(const dataset::Dataset& data,
                                              const config::FusionConfig& config,
                                              const std::string& directory) {
  const TimeNs first_ns = data.of<ImuSample>().front().header.stamp_ns;
  const auto row = std::find_if(data.reference.begin(), data.reference.end(),
                                [first_ns](const Truth& truth) { return truth.header.stamp_ns >= first_ns; });
  const std::string file = directory + "/reference.csv: ";
  if (data.reference.empty())
    throw Failure(ExitCode::bad_input, file + "no rows, expected a reference to start from");
  if (row == data.reference.end()) {
    throw Failure(ExitCode::bad_input,
                  file + "no row at or after the first inertial sample, expected one to start from");
  }
  estimation::InitialState state;
  state.stamp_ns = row->header.stamp_ns;
  state.latitude_rad = row->latitude_rad;
  state.longitude_rad = row->longitude_rad;
  state.altitude_m = row->altitude_m;
  state.velocity_N_m_s = row->velocity_N_m_s;
  state.rpy_rad = row->rpy_rad;
  state.position_sigma_N_m = config.start.sigma.position_N_m;
  state.velocity_sigma_N_m_s = config.start.sigma.velocity_N_m_s;
  state.attitude_sigma_rad = config.start.sigma.attitude_rad;
  bool complete = known(state.latitude_rad) && known(state.longitude_rad) && known(state.altitude_m);
  for (std::size_t i = 0; i < 3; ++i)
    complete = complete && known(state.velocity_N_m_s[i]) && known(state.rpy_rad[i]);
  if (!complete) {
    throw Failure(
        ExitCode::bad_input,
        file +
            "the first row after the first inertial sample has blanks, expected position, velocity and "
            "attitude to start from");
  }
  return state;
}

}  // namespace fathom::cli
