#include "cli/bench_cases.hpp"

#include <optional>

#include "cli/bench_floor.hpp"
#include "cli/bench_hydro.hpp"
#include "cli/bench_vehicle.hpp"
#include "cli/command.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/core.hpp"

namespace fathom::cli {
namespace {

using estimation::Core;
using estimation::Setup;

constexpr int kPredictions = 400;
constexpr int kUpdates = 40;

/// A navigator that has been under way for a while, with the covariance that this makes: everything is
/// correlated with everything that can be.
Core settled(const Setup& setup, const BenchVehicle& vehicle) {
  Core core(setup);
  core.start(vehicle.start(), kNsPerSecond);
  estimation::ImuStep step;
  step.increments.dt_s = 0.01;
  for (int k = 0; k < 3000; ++k) {
    step.from_ns = core.now_ns();
    step.to_ns = step.from_ns + 10'000'000;
    step.increments.dtheta_rad = {1e-4, 2e-4, 2e-3};
    step.increments.dv_m_s = {1e-3, -2e-3, -0.098};
    step.increments.dtheta_before_rad = step.increments.dtheta_rad;
    step.increments.dv_before_m_s = step.increments.dv_m_s;
    core.advance(step, step.to_ns);
    core.finish(step);
  }
  return core;
}

BenchRow predict(const std::string& configuration, int rounds) {
  const BenchVehicle vehicle(configuration, 100.0);
  const Setup setup(vehicle.config());
  const Core base = settled(setup, vehicle);
  const auto floor = dense_floor(setup.index.size(), 3);
  Core core = base;
  estimation::ImuStep step;
  step.increments.dt_s = 0.01;
  step.increments.dtheta_rad = step.increments.dtheta_before_rad = {1e-4, 2e-4, 2e-3};
  step.increments.dv_m_s = step.increments.dv_before_m_s = {1e-3, -2e-3, -0.098};
  return compare(
      "predict_" + configuration, rounds, kPredictions,
      [&] {
        core = base;
        floor->reset();
      },
      [&] {
        step.from_ns = core.now_ns();
        step.to_ns = step.from_ns + 10'000'000;
        core.advance(step, step.to_ns);
        core.finish(step);
      },
      [&] { floor->predict(); });
}

/// A sample with which a model of this source can do something.
std::optional<estimation::AnySample> sample_of(SourceKind source, const geo::Geodetic& at) {
  switch (source) {
    case SourceKind::gps: {
      GpsSample s;
      s.fix = GpsFix::fix_3d;
      s.latitude_rad = at.latitude_rad;
      s.longitude_rad = at.longitude_rad;
      s.altitude_m = at.altitude_m;
      s.velocity_N_m_s = {1.7, 0.9, 0.0};
      return s;
    }
    case SourceKind::dvl: {
      DvlSample s;
      s.velocity_D_m_s = {2.0, 0.1, 0.0};
      return s;
    }
    case SourceKind::depth: {
      DepthSample s;
      s.depth_m = 20.0;
      return s;
    }
    case SourceKind::heading: {
      HeadingSample s;
      s.heading_rad = 0.5;
      return s;
    }
    case SourceKind::usbl: {
      UsblSample s;
      s.latitude_rad = at.latitude_rad;
      s.longitude_rad = at.longitude_rad;
      s.depth_m = 20.0;
      s.sigma_m = 2.0;
      return s;
    }
    case SourceKind::airspeed: {
      AirspeedSample s;
      s.airspeed_m_s = 20.0;
      return s;
    }
    case SourceKind::propulsion: {
      PropulsionSample s;
      s.rpm = 1000.0;
      return s;
    }
    default:
      return std::nullopt;
  }
}

/// A DVL that gives its beams and no vector.
estimation::AnySample beams_only() {
  DvlSample s;
  s.beam_velocity_m_s = {1.0, -1.0, 0.0, 0.0};
  s.beam_angle_rad = 0.5236;
  return s;
}

/// One aiding update of each model: its innovation and H, S, and the covariance and state behind it.
void updates(int rounds, const std::function<void(const BenchRow&)>& done) {
  const BenchVehicle vehicle("full", 100.0);
  const Setup setup(vehicle.config());
  const Core base = settled(setup, vehicle);
  estimation::ErrorFilter filter = base.filter();
  const int states = setup.index.size();
  for (const estimation::AidingEntry& entry : estimation::aiding_registry()) {
    estimation::SensorConfig sensor = estimation::default_sensor(entry.source, "sensor");
    sensor.lever_B_m = {0.4, 0.1, 0.3};
    sensor.scale_m_s_per_rpm = 0.002;
    const auto observe = [&](const estimation::AnySample& sample, estimation::Observation& out) {
      const estimation::AidingState state(setup.index, base.state(), base.rate_B_rad_s(), 0.0);
      return entry.observe({state, sensor, 0.0}, sample, out);
    };
    auto sample = sample_of(entry.source, base.state().nav.position);
    if (!sample) continue;
    estimation::Observation probe;
    if (observe(*sample, probe) != estimation::Usable::yes && entry.source == SourceKind::dvl) {
      sample = beams_only();
      sensor.use_beams = true;
      probe = {};
      (void)observe(*sample, probe);
    }
    if (probe.rows == 0) continue;
    const auto floor = dense_floor(states, probe.rows);
    bool good = true;
    done(compare(
        "update_" + std::string(entry.name) + "_full", rounds, kUpdates,
        [&] {
          filter = base.filter();
          floor->reset();
        },
        [&] {
          estimation::Observation observation;
          (void)observe(*sample, observation);
          observation.list_columns(states);
          estimation::InnovationStatistics statistics;
          filter.statistics(observation, 1.0, statistics);
          std::array<double, estimation::kMaxStates> x{};
          good = filter.update(observation, statistics, x) && good;
        },
        [&] { floor->update(); }));
    if (!good) throw Failure(ExitCode::runtime_failure, std::string("bench: ") + entry.name + ": refused");
  }
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
          while (engine.next_verdict(verdict)) used += verdict.kind == VerdictKind::used ? 1 : 0;
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

/// The one inertial sample behind a late fix, beside an ordinary one times the number of steps that lie
/// between; and how many steps were repeated, beside the steps of the delay.
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
  std::vector<double> repeated;
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
    costs.push_back(next());
    repeated.push_back(static_cast<double>(engine.repeated_steps() - before));
    while (engine.next_verdict(verdict)) {
    }
  }
  std::array<char, 96> name{};
  std::snprintf(name.data(), name.size(), "late_fix_%gs_%s_%ghz", late_s, configuration.c_str(), rate_hz);
  const double count = late_s * rate_hz;
  const double floor = median(ordinary) * count;
  done({name.data(), "us", median(costs), floor, median(costs) / floor});
  done({std::string(name.data()) + "_steps", "steps", median(repeated), count, median(repeated) / count});
}

}  // namespace

void run_bench(int rounds, const std::function<void(const BenchRow&)>& done) {
  for (const char* configuration : {"gps_ins15", "hybrid25", "full"}) done(predict(configuration, rounds));
  updates(rounds, done);
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
