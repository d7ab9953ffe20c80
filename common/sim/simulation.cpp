#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "geo/so3.hpp"
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
    const TimeNs valid_ns = options.epoch_ns + from_seconds(t_s);
    header.stamp_ns = valid_ns + from_seconds(config_.stamp_late_s);
    // The messages of one device leave in order.
    header.received_ns = std::max(valid_ns + from_seconds(latency_s), last_received_ns_);
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

template <class Sample>
[[nodiscard]] auto make_model(const Scenario& scenario, std::uint64_t seed) {
  using Model = typename ModelOf<Sample>::type;
  const SimulatedSensor<Sample>& config = scenario.sensors.of<Sample>();
  if constexpr (std::is_constructible_v<Model, decltype(config), const Scenario&, std::uint64_t>) {
    return Model(config, scenario, seed);
  } else if constexpr (std::is_constructible_v<Model, decltype(config), const EnvironmentConfig&,
                                               std::uint64_t>) {
    return Model(config, scenario.environment, seed);
  } else {
    return Model(config, seed);
  }
}

/// A sensor of a kind under way.
template <class Sample>
struct Instrument {
  Instrument(const Scenario& scenario, std::uint64_t seed)
      : config(scenario.sensors.of<Sample>()),
        model(make_model<Sample>(scenario, seed)),
        schedule(config, Name(KindOf<Sample>::kWord), seed) {}

  SimulatedSensor<Sample> config;
  typename ModelOf<Sample>::type model;
  Schedule schedule;
};

template <class... Samples>
struct InstrumentsOf : Instrument<Samples>... {
  InstrumentsOf(const Scenario& scenario, std::uint64_t seed) : Instrument<Samples>(scenario, seed)... {}
};
using Instruments = Kinds::Samples<InstrumentsOf>;

/// One interval of the inertial unit.
struct Interval {
  TruthPoint before;
  ImuTruth between;
  TruthPoint now;
};

}  // namespace

struct Simulation::Impl {
  Impl(const Scenario& scenario, const Options& o)
      : options(o),
        imu_rate_hz(scenario.sensors.of<ImuSample>().rate_hz),
        truth(scenario, o.seed),
        instruments(scenario, o.seed) {}

  template <class Sample>
  [[nodiscard]] Instrument<Sample>& of() {
    return instruments;
  }

  void advance(std::vector<Measurement>& out) {
    Interval interval;
    interval.before = truth.point();
    ++intervals;
    interval.between = truth.advance_to(static_cast<double>(intervals) / imu_rate_hz);
    interval.now = truth.point();
    const std::size_t first = out.size();
    for_each_kind([&](auto kind) { take(of<typename decltype(kind)::Sample>(), interval, out); });
    std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                     [](const Measurement& a, const Measurement& b) {
                       return header_of(a).stamp_ns < header_of(b).stamp_ns;
                     });
  }

  /// The inertial unit: one sample an interval.
  void take(Instrument<ImuSample>& imu, const Interval& interval, std::vector<Measurement>& out) const {
    if (!imu.config.enabled) return;
    const auto slot = imu.schedule.take();
    ImuSample sample = imu.model.sample(interval.between, interval.now);
    const double now_s = static_cast<double>(intervals) / imu_rate_hz;
    if (slot.lost || inside(imu.config.dropouts, now_s)) return;
    imu.schedule.stamp(sample.header, options, now_s, slot.latency_s);
    out.emplace_back(sample);
  }

  template <class Sample>
  void take(Instrument<Sample>& sensor, const Interval& interval, std::vector<Measurement>& out) const {
    auto& model = sensor.model;
    if constexpr (requires { model.observe(interval.now); }) model.observe(interval.now);
    const double now_s = static_cast<double>(intervals) / imu_rate_hz;
    while (sensor.schedule.due(now_s)) {
      auto slot = sensor.schedule.take();
      const TruthPoint at =
          interpolate(interval.before, interval.now, std::max(slot.t_s, interval.before.t_s));
      std::optional<Sample> sample = model.sample(at);
      // A model may know better how long its sample takes, and may measure twice at once.
      if constexpr (requires { model.latency_s(); }) slot.latency_s = model.latency_s();
      std::optional<Sample> second;
      if constexpr (requires { model.second(at); }) second = model.second(at);
      const bool silent = !sensor.config.kTalksOn && inside(sensor.config.dropouts, slot.t_s);
      if (!sample || slot.lost || silent) continue;
      for (auto* one : {&sample, &second}) {
        if (!*one) continue;
        sensor.schedule.stamp((*one)->header, options, slot.t_s, slot.latency_s);
        out.emplace_back(**one);
      }
    }
  }

  Options options;
  double imu_rate_hz;
  TruthGenerator truth;
  std::uint64_t intervals = 0;
  Instruments instruments;
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
  const Instrument<GpsSample>& gps = impl_->of<GpsSample>();
  out.gps_available = gps.config.enabled && gps.model.available();
  return out;
}

}  // namespace fathom::sim
