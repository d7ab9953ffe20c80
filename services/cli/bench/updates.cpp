#include "cli/bench/updates.hpp"

#include <string>

#include "cli/bench/floor.hpp"
#include "cli/bench/vehicle.hpp"
#include "cli/command.hpp"
#include "estimation/aiding/constant_depth.hpp"
#include "estimation/aiding/non_holonomic.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/aiding/zero_velocity.hpp"

namespace fathom::cli {
namespace {

using estimation::EventSample;

constexpr int kUpdates = 40;

EventSample gps(const geo::Geodetic& at) {
  GpsSample s;
  s.fix = GpsFix::fix_3d;
  s.latitude_rad = at.latitude_rad;
  s.longitude_rad = at.longitude_rad;
  s.altitude_m = at.altitude_m;
  s.velocity_N_m_s = {1.7, 0.9, 0.0};
  return s;
}

EventSample dvl(bool beams) {
  DvlSample s;
  if (beams) {
    s.beam_velocity_m_s = {1.0, -1.0, 0.0, 0.0};
    s.beam_angle_rad = 0.5236;
  } else {
    s.velocity_D_m_s = {2.0, 0.1, 0.0};
  }
  return s;
}

EventSample usbl(const geo::Geodetic& at, const std::string& model) {
  UsblSample s;
  s.sigma_m = 2.0;
  s.station_latitude_rad = at.latitude_rad + 2e-5;
  s.station_longitude_rad = at.longitude_rad;
  s.station_depth_m = 5.0;
  s.station_rpy_rad = {0.02, -0.01, 1.0};
  if (model == "usbl_position") {
    s.latitude_rad = at.latitude_rad;
    s.longitude_rad = at.longitude_rad;
    s.depth_m = 20.0;
    return s;
  }
  s.frame = UsblFrame::vessel_frd;
  if (model == "usbl_vector") {
    s.relative_m = {-60.0, 100.0, 15.0};
    return s;
  }
  s.range_m = 128.0;
  s.bearing_rad = 2.1;
  s.depression_rad = 0.12;
  return s;
}

/// A sample with which this model can do something.
EventSample sample_for(const estimation::AidingEntry& entry, const geo::Geodetic& at) {
  const std::string model = entry.name;
  switch (entry.source) {
    case SourceKind::gps:
      return gps(at);
    case SourceKind::dvl:
      return dvl(model == "dvl_beams");
    case SourceKind::usbl:
      return usbl(at, model);
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
    case SourceKind::airspeed: {
      AirspeedSample s;
      s.airspeed_m_s = 20.0;
      s.baro_altitude_m = 30.0;
      return s;
    }
    default: {
      PropulsionSample s;
      s.rpm = 1000.0;
      return s;
    }
  }
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
