#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geo/so3.hpp"
#include "sim/sensor_models.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

/// When a sensor samples and when what it sampled arrives.
class Schedule {
 public:
  Schedule(const SensorCommon& config, Name sensor, std::uint64_t seed)
      : config_(config), sensor_(sensor), random_(seed, sensor.str() + ".schedule") {}

  [[nodiscard]] double next_s() const {
    return config_.phase_s + static_cast<double>(count_) / config_.rate_hz;
  }
  [[nodiscard]] bool due(double until_s) const { return config_.enabled && next_s() <= until_s + 1e-9; }

  struct Slot {
    double t_s = 0.0;
    double latency_s = 0.0;
    bool lost = false;
  };
  /// The next sample's slot; draws its latency and its loss whatever happens to it.
  Slot take() {
    Slot slot;
    slot.t_s = next_s();
    slot.latency_s = config_.latency_s + random_.uniform(0.0, config_.jitter_s);
    slot.lost = random_.chance(config_.dropout_probability);
    ++count_;
    return slot;
  }
  void stamp(SampleHeader& header, const Simulation::Options& options, double t_s, double latency_s) {
    header.vehicle = options.vehicle;
    header.sensor = sensor_;
    header.stamp_ns = options.epoch_ns + from_seconds(t_s);
    // The messages of one device leave in order.
    header.received_ns = std::max(header.stamp_ns + from_seconds(latency_s), last_received_ns_);
    last_received_ns_ = header.received_ns;
    header.sequence = sequence_++;
  }

 private:
  SensorCommon config_;
  Name sensor_;
  Random random_;
  std::uint64_t count_ = 0;
  std::uint64_t sequence_ = 0;
  TimeNs last_received_ns_ = 0;
};

}  // namespace

struct Simulation::Impl {
  Impl(const Scenario& s, const Options& o)
      : options(o),
        sensors(s.sensors),
        truth(s, o.seed),
        imu(sensors.imu, o.seed),
        gps(sensors.gps, s.environment, o.seed),
        dvl(sensors.dvl, o.seed),
        depth(sensors.depth, o.seed),
        heading(sensors.heading, s.environment, o.seed),
        usbl(sensors.usbl, s, o.seed),
        propulsion(sensors.propulsion, o.seed),
        fins(sensors.fins, o.seed),
        airspeed(sensors.airspeed, s.environment, o.seed),
        imu_schedule(sensors.imu, "imu", o.seed),
        gps_schedule(sensors.gps, "gps", o.seed),
        dvl_schedule(sensors.dvl, "dvl", o.seed),
        depth_schedule(sensors.depth, "depth", o.seed),
        heading_schedule(sensors.heading, "heading", o.seed),
        usbl_schedule(sensors.usbl, "usbl", o.seed),
        propulsion_schedule(sensors.propulsion, "propulsion", o.seed),
        fins_schedule(sensors.fins, "fins", o.seed),
        airspeed_schedule(sensors.airspeed, "airspeed", o.seed) {}

