#include "estimation/engine/forecaster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kGrowthSpan_s = 60.0;
constexpr double kDeviation95 = 1.959963984540054;
constexpr double kDeviation50 = 0.674489750196082;
/// Less of it is no pattern yet.
constexpr int kLeastMemory = 10;
/// An aiding sensor is taken to give one independent measurement in each.
constexpr double kStep_s = 1.0;

/// What 95 % and half of such vehicles would not exceed.
struct Uncertainty {
  double within_95 = 0.0;
  double median = 0.0;
};
struct Now {
  Uncertainty horizontal;
  Uncertainty vertical;
  Uncertainty heading;
};

Now measure(const ErrorFilter& filter) {
  const double a = filter(0, 0);
  const double b = filter(1, 1);
  const double c = filter(0, 1);
  const double middle = 0.5 * (a + b);
  const double half = std::hypot(0.5 * (a - b), c);
  const double vertical = std::sqrt(std::max(filter(2, 2), 0.0));
  const double heading = std::sqrt(std::max(filter(8, 8), 0.0));
  const double larger = std::sqrt(std::max(middle + half, 0.0));
  const double smaller = std::sqrt(std::max(middle - half, 0.0));
  return {{radius_95(larger, smaller), radius_50(larger, smaller)},
          {kDeviation95 * vertical, kDeviation50 * vertical},
          {kDeviation95 * heading, kDeviation50 * heading}};
}

const Uncertainty& of(const Now& now, const std::string& name) {
  if (name.starts_with("heading")) return now.heading;
  return name.starts_with("vertical") ? now.vertical : now.horizontal;
}

/// When a value that grows from `low` to `high` within a step passes the limit.
void pass(double& time_s, double limit, double low, double high, double elapsed_s, double dt_s) {
  if (std::isinf(time_s) && high >= limit)
    time_s = elapsed_s + dt_s * std::max(limit - low, 0.0) / std::max(high - low, 1e-12);
}

}  // namespace

double radius_95(double larger_sigma, double smaller_sigma) {
  if (!(larger_sigma > 0.0)) return 0.0;
  const double c = smaller_sigma / larger_sigma;
  return larger_sigma * (1.960790 + c * (0.004071 + c * (0.114276 + c * 0.371625)));
}

double radius_50(double larger_sigma, double smaller_sigma) {
  if (!(larger_sigma > 0.0)) return 0.0;
  const double c = smaller_sigma / larger_sigma;
  return larger_sigma * (0.671956 + c * (0.011405 + c * (1.013712 - c * 0.523462)));
}

Forecaster::Forecaster(const Setup& setup) : setup_(&setup), navigator_(setup), filter_(setup.index) {}

// What was refused, or has nothing to say, will not aid.
void Forecaster::remember(int sensor, const EventSample& sample) {
  const int layer = setup_->water_layer[static_cast<std::size_t>(sensor)];
  const int instrument = is_of_water(sample) && layer >= 0 ? kMaxSensors + layer : sensor;
  const auto at = static_cast<std::size_t>(instrument);
  // One that came late does not replace what is younger.
  if (past_.remembered[at] && header_of(past_.last[at]).stamp_ns > header_of(sample).stamp_ns) return;
  past_.last[at] = sample;
  past_.remembered[at] = true;
}

void Forecaster::take(const Navigator& navigator) {
  navigator_ = navigator;
  navigator_.record_to(nullptr);
  navigator_.follow();
  taken_ = past_;
  first_ = -1;
}

bool Forecaster::aids(int sensor, int instrument, const Instrument& known) const {
  const SensorConfig& config = setup_->config.sensors[static_cast<std::size_t>(sensor)];
  const auto at = static_cast<std::size_t>(instrument);
  // What a restored state was aided by may not have been heard here yet.
  if (!taken_.remembered[at] || may_place(config, taken_.last[at])) return false;
  return navigator_.sensor(sensor).enabled && known.used_ns != 0 &&
         to_seconds(navigator_.now_ns() - known.used_ns) <= setup_->config.velocity_timeout_s;
}

