#include "cli/solve/outage.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "cli/command.hpp"
#include "cli/solve/smooth.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"

namespace fathom::cli {
namespace {

constexpr double kDefaultStart_s = 60.0;  // after motion begins
constexpr std::array<double, 4> kPooledStarts_s{0.0, 13.0, 26.0,
                                                39.0};  // so that windows meet other manoeuvres
constexpr double kChiSquare95TwoDof = 5.991464547107979;
// Of random windows, and of GPS behind each.
constexpr double kShortest_s = 5.0;
constexpr double kLongest_s = 60.0;
constexpr double kLeastRecovery_s = 40.0;
constexpr double kMostRecovery_s = 70.0;
constexpr int kMostEmptyPasses = 10;
/// Shorter, a window holds no fix.
constexpr double kLeastDuration_s = 1e-3;

[[noreturn]] void refuse(const std::string& text) {
  throw Failure(ExitCode::bad_configuration, "--gps-outage: is '" + text +
                                                 "', expected T1,T2,...[@start[:recover]] in seconds, each T "
                                                 "at least 0.001, e.g. 10,20,60@110:40, or "
                                                 "random:N[@start]");
}

double seconds_in(std::string_view part, const std::string& whole) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || !(std::abs(value) < 1e7)) refuse(whole);
  return value;
}

geo::Geodetic place_of(const GpsSample& fix) {
  return {fix.latitude_rad, fix.longitude_rad, known(fix.altitude_m) ? fix.altitude_m : 0.0};
}

/// Over ground, of each fix. Where a receiver tells no velocity it is the way of the last five seconds, which
/// leaves below half a metre a second of the noise of positions.
std::vector<double> speeds_m_s(const std::vector<GpsSample>& gps) {
  constexpr DurationNs kWay_ns = 5 * kNsPerSecond;
  std::vector<double> out;
  out.reserve(gps.size());
  std::size_t before = 0;
  for (const GpsSample& fix : gps) {
    while (fix.header.stamp_ns - gps[before].header.stamp_ns > kWay_ns) ++before;
    double speed =
        fix.fix == GpsFix::none ? kUnknown : std::hypot(fix.velocity_N_m_s[0], fix.velocity_N_m_s[1]);
    const double way_s = to_seconds(fix.header.stamp_ns - gps[before].header.stamp_ns);
    if (fix.fix != GpsFix::none && !known(speed) && way_s >= 1.0)
      speed = geo::difference_N(place_of(gps[before]), place_of(fix)).head<2>().norm() / way_s;
    out.push_back(speed);
  }
  return out;
}

// Radius that 95 % of the errors stay within along the worse horizontal axis of the filter's covariance.
double predicted_95_m(const NavState& state) {
  const auto& p = state.position_covariance_N_m2;
  const double mean = 0.5 * (p[0] + p[4]);
  const double largest = mean + std::hypot(0.5 * (p[0] - p[4]), p[1]);
  return std::sqrt(kChiSquare95TwoDof * largest);
}

double fix_95_m(const config::FusionConfig& config) {
  for (const estimation::SensorConfig& sensor : config.engine.sensors)
    if (sensor.kind == SourceKind::gps)
      return std::sqrt(kChiSquare95TwoDof) * std::max(sensor.sigma[0], sensor.sigma[1]);
  return 0.0;
}