  void advance(std::vector<Measurement>& out) {
    const TruthPoint before = truth.point();
    ++intervals;
    const double now_s = static_cast<double>(intervals) / sensors.imu.rate_hz;
    const ImuTruth interval = truth.advance_to(now_s);
    const TruthPoint& now = truth.point();
    gps.observe(now);
    const std::size_t first = out.size();

    if (sensors.imu.enabled) {
      const auto slot = imu_schedule.take();
      ImuSample sample = imu.sample(interval, now);
      if (!slot.lost && !inside(sensors.imu.dropouts, now_s)) {
        imu_schedule.stamp(sample.header, options, now_s, slot.latency_s);
        out.emplace_back(sample);
      }
    }
    const auto sampled = [&](Schedule& schedule, const std::vector<Window>& silent, auto&& measure) {
      while (schedule.due(now_s)) {
        const auto slot = schedule.take();
        auto sample = measure(interpolate(before, now, std::max(slot.t_s, before.t_s)));
        if (!sample || slot.lost || inside(silent, slot.t_s)) continue;
        schedule.stamp(sample->header, options, slot.t_s, slot.latency_s);
        out.emplace_back(*sample);
      }
    };
    // Receivers without a fix and DVLs without the bottom go on talking.
    static const std::vector<Window> never;
    sampled(gps_schedule, never, [&](const TruthPoint& at) { return std::optional(gps.sample(at)); });
    while (dvl_schedule.due(now_s)) {
      const auto slot = dvl_schedule.take();
      const TruthPoint at = interpolate(before, now, std::max(slot.t_s, before.t_s));
      DvlSample bottom = dvl.sample(at);
      auto layer = dvl.water_layer(at);
      if (slot.lost) continue;
      dvl_schedule.stamp(bottom.header, options, slot.t_s, slot.latency_s);
      out.emplace_back(bottom);
      if (!layer) continue;
      dvl_schedule.stamp(layer->header, options, slot.t_s, slot.latency_s);
      out.emplace_back(*layer);
    }
    sampled(depth_schedule, sensors.depth.dropouts, [&](const TruthPoint& at) { return depth.sample(at); });
    sampled(heading_schedule, sensors.heading.dropouts,
            [&](const TruthPoint& at) { return std::optional(heading.sample(at)); });
    sampled(propulsion_schedule, sensors.propulsion.dropouts,
            [&](const TruthPoint& at) { return std::optional(propulsion.sample(at)); });
    sampled(fins_schedule, sensors.fins.dropouts,
            [&](const TruthPoint& at) { return std::optional(fins.sample(at)); });
    sampled(airspeed_schedule, sensors.airspeed.dropouts,
            [&](const TruthPoint& at) { return std::optional(airspeed.sample(at)); });
    while (usbl_schedule.due(now_s)) {
      const auto slot = usbl_schedule.take();
      auto sample = usbl.sample(interpolate(before, now, std::max(slot.t_s, before.t_s)));
      const double latency_s = usbl.latency_s();
      if (!sample || slot.lost || inside(sensors.usbl.dropouts, slot.t_s)) continue;
      usbl_schedule.stamp(sample->header, options, slot.t_s, latency_s);
      out.emplace_back(*sample);
    }
    std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                     [](const Measurement& a, const Measurement& b) {
                       return header_of(a).stamp_ns < header_of(b).stamp_ns;
                     });
  }

  Options options;
  SensorSuite sensors;
  TruthGenerator truth;
  std::uint64_t intervals = 0;
  ImuModel imu;
  GpsModel gps;
  DvlModel dvl;
  DepthModel depth;
  HeadingModel heading;
  UsblModel usbl;
  PropulsionModel propulsion;
  FinsModel fins;
  AirspeedModel airspeed;
  Schedule imu_schedule, gps_schedule, dvl_schedule, depth_schedule, heading_schedule, usbl_schedule,
      propulsion_schedule, fins_schedule, airspeed_schedule;
};

Simulation::Simulation(const Scenario& scenario, const Options& options)
    : impl_(std::make_unique<Impl>(scenario, options)) {}
Simulation::~Simulation() = default;

void Simulation::advance(std::vector<Measurement>& out) {
  impl_->advance(out);
}

double Simulation::time_s() const {
  return impl_->truth.point().t_s;
}

Truth Simulation::truth() const {
  const TruthPoint& now = impl_->truth.point();
  Truth out;
  out.header.vehicle = impl_->options.vehicle;
  out.header.sensor = "reference";
  out.header.stamp_ns = impl_->options.epoch_ns + from_seconds(now.t_s);
  out.header.received_ns = out.header.stamp_ns;
  out.header.sequence = impl_->intervals;
  out.latitude_rad = now.latitude_rad;
  out.longitude_rad = now.longitude_rad;
  out.altitude_m = now.altitude_m;
  out.velocity_N_m_s = geo::arr(now.v_N_m_s);
  out.rpy_rad = geo::arr(rpy_of(now.q_NB));
  out.gps_available = impl_->sensors.gps.enabled && impl_->gps.available();
  return out;
}

}  // namespace fathom::sim
