#include "estimation/engine/forecaster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "estimation/aiding/constraints.hpp"

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
/// The likely one, from four instants of the memory, evenly apart, and straight ahead at first.
constexpr std::size_t kCoursesOfWheels = 6;
/// A road may be straight so long anywhere.
constexpr double kStraight_s = 20.0;

struct Uncertainty {
  double within_95 = 0.0;
  double median = 0.0;
};

Uncertainty wider(const Uncertainty& a, const Uncertainty& b) {
  return {std::max(a.within_95, b.within_95), std::max(a.median, b.median)};
}

/// Takes a measurement in without its value.
void take_in(const Setup& setup, Observation& observation, double noise_scale, ErrorFilter& filter) {
  observation.list_columns(setup.index.size());
  InnovationStatistics statistics;
  std::array<double, kMaxStates> ignored{};
  filter.statistics(observation, noise_scale, statistics);
  (void)filter.update(observation, statistics, ignored);
}

/// What holds all the time is applied so many times.
template <class Model>
void hold(const Setup& setup, const Model& model, double times, ErrorFilter& filter) {
  Observation observation;
  observe(model, setup.index, observation);
  take_in(setup, observation, 1.0 / times, filter);
}

/// When a value that grows from `low` to `high` within a step passes the limit.
void pass(double& time_s, double limit, double low, double high, double elapsed_s, double dt_s) {
  if (std::isinf(time_s) && high >= limit)
    time_s = elapsed_s + dt_s * std::max(limit - low, 0.0) / std::max(high - low, 1e-12);
}

}  // namespace

struct Forecaster::Reach {
  Uncertainty horizontal;
  Uncertainty vertical;
  Uncertainty heading;

  explicit Reach(const ErrorFilter& filter) {
    const double a = filter(0, 0);
    const double b = filter(1, 1);
    const double c = filter(0, 1);
    const double middle = 0.5 * (a + b);
    const double half = std::hypot(0.5 * (a - b), c);
    const double down = std::sqrt(std::max(filter(2, 2), 0.0));
    const double turn = std::sqrt(std::max(filter(8, 8), 0.0));
    const double larger = std::sqrt(std::max(middle + half, 0.0));
    const double smaller = std::sqrt(std::max(middle - half, 0.0));
    horizontal = {radius_95(larger, smaller), radius_50(larger, smaller)};
    vertical = {kDeviation95 * down, kDeviation50 * down};
    heading = {kDeviation95 * turn, kDeviation50 * turn};
  }
  [[nodiscard]] const Uncertainty& of(const std::string& name) const {
    if (name.starts_with("heading")) return heading;
    return name.starts_with("vertical") ? vertical : horizontal;
  }
};

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

Forecaster::Forecaster(const Setup& setup)
    : setup_(&setup),
      navigator_(setup),
      courses_(setup.config.constraints.non_holonomic.enabled ? kCoursesOfWheels : 1, Course(setup.index)) {}

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
  likely_ = -1;
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
  const MotionMemory& memory = taken_.motion;
  if (memory.size() < kLeastMemory) {
    count_ = 1;
    begin(courses_[0], -1);
    return;
  }
  count_ = courses_.size();
  // (FC-2)
  if (likely_ < 0) likely_ = memory.likely_next();
  begin(courses_[0], likely_);
  // (FC-3)
  if (count_ == 1) return;
  const auto others = static_cast<int>(count_) - 2;
  for (int i = 0; i < others; ++i)
    begin(courses_[static_cast<std::size_t>(i) + 1], i * memory.size() / others);
  begin(courses_.back(), likely_);
  courses_.back().straight_for_s = kStraight_s;
}

void Forecaster::begin(Course& course, int first) const {
  // (FC-1)
  course.filter = navigator_.filter();
  course.state = navigator_.state();
  course.ahead_s = 0.0;
  course.first = course.second = first;
  course.straight_for_s = course.turned_rad = course.turn_of_pattern_rad = 0.0;
  if (first >= 0) {
    const MotionMemory& memory = taken_.motion;
    course.turned_rad = course.turn_of_pattern_rad =
        turn_about_down_rad(memory.at(std::max(first - 1, 0)).q_NB, memory.at(memory.size() - 1).q_NB);
  }
  const NavSolution& nav = course.state.nav;
  course.straight = {};
  course.straight.q_NB = nav.q_NB;
  course.straight.v_N_m_s = nav.v_N_m_s;
  const double gravity = geo::gravity(nav.position.latitude_rad, nav.position.altitude_m);
  course.straight.force_B_m_s2 = geo::to_matrix(nav.q_NB).transpose() * Vector3d(0.0, 0.0, -gravity);
}

const MotionMemory::Second& Forecaster::next_second(Course& course) const {
  if (course.second < 0 || course.ahead_s < course.straight_for_s) return course.straight;
  const MotionMemory& memory = taken_.motion;
  if (course.second == memory.size()) {
    course.second = course.first;
    course.turned_rad += course.turn_of_pattern_rad;
  }
  return memory.at(course.second++);
}

