#include "cli/bench/cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/bench/floor.hpp"
#include "cli/bench/hydro.hpp"
#include "cli/bench/updates.hpp"
#include "cli/bench/vehicle.hpp"
#include "cli/command.hpp"
#include "estimation/navigator/navigator.hpp"

namespace fathom::cli {
namespace {

using estimation::Navigator;
using estimation::Setup;

constexpr int kPredictions = 400;

BenchRow predict(const std::string& configuration, int rounds) {
  const BenchVehicle vehicle(configuration, 100.0);
  const Setup setup(vehicle.config());
  const Navigator base = settled(setup, vehicle);
  const auto floor = dense_floor(setup.index.size(), 3);
  Navigator navigator = base;
  estimation::ImuStep step;
  step.increments.dt_s = 0.01;
  step.increments.dtheta_rad = step.increments.dtheta_before_rad = {1e-4, 2e-4, 2e-3};
  step.increments.dv_m_s = step.increments.dv_before_m_s = {1e-3, -2e-3, -0.098};
  return compare(
      "predict_" + configuration, rounds, kPredictions,
      [&] {
        navigator = base;
        floor->reset();
      },
      [&] {
        step.from_ns = navigator.now_ns();
        step.to_ns = step.from_ns + 10'000'000;
        navigator.advance(step, step.to_ns);
        navigator.finish(step);
      },
      [&] { floor->predict(); });
}

/// A stream of samples of a whole minute through the engine, in inertial samples per second; the floor is the
/// rate that the dense product alone would allow.
BenchRow solve(const std::string& configuration, int rounds) {
  BenchVehicle vehicle(configuration, 100.0);
  std::vector<BenchVehicle::Sample> samples;
  std::vector<BenchVehicle::Sample> now;
  constexpr int kSteps = 3000;
  for (int k = 0; k < kSteps; ++k) {
    vehicle.step(now);
    samples.insert(samples.end(), now.begin(), now.end());
  }
  estimation::FusionEngine engine(vehicle.config());
  const auto floor = dense_floor(estimation::StateIndex(vehicle.config().groups).size(), 3);
  std::size_t used = 0;
  BenchRow row = compare(
      "solve_" + configuration, rounds, 1, [&] { floor->reset(); },
      [&] {
        engine.start_from(vehicle.start());
        Verdict verdict;
        used = 0;
        for (const auto& sample : samples) {
          if (feed(engine, sample)) (void)engine.nav_state();
          while (engine.next_verdict(verdict))
            used += verdict.revision == 0 && verdict.kind == VerdictKind::used ? 1 : 0;
        }
      },
      [&] {
        for (int k = 0; k < kSteps; ++k) floor->predict();
      });
  if (10 * used < 9 * (samples.size() - kSteps))
    throw Failure(ExitCode::runtime_failure,
                  "bench: solve: most measurements must be used, " + std::to_string(used) + " were");
  row.unit = "samples/s";
  row.value = 1e6 * kSteps / row.value;
  row.floor = 1e6 * kSteps / row.floor;
  row.ratio = 1.0 / row.ratio;
  return row;
}

/// The inertial samples behind a late fix: the dearest of them and all together, beside an ordinary one times
/// the number of steps that lie between; how many steps were repeated, beside the steps of the delay; and
/// over how many samples that was spread.
void late_fix(const std::string& configuration, double rate_hz, double late_s, int rounds,
              const std::function<void(const BenchRow&)>& done) {
  BenchVehicle vehicle(configuration, rate_hz);
  estimation::FusionEngine engine(vehicle.config());
  engine.start_from(vehicle.start());
  std::vector<BenchVehicle::Sample> now;
  Verdict verdict;
  const auto steps = [&](int count) {
    for (int k = 0; k < count; ++k) {
      vehicle.step(now);
      for (const auto& sample : now) (void)feed(engine, sample);
      while (engine.next_verdict(verdict)) {
      }
    }
  };
  steps(static_cast<int>(8.0 * rate_hz));
  std::vector<double> costs;
  std::vector<double> ordinary;
  std::vector<double> total;
  std::vector<double> repeated;
  std::vector<double> samples;
  const auto next = [&] {
    vehicle.step(now);
    return time_us([&] { (void)feed(engine, now.front()); });
  };
  for (int round = 0; round < rounds; ++round) {
    // An instant at which nothing else arrives.
    steps(static_cast<int>(0.1 * rate_hz) + 3);
    ordinary.push_back(next());
    const std::uint64_t before = engine.repeated_steps();
    engine.add(vehicle.late_fix(late_s));
    double dearest = 0.0;
    double sum = 0.0;
    int taken = 0;
    for (std::uint64_t last = before - 1; last != engine.repeated_steps();) {
      last = engine.repeated_steps();
      const double cost = next();
      if (last == engine.repeated_steps()) break;  // an ordinary one again
      dearest = std::max(dearest, cost);
      sum += cost;
      ++taken;
    }
    costs.push_back(dearest);
    total.push_back(sum);
    samples.push_back(taken);
    repeated.push_back(static_cast<double>(engine.repeated_steps() - before));
    while (engine.next_verdict(verdict)) {
    }
  }
  std::array<char, 96> name{};
  std::snprintf(name.data(), name.size(), "late_fix_%gs_%s_%ghz", late_s, configuration.c_str(), rate_hz);
  const double count = late_s * rate_hz;
  const double floor = median(ordinary) * count;
  const std::string all(name.data());
  done({all, "us", median(costs), floor, median(costs) / floor});
  done({all + "_total", "us", median(total), floor, median(total) / floor});
  done({all + "_steps", "steps", median(repeated), count, median(repeated) / count});
  const double least = std::ceil(count / vehicle.config().replay_steps_per_sample);
  done({all + "_samples", "samples", median(samples), least, median(samples) / least});
}

}  // namespace

void run_bench(int rounds, const std::function<void(const BenchRow&)>& done) {
  for (const char* configuration : {"gps_ins15", "hybrid25", "full"}) done(predict(configuration, rounds));
  bench_updates(rounds, done);
  bench_hydro(rounds, done);
  const int few = std::max(1, rounds / 20);
  for (const char* configuration : {"gps_ins15", "standard", "hybrid25", "full"})
    done(solve(configuration, few));
  late_fix("standard", 100.0, 2.0, few, done);
  late_fix("full", 100.0, 2.0, few, done);
  late_fix("full", 400.0, 2.0, few, done);
  // The horizon: the most that one inertial sample can cost.
  late_fix("full", 400.0, 4.99, few, done);
}

}  // namespace fathom::cli
