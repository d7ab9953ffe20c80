#include "estimation/forecaster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::estimation {
namespace {

constexpr double kGrowthSpan_s = 60.0;
constexpr double kDeviation95 = 1.959963984540054;
/// An aiding sensor is taken to give this many independent measurements a second.
constexpr double kIndependentRate_hz = 1.0;

double step_length(double elapsed_s) {
  if (elapsed_s < 30.0) return 1.0;
  if (elapsed_s < 60.0) return 2.0;
  return elapsed_s < 300.0 ? 5.0 : 10.0;
}

struct Now {
  double horizontal = 0.0;
  double vertical = 0.0;
  double heading = 0.0;
};

Now measure(const ErrorFilter& filter) {
  const double a = filter(0, 0);
  const double b = filter(1, 1);
  const double c = filter(0, 1);
  const double middle = 0.5 * (a + b);
  const double half = std::hypot(0.5 * (a - b), c);
  return {radius_95(std::sqrt(std::max(middle + half, 0.0)), std::sqrt(std::max(middle - half, 0.0))),
          kDeviation95 * std::sqrt(std::max(filter(2, 2), 0.0)),
          kDeviation95 * std::sqrt(std::max(filter(8, 8), 0.0))};
}

double of(const Now& now, const std::string& name) {
  if (name.starts_with("heading")) return now.heading;
  return name.starts_with("vertical") ? now.vertical : now.horizontal;
}

}  // namespace

double radius_95(double larger_sigma, double smaller_sigma) {
  if (!(larger_sigma > 0.0)) return 0.0;
  const double c = smaller_sigma / larger_sigma;
  return larger_sigma * (1.960790 + c * (0.004071 + c * (0.114276 + c * 0.371625)));
}

Forecaster::Forecaster(const Setup& setup) : setup_(&setup), filter_(setup.index.size()) {}

void Forecaster::remember(int sensor, const AnySample& sample) {
  last_[static_cast<std::size_t>(sensor)] = sample;
}

bool Forecaster::aids(const Core& core, int sensor) const {
  const SensorConfig& config = setup_->config.sensors[static_cast<std::size_t>(sensor)];
  if (config.kind == SourceKind::gps || config.kind == SourceKind::usbl) return false;
  const TimeNs used = core.sensor(sensor).used_ns;
  return core.sensor(sensor).enabled && used != 0 &&
         to_seconds(core.now_ns() - used) <= setup_->config.velocity_timeout_s;
}

void Forecaster::step(double dt_s) {
  filter_.propagate(NavTransition(setup_->index, nav_, Eigen::Vector3d::Zero(), force_B_, dt_s), noise_);
  InnovationStatistics statistics;
  std::array<double, kMaxStates> ignored{};
  for (std::size_t i = 0; i < setup_->config.sensors.size(); ++i) {
    if (observations_[i].rows == 0) continue;
    filter_.statistics(observations_[i], 1.0 / (kIndependentRate_hz * dt_s), statistics);
    (void)filter_.update(observations_[i], statistics, ignored);
  }
}

void Forecaster::fill(const Core& core, Forecast& out) {
  const auto& limits = setup_->config.forecast_limits;
  out.limit_count = static_cast<std::uint32_t>(std::min<std::size_t>(limits.size(), Forecast::kMaxLimits));
  for (std::size_t i = 0; i < out.limit_count; ++i) {
    out.limits[i] = ForecastLimit{};
    out.limits[i].name = std::string_view(limits[i].name);
    out.limits[i].limit = limits[i].limit;
  }
  out.horizontal_95_m = out.vertical_95_m = out.heading_95_rad = out.horizontal_growth_m_s = kUnknown;
  if (!core.navigating()) return;

  // (FC-1): straight ahead, unaccelerated.
  const NavSolution& nav = core.state().nav;
  const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
  const Eigen::Vector3d force_N(0.0, 0.0, -geo::gravity(nav.position.latitude_rad, nav.position.altitude_m));
  filter_ = core.filter();
  nav_ = nav;
  force_B_ = c.transpose() * force_N;
  noise_ = core.process_noise();
  const AidingState state(setup_->index, core.state(), core.rate_B_rad_s(), 0.0);
  for (std::size_t i = 0; i < setup_->config.sensors.size(); ++i) {
    observations_[i].rows = 0;
    if (!aids(core, static_cast<int>(i))) continue;
    observations_[i] = Observation{};
    // The last sample is about one second old in the forecast's eyes, whatever its rate.
    const bool modelled = setup_->velocity_model && setup_->config.sensors[i].kind == SourceKind::propulsion;
    const AidingInput input{state, setup_->config.sensors[i], setup_->config.states.surface_altitude_m,
                            &setup_->config.vehicle_model, modelled ? &core.water_velocity() : nullptr};
    for (const AidingEntry& entry : aiding_registry())
      if (entry.source == setup_->config.sensors[i].kind)
        (void)entry.observe(input, last_[i], observations_[i]);
    observations_[i].list_columns(setup_->index.size());
  }

  const Now start = measure(filter_);
  out.horizontal_95_m = start.horizontal;
  out.vertical_95_m = start.vertical;
  out.heading_95_rad = start.heading;
  for (std::size_t i = 0; i < out.limit_count; ++i) {
    ForecastLimit& limit = out.limits[i];
    limit.now = of(start, limits[i].name);
    limit.time_to_limit_s = limit.now >= limit.limit ? 0.0 : std::numeric_limits<double>::infinity();
  }
  Now before = start;
  double elapsed = 0.0;
  while (elapsed < setup_->config.forecast_span_s) {
    const double dt = step_length(elapsed);
    step(dt);
    const Now after = measure(filter_);
    for (std::size_t i = 0; i < out.limit_count; ++i) {
      ForecastLimit& limit = out.limits[i];
      const double low = of(before, limits[i].name);
      const double high = of(after, limits[i].name);
      if (std::isinf(limit.time_to_limit_s) && high >= limit.limit)
        limit.time_to_limit_s = elapsed + dt * (limit.limit - low) / std::max(high - low, 1e-12);
    }
    elapsed += dt;
    before = after;
    if (elapsed <= kGrowthSpan_s) out.horizontal_growth_m_s = (after.horizontal - start.horizontal) / elapsed;
  }
}

}  // namespace fathom::estimation