void Forecaster::step(int lost, double dt_s) {
  for (std::size_t i = 0; i < count_; ++i) step(courses_[i], lost, dt_s);
}

void Forecaster::step(Course& course, int lost, double dt_s) const {
  const MotionMemory::Second& motion = next_second(course);
  NavSolution& nav = course.state.nav;
  nav.q_NB = geo::exp({0.0, 0.0, course.turned_rad}) * motion.q_NB;
  nav.v_N_m_s = Eigen::AngleAxisd(course.turned_rad, Vector3d::UnitZ()) * motion.v_N_m_s;
  const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
  ProcessNoise noise = setup_->process_noise(c, SquaredInputs(c, motion.rate_B_rad_s, motion.force_B_m_s2));
  navigator_.estimate().motion_noise.widen(setup_->imu_noise, noise);
  course.filter.propagate(NavTransition(setup_->index, nav, motion.rate_B_rad_s, motion.force_B_m_s2, dt_s),
                          noise);
  navigator_.drive_biases(course.filter, course.ahead_s, dt_s);
  course.ahead_s += dt_s;
  const AidingState state(setup_->index, course.state, motion.rate_B_rad_s, 0.0, motion.force_B_m_s2);
  constrain(course, state, dt_s);
  if (lost == kAll) return;
  for (int i = 0; i < static_cast<int>(setup_->config.sensors.size()); ++i) {
    if (i == lost) continue;
    aid(course, i, i, navigator_.sensor(i), state, dt_s);
    if (const Instrument* layer = navigator_.water_layer(i))
      aid(course, i, kMaxSensors + setup_->water_layer[static_cast<std::size_t>(i)], *layer, state, dt_s);
  }
}

void Forecaster::constrain(Course& course, const AidingState& state, double dt_s) const {
  for_each_constraint(setup_->config.constraints, [&](double rate_hz, const auto& model_of) {
    hold(*setup_, model_of(state), rate_hz * dt_s, course.filter);
  });
}

void Forecaster::aid(Course& course, int sensor, int instrument, const Instrument& known,
                     const AidingState& state, double dt_s) const {
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
                          .position_covariance_N_m2 = course.filter.block3(0, 0),
                          .gps_bias_sigma_N_m = navigator_.gps_bias_sigma_N_m()};
  Observation observation;
  for (const AidingEntry& entry : aiding_registry())
    if (entry.source == config.kind)
      (void)entry.observe(input, taken_.last[static_cast<std::size_t>(instrument)], observation);
  if (observation.rows == 0) return;
  if (config.max_noise_factor > 1.0 && !modelled) known.noise.widen(observation);
  take_in(*setup_, observation, kStep_s / dt_s, course.filter);
}

Forecaster::Reach Forecaster::reach() const {
  Reach out(courses_[0].filter);
  for (std::size_t i = 1; i < count_; ++i) {
    const Reach other(courses_[i].filter);
    out.horizontal = wider(out.horizontal, other.horizontal);
    out.vertical = wider(out.vertical, other.vertical);
    out.heading = wider(out.heading, other.heading);
  }
  return out;
}

double Forecaster::horizontal_95_m(double after_s) {
  if (!navigator_.navigating() || !std::isfinite(after_s)) return kUnknown;
  begin();
  for (double elapsed = 0.0; elapsed < after_s;) {
    const double dt = std::min(kStep_s, after_s - elapsed);
    step(kNone, dt);
    elapsed += dt;
  }
  return reach().horizontal.within_95;
}

void Forecaster::follow(int lost, Forecast& out, std::uint32_t first) {
  const auto& limits = setup_->config.forecast_limits;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  begin();
  const Reach start = reach();
  for (std::size_t i = 0; i < limits.size(); ++i) {
    ForecastLimit& limit = out.limits[first + i];
    limit = {};
    limit.name = std::string_view(limits[i].name);
    if (lost == kAll) limit.without = "all";
    if (lost >= 0)
      limit.without = std::string_view(setup_->config.sensors[static_cast<std::size_t>(lost)].sensor);
    limit.limit = limits[i].limit;
    const Uncertainty& now = start.of(limits[i].name);
    limit.now = now.within_95;
    limit.time_to_limit_s = now.within_95 >= limit.limit ? 0.0 : kNever;
    limit.time_expected_s = now.median >= limit.limit ? 0.0 : kNever;
  }
  Reach before = start;
  bool open = true;
  for (double elapsed = 0.0; elapsed < setup_->config.forecast_span_s && open; elapsed += kStep_s) {
    step(lost, kStep_s);
    const Reach after = reach();
    open = false;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      ForecastLimit& limit = out.limits[first + i];
      const Uncertainty& low = before.of(limits[i].name);
      const Uncertainty& high = after.of(limits[i].name);
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
  const Reach now(navigator_.filter());
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