void pool(OutageFigures& figures) {
  std::vector<double> errors;
  double forecast = 0.0;
  double predicted = 0.0;
  double sum2 = 0.0;
  FixErrors inside;
  FixErrors smoothed_inside;
  for (const OutageWindow& window : figures.windows) {
    inside.add(window.inside);
    smoothed_inside.add(window.smoothed_inside);
    if (!known(window.horizontal_error_m)) continue;
    errors.push_back(window.horizontal_error_m);
    // What it is compared with is a fix, which has an error of its own.
    forecast += window.horizontal_error_m <= std::hypot(window.forecast_95_m, window.fix_95_m) ? 1.0 : 0.0;
    predicted += window.horizontal_error_m <= std::hypot(window.predicted_95_m, window.fix_95_m) ? 1.0 : 0.0;
    sum2 += window.horizontal_error_m * window.horizontal_error_m;
  }
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  figures.forecast_coverage = forecast / count;
  figures.predicted_coverage = predicted / count;
  figures.rms_m = std::sqrt(sum2 / count);
  figures.inside_rms_m = inside.rms_m();
  figures.smoothed_inside_rms_m = smoothed_inside.rms_m();
  figures.p95_m = errors[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  figures.max_m = errors.back();
}

Motion motion_in(const dataset::Dataset& data, const std::string& directory) {
  const auto motion = motion_of(data.of<GpsSample>());
  if (motion) return *motion;
  throw Failure(ExitCode::bad_input,
                directory + "/gps.csv: no fix in motion, expected a moving vehicle for --gps-outage");
}

TimeNs start_of(const OutageRequest& request, const Motion& motion, TimeNs epoch_ns) {
  return request.start_s ? epoch_ns + from_seconds(*request.start_s)
                         : motion.first_ns + from_seconds(kDefaultStart_s);
}

std::vector<GpsWindow> planned(const dataset::Dataset& data, const OutageRequest& request, double duration_s,
                               double offset_s, TimeNs epoch_ns, const std::string& directory) {
  const Motion motion = motion_in(data, directory);
  return windows(start_of(request, motion, epoch_ns) + from_seconds(offset_s), motion.last_ns,
                 from_seconds(duration_s), from_seconds(request.recover_s));
}

// Of the pass with this number, always the same.
std::vector<GpsWindow> random_windows(const dataset::Dataset& data, const OutageRequest& request, int pass,
                                      TimeNs epoch_ns, const std::string& directory) {
  const Motion motion = motion_in(data, directory);
  sim::Random random(static_cast<std::uint64_t>(pass), "outages");
  std::vector<GpsWindow> out;
  TimeNs begin = start_of(request, motion, epoch_ns) + from_seconds(random.uniform(0.0, kLongest_s));
  while (true) {
    const DurationNs length = from_seconds(random.uniform(kShortest_s, kLongest_s));
    if (begin + length > motion.last_ns) return out;
    out.push_back({begin, begin + length});
    begin += length + from_seconds(random.uniform(kLeastRecovery_s, kMostRecovery_s));
  }
}

// The fixes that were taken away in a window.
std::vector<const GpsSample*> fixes_in(const std::vector<GpsSample>& gps, const GpsWindow& window) {
  std::vector<const GpsSample*> out;
  for (const GpsSample& fix : gps)
    if (fix.fix != GpsFix::none && window.contains(fix.header.stamp_ns)) out.push_back(&fix);
  return out;
}

struct Watch {
  OutageWindow window;
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;  // of the last fix taken away
  std::vector<const GpsSample*> fixes;
  bool forecast_taken = false;
  bool done = false;
};

void take_forecast(Watch& watch, estimation::FusionEngine& engine) {
  watch.forecast_taken = true;
  Forecast forecast;
  engine.fill(forecast);
  watch.window.forecast_95_m = engine.forecast_horizontal_95_m(to_seconds(watch.end_ns - watch.begin_ns));
  for (std::uint32_t i = 0; i < forecast.limit_count; ++i)
    if (forecast.limits[i].without.empty())
      watch.window.time_to_limit_s[forecast.limits[i].name.str()] = forecast.limits[i].time_to_limit_s;
}

// One run with windows removed; appends what became of them.
void run_windows(SolveRun solve_run, const std::vector<GpsWindow>& removed, bool smooth, TimeNs epoch_ns,
                 OutageFigures& figures) {
  std::vector<Watch> watches;
  for (const GpsWindow& window : removed) {
    Watch watch;
    watch.fixes = fixes_in(solve_run.data->of<GpsSample>(), window);
    if (watch.fixes.empty()) continue;  // GPS was out by itself: nothing to compare with
    watch.begin_ns = window.begin_ns;
    watch.end_ns = watch.fixes.back()->header.stamp_ns;
    watch.window.start_s = to_seconds(window.begin_ns - epoch_ns);
    watch.window.end_s = to_seconds(watch.end_ns - epoch_ns);
    watches.push_back(std::move(watch));
  }
  solve_run.gps_removed = removed;
  Path path;
  std::size_t next = 0;
  solve_run.on_state = [&](const NavState& state, estimation::FusionEngine& engine) {
    path.add(state);
    if (next >= watches.size() || !known(state.latitude_rad)) return;
    Watch& watch = watches[next];
    if (!watch.forecast_taken && state.header.stamp_ns >= watch.begin_ns) take_forecast(watch, engine);
    if (state.header.stamp_ns < watch.end_ns) return;
    watch.window.predicted_95_m = predicted_95_m(state);
    watch.done = true;
    ++next;
  };
  const SolveResult result = run(solve_run);
  Path smoothed;
  if (smooth)
    static_cast<void>(run_smoothed(solve_run, {{}, [&](const NavState& state) { smoothed.add(state); }}));
  const Antenna antenna = antenna_of(*solve_run.config, result.gps_latency_s);
  for (Watch& watch : watches) {
    if (!watch.done) continue;
    for (const GpsSample* fix : watch.fixes) {
      watch.window.inside.add(path.error_m(*fix, antenna));
      if (smooth) watch.window.smoothed_inside.add(smoothed.error_m(*fix, antenna));
    }
    watch.window.fix_95_m = fix_95_m(*solve_run.config);
    watch.window.horizontal_error_m = path.error_m(*watch.fixes.back(), antenna);
    figures.windows.push_back(watch.window);
  }
}

}  // namespace

