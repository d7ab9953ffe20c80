#include "cli/solve/smooth.hpp"

#include <algorithm>
#include <vector>

#include "base/clock.hpp"
#include "cli/progress.hpp"
#include "estimation/smoothing/smoother.hpp"

namespace fathom::cli {

SolveResult run_smoothed(const SolveRun& solve_run, const SmoothedStates& states) {
  constexpr double kProgressSteps = 1000.0;
  estimation::Smoother smoother(config::engine_config(*solve_run.config));
  if (const auto start = start_of(solve_run)) smoother.start_from(*start);
  SolveResult result;
  Progress progress(solve_run.label, static_cast<std::uint64_t>(kProgressSteps));
  const SystemClock clock;
  const TimeNs begin_ns = clock.monotonic_ns();
  for_each_sample(solve_run, [&]<class Sample>(const Sample& sample) {
    if constexpr (!Informing<Sample>) smoother.add(sample);
  });
  result.imu_samples = solve_run.data->of<ImuSample>().size();
  std::vector<NavState> smoothed;
  smoothed.reserve(solve_run.data->of<ImuSample>().size());
  estimation::Smoother::Output output;
  output.verdict = [&](const Verdict& verdict) { result.add(verdict); };
  output.filtered = states.filtered;
  output.smoothed = [&](const NavState& state) { smoothed.push_back(state); };
  output.detail = [&](const NavDetail& detail) { result.gps_latency_s = gps_latency_s(detail); };
  output.progress = [&](double share) {
    progress.update(static_cast<std::uint64_t>(kProgressSteps * share));
  };
  smoother.run(output);
  result.nav_states = smoothed.size();
  result.wall_s = to_seconds(clock.monotonic_ns() - begin_ns);
  if (states.smoothed) std::for_each(smoothed.rbegin(), smoothed.rend(), states.smoothed);
  return result;
}

}  // namespace fathom::cli