bool Forecaster::aids(int sensor) const {
  const Instrument* const layer = navigator_.water_layer(sensor);
  const int number = setup_->water_layer[static_cast<std::size_t>(sensor)];
  return aids(sensor, sensor, navigator_.sensor(sensor)) ||
         (layer != nullptr && aids(sensor, kMaxSensors + number, *layer));
}

void Forecaster::begin() {
  // (FC-1)
  filter_ = navigator_.filter();
  state_ = navigator_.state();
  const NavSolution& nav = state_.nav;
  ahead_s_ = 0.0;
  turned_rad_ = turn_of_pattern_rad_ = 0.0;
  const MotionMemory& memory = taken_.motion;
  if (memory.size() >= kLeastMemory) {
    // (FC-2)
    if (first_ < 0) first_ = memory.likely_next();
    second_ = first_;
    turned_rad_ = turn_of_pattern_rad_ =
        turn_about_down_rad(memory.at(std::max(first_ - 1, 0)).q_NB, memory.at(memory.size() - 1).q_NB);
  }
  still_ = {};
  still_.q_NB = nav.q_NB;
  still_.v_N_m_s = nav.v_N_m_s;
  const double gravity = geo::gravity(nav.position.latitude_rad, nav.position.altitude_m);
  still_.force_B_m_s2 = geo::to_matrix(nav.q_NB).transpose() * Vector3d(0.0, 0.0, -gravity);
}

const MotionMemory::Second& Forecaster::next_second() {
  const MotionMemory& memory = taken_.motion;
  if (memory.size() < kLeastMemory) return still_;
  if (second_ == memory.size()) {
    second_ = first_;
    turned_rad_ += turn_of_pattern_rad_;
  }
  return memory.at(second_++);
}

void Forecaster::step(int lost, double dt_s) {
  const MotionMemory::Second& motion = next_second();
  NavSolution& nav = state_.nav;
  nav.q_NB = geo::exp({0.0, 0.0, turned_rad_}) * motion.q_NB;
  nav.v_N_m_s = Eigen::AngleAxisd(turned_rad_, Vector3d::UnitZ()) * motion.v_N_m_s;
  const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
  ProcessNoise noise = setup_->process_noise(c, SquaredInputs(c, motion.rate_B_rad_s, motion.force_B_m_s2));
  navigator_.estimate().motion_noise.widen(setup_->imu_noise, noise);
  filter_.propagate(NavTransition(setup_->index, nav, motion.rate_B_rad_s, motion.force_B_m_s2, dt_s), noise);
  navigator_.drive_biases(filter_, ahead_s_, dt_s);
  ahead_s_ += dt_s;
  if (lost == kAll) return;
  const AidingState state(setup_->index, state_, motion.rate_B_rad_s, 0.0, motion.force_B_m_s2);
  for (int i = 0; i < static_cast<int>(setup_->config.sensors.size()); ++i) {
    if (i == lost) continue;
    aid(i, i, navigator_.sensor(i), state, dt_s);
    if (const Instrument* layer = navigator_.water_layer(i))
      aid(i, kMaxSensors + setup_->water_layer[static_cast<std::size_t>(i)], *layer, state, dt_s);
  }
}

void Forecaster::aid(int sensor, int instrument, const Instrument& known, const AidingState& state,
                     double dt_s) {
  if (!aids(sensor, instrument, known)) return;
  const SensorConfig& config = setup_->config.sensors[static_cast<std::size_t>(sensor)];
  // The last sample is about one second old in the forecast's eyes, whatever its rate.
  const bool modelled = setup_->velocity_model && config.kind == SourceKind::propulsion;
  const AidingInput input{.state = state,
                          .sensor = config,
                          .surface_altitude_m = setup_->config.states.surface_altitude_m,
                          .vehicle_model = &setup_->config.vehicle_model,
                          .water = modelled ? &navigator_.water_velocity() : nullptr,
                          .unused_s = dt_s,
                          .position_covariance_N_m2 = filter_.block3(0, 0),
                          .gps_bias_sigma_N_m = navigator_.gps_bias_sigma_N_m()};
  Observation observation;
  for (const AidingEntry& entry : aiding_registry())
    if (entry.source == config.kind)
      (void)entry.observe(input, taken_.last[static_cast<std::size_t>(instrument)], observation);
  if (observation.rows == 0) return;
  if (config.max_noise_factor > 1.0 && !modelled) known.noise.widen(observation);
  observation.list_columns(setup_->index.size());
  InnovationStatistics statistics;
  std::array<double, kMaxStates> ignored{};
  filter_.statistics(observation, kStep_s / dt_s, statistics);
  (void)filter_.update(observation, statistics, ignored);
}