OutageRequest parse_outages(const std::string& text) {
  OutageRequest request;
  std::string_view rest = text;
  if (const auto at = rest.find('@'); at != std::string_view::npos) {
    std::string_view when = rest.substr(at + 1);
    rest = rest.substr(0, at);
    if (const auto colon = when.find(':'); colon != std::string_view::npos) {
      request.recover_s = seconds_in(when.substr(colon + 1), text);
      if (!(request.recover_s >= 0.0)) refuse(text);
      when = when.substr(0, colon);
    }
    request.start_s = seconds_in(when, text);
  }
  if (constexpr std::string_view kRandom = "random:"; rest.starts_with(kRandom)) {
    const double count = seconds_in(rest.substr(kRandom.size()), text);
    if (!(count >= 1.0 && count <= 100'000.0) || count != std::floor(count)) refuse(text);
    request.random = static_cast<int>(count);
    return request;
  }
  while (true) {
    const auto comma = rest.find(',');
    const double duration_s = seconds_in(rest.substr(0, comma), text);
    if (!(duration_s >= kLeastDuration_s)) refuse(text);
    request.durations_s.push_back(duration_s);
    if (comma == std::string_view::npos) return request;
    rest = rest.substr(comma + 1);
  }
}

std::optional<Motion> motion_of(const std::vector<GpsSample>& gps) {
  const std::vector<double> speeds = speeds_m_s(gps);
  std::vector<double> told;
  std::copy_if(speeds.begin(), speeds.end(), std::back_inserter(told), known);
  if (told.empty()) return std::nullopt;
  const auto high = told.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(told.size() - 1));
  std::nth_element(told.begin(), high, told.end());
  const double threshold = std::max(0.5, 0.25 * *high);
  std::optional<Motion> motion;
  for (std::size_t i = 0; i < gps.size(); ++i) {
    if (!(speeds[i] > threshold)) continue;
    if (!motion) motion = Motion{gps[i].header.stamp_ns, gps[i].header.stamp_ns};
    motion->last_ns = gps[i].header.stamp_ns;
  }
  return motion;
}

std::vector<GpsWindow> windows(TimeNs begin_ns, TimeNs last_ns, DurationNs duration_ns,
                               DurationNs recover_ns) {
  std::vector<GpsWindow> out;
  for (TimeNs begin = begin_ns; begin + duration_ns <= last_ns; begin += duration_ns + recover_ns) {
    out.push_back({begin, begin + duration_ns});
  }
  return out;
}

std::vector<GpsWindow> first_windows(const dataset::Dataset& data, const OutageRequest& request,
                                     TimeNs epoch_ns, const std::string& directory) {
  if (request.random > 0) return random_windows(data, request, 0, epoch_ns, directory);
  return planned(data, request, request.durations_s.front(), 0.0, epoch_ns, directory);
}

std::vector<OutageFigures> run_outages(const SolveRun& solve_run, const OutageRequest& request, bool smooth,
                                       TimeNs epoch_ns, const std::string& directory) {
  std::vector<OutageFigures> all;
  if (request.random > 0) {
    OutageFigures& figures = all.emplace_back();
    for (int pass = 0; static_cast<int>(figures.windows.size()) < request.random; ++pass) {
      const std::size_t before = figures.windows.size();
      SolveRun one = solve_run;
      one.label = "random outages";
      run_windows(std::move(one), random_windows(*solve_run.data, request, pass, epoch_ns, directory), smooth,
                  epoch_ns, figures);
      if (figures.windows.size() == before && pass > kMostEmptyPasses) break;
    }
    if (figures.windows.empty())
      throw Failure(ExitCode::bad_input,
                    directory + "/gps.csv: no outage fits before the last fix in motion");
    pool(figures);
    return all;
  }
  for (const double duration_s : request.durations_s) {
    OutageFigures& figures = all.emplace_back();
    figures.duration_s = duration_s;
    for (const double offset_s : kPooledStarts_s) {
      const auto removed = planned(*solve_run.data, request, duration_s, offset_s, epoch_ns, directory);
      if (removed.empty()) continue;
      SolveRun one = solve_run;
      one.label = "outage of " + std::to_string(static_cast<int>(duration_s)) + " s";
      run_windows(std::move(one), removed, smooth, epoch_ns, figures);
    }
    if (figures.windows.empty()) {
      throw Failure(ExitCode::bad_input,
                    directory + "/gps.csv: no outage of " + std::to_string(duration_s) +
                        " s fits before the last fix in motion, expected a shorter or earlier one");
    }
    pool(figures);
  }
  return all;
}

}  // namespace fathom::cli
