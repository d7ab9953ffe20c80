#include "cli/bench/updates.hpp"

#include <optional>
#include <string>

#include "cli/bench/floor.hpp"
#include "cli/bench/samples.hpp"
#include "cli/bench/vehicle.hpp"
#include "cli/command.hpp"
#include "estimation/aiding/constraints.hpp"
#include "estimation/aiding/non_holonomic.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/aiding/zero_velocity.hpp"

namespace fathom::cli {
namespace {

using estimation::EventSample;

constexpr int kUpdates = 40;

/// A sample with which this model can do something.
EventSample sample_for(const estimation::AidingEntry& entry, const geo::Geodetic& at) {
  std::optional<EventSample> sample;
  for_each_aiding_kind([&](auto kind) {
    if (kind.kSource == entry.source) sample = bench_sample<typename decltype(kind)::Sample>(entry.name, at);
  });
  return sample.value();
}

/// What is measured: `observe` makes the rows, the filter does the rest.
class Updates {
 public:
  Updates(int rounds, const std::function<void(const BenchRow&)>& done)
      : rounds_(rounds),
        done_(done),
        vehicle_("full", 100.0),
        setup_(vehicle_.config()),
        base_(settled(setup_, vehicle_)) {}

  [[nodiscard]] const estimation::Navigator& base() const { return base_; }
  [[nodiscard]] estimation::AidingState state() const {
    return {setup_.index, base_.state(), base_.rate_B_rad_s(), 0.0, base_.force_B_m_s2()};
  }

  template <class Observe>
  void row(const std::string& model, const Observe& observe) const {
    estimation::Observation probe;
    observe(probe);
    if (probe.rows == 0) throw Failure(ExitCode::runtime_failure, "bench: " + model + ": made no rows");
    const int states = setup_.index.size();
    const auto floor = dense_floor(states, probe.rows);
    estimation::ErrorFilter filter = base_.filter();
    bool good = true;
    done_(compare(
        "update_" + model + "_full", rounds_, kUpdates,
        [&] {
          filter = base_.filter();
          floor->reset();
        },
        [&] {
          estimation::Observation observation;
          observe(observation);
          observation.list_columns(states);
          estimation::InnovationStatistics statistics;
          filter.statistics(observation, 1.0, statistics);
          std::array<double, estimation::kMaxStates> x{};
          good = filter.update(observation, statistics, x) && good;
        },
        [&] { floor->update(); }));
    if (!good) throw Failure(ExitCode::runtime_failure, "bench: " + model + ": refused");
  }

  /// A constraint, made from the state alone.
  template <class Model, class... Config>
  void constraint(const Config&... config) const {
    row(Model::kName, [&](estimation::Observation& out) {
      const estimation::AidingState at = state();
      estimation::observe(Model(at, config...), setup_.index, out);
    });
  }

 private:
  int rounds_;
  const std::function<void(const BenchRow&)>& done_;
  BenchVehicle vehicle_;
  estimation::Setup setup_;
  estimation::Navigator base_;
};

}  // namespace

void bench_updates(int rounds, const std::function<void(const BenchRow&)>& done) {
  const Updates updates(rounds, done);
  for (const estimation::AidingEntry& entry : estimation::aiding_registry()) {
    estimation::SensorConfig sensor = estimation::default_sensor(entry.source, "sensor");
    sensor.lever_B_m = {0.4, 0.1, 0.3};
    sensor.scale_m_s_per_rpm = 0.002;
    sensor.sideslip_sigma_rad = sensor.attack_sigma_rad = 0.05;
    sensor.baro_sigma_m = 1.0;
    sensor.use_beams = std::string(entry.name) == "dvl_beams";
    const EventSample sample = sample_for(entry, updates.base().state().nav.position);
    const auto observe = [&](estimation::Observation& out) {
      const estimation::AidingState at = updates.state();
      return entry.observe({at, sensor, 0.0}, sample, out);
    };
    estimation::Observation probe;
    // The vehicle model has no row here: it needs a past (hydro.hpp).
    if (observe(probe) != estimation::Usable::not_estimated) updates.row(entry.name, observe);
  }
  estimation::NonHolonomicConfig wheels;
  wheels.lever_B_m = {-1.1, 0.2, 0.6};
  updates.constraint<estimation::NonHolonomic>(wheels);
  updates.constraint<estimation::ConstantDepth>(0.1);
  updates.constraint<estimation::ZeroVelocity>(0.02);
}

}  // namespace fathom::cli