double Forecaster::horizontal_95_m(double after_s) {
  if (!navigator_.navigating() || !std::isfinite(after_s)) return kUnknown;
  begin();
  for (double elapsed = 0.0; elapsed < after_s;) {
    const double dt = std::min(kStep_s, after_s - elapsed);
    step(kNone, dt);
    elapsed += dt;
  }
  return measure(filter_).horizontal.within_95;
}

void Forecaster::follow(int lost, Forecast& out, std::uint32_t first) {
  const auto& limits = setup_->config.forecast_limits;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  begin();
  const Now start = measure(filter_);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    ForecastLimit& limit = out.limits[first + i];
    limit = {};
    limit.name = std::string_view(limits[i].name);
    if (lost == kAll) limit.without = "all";
    if (lost >= 0)
      limit.without = std::string_view(setup_->config.sensors[static_cast<std::size_t>(lost)].sensor);
    limit.limit = limits[i].limit;
    const Uncertainty& now = of(start, limits[i].name);
    limit.now = now.within_95;
    limit.time_to_limit_s = now.within_95 >= limit.limit ? 0.0 : kNever;
    limit.time_expected_s = now.median >= limit.limit ? 0.0 : kNever;
  }
  Now before = start;
  bool open = true;
  for (double elapsed = 0.0; elapsed < setup_->config.forecast_span_s && open; elapsed += kStep_s) {
    step(lost, kStep_s);
    const Now after = measure(filter_);
    open = false;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      ForecastLimit& limit = out.limits[first + i];
      const Uncertainty& low = of(before, limits[i].name);
      const Uncertainty& high = of(after, limits[i].name);
      pass(limit.time_to_limit_s, limit.limit, low.within_95, high.within_95, elapsed, kStep_s);
      pass(limit.time_expected_s, limit.limit, low.median, high.median, elapsed, kStep_s);
      open = open || std::isinf(limit.time_expected_s);
    }
    before = after;
    if (lost != kNone || elapsed >= kGrowthSpan_s) continue;
    out.horizontal_growth_m_s =
        (after.horizontal.within_95 - start.horizontal.within_95) / (elapsed + kStep_s);
    open = true;
  }
}

void Forecaster::fill(Forecast& out) {
  const auto& limits = setup_->config.forecast_limits;
  const auto count = static_cast<std::uint32_t>(limits.size());
  out.horizontal_95_m = out.vertical_95_m = out.heading_95_rad = out.horizontal_growth_m_s = kUnknown;
  if (!navigator_.navigating()) {
    out.limit_count = count;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      out.limits[i] = {};
      out.limits[i].name = std::string_view(limits[i].name);
      out.limits[i].limit = limits[i].limit;
    }
    return;
  }
  const Now now = measure(navigator_.filter());
  out.horizontal_95_m = now.horizontal.within_95;
  out.vertical_95_m = now.vertical.within_95;
  out.heading_95_rad = now.heading.within_95;
  follow(kNone, out, 0);
  out.limit_count = count;
  const auto more = [&](int lost) {
    if (out.limit_count + count > Forecast::kMaxLimits) return;
    follow(lost, out, out.limit_count);
    out.limit_count += count;
  };
  int aiding = 0;
  for (int i = 0; i < static_cast<int>(setup_->config.sensors.size()); ++i) aiding += aids(i) ? 1 : 0;
  if (aiding > 0) more(kAll);
  for (int i = 0; aiding > 1 && i < static_cast<int>(setup_->config.sensors.size()); ++i)
    if (aids(i)) more(i);
}

}  // namespace fathom::estimation
