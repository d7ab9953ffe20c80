#include "cli/solve_outage.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "cli/command.hpp"
#include "cli/solve_smooth.hpp"
#include "estimation/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::cli {
namespace {

constexpr double kDefaultStart_s = 60.0;  // after motion begins
constexpr std::array<double, 4> kPooledStarts_s{0.0, 13.0, 26.0,
                                                39.0};  // so that windows meet other manoeuvres
constexpr double kChiSquare95TwoDof = 5.991464547107979;

[[noreturn]] void refuse(const std::string& text) {
  throw Failure(ExitCode::bad_configuration,
                "--gps-outage: is '" + text +
                    "', expected T1,T2,...[@start[:recover]] in seconds, e.g. 10,20,60@110:40");
}

double seconds_in(std::string_view part, const std::string& whole) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || !(std::abs(value) < 1e7)) refuse(whole);
  return value;
}

double speed_m_s(const GpsSample& fix) {
  return fix.fix == GpsFix::none ? kUnknown : std::hypot(fix.velocity_N_m_s[0], fix.velocity_N_m_s[1]);
}

// What the evaluation needs to know of the GPS receiver.
struct Antenna {
  std::array<double, 3> from_output_B_m{0, 0, 0};
  DurationNs latency_ns = 0;
};

Antenna antenna_of(const config::FusionConfig& config) {
  Antenna antenna;
  for (const estimation::SensorConfig& sensor : config.engine.sensors) {
    if (sensor.kind != SourceKind::gps) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      antenna.from_output_B_m[i] = sensor.lever_B_m[i] - config.engine.output_lever_B_m[i];
    }
    antenna.latency_ns = from_seconds(sensor.latency_s);
    break;
  }
  return antenna;
}

geo::Geodetic antenna_position(const NavState& state, const Antenna& antenna) {
  const geo::Quaternion q{state.q_NB[0], state.q_NB[1], state.q_NB[2], state.q_NB[3]};
  return geo::moved_by({state.latitude_rad, state.longitude_rad, state.altitude_m},
                       geo::to_matrix(q) * geo::vec(antenna.from_output_B_m));
}

double horizontal_error_m(const NavState& before, const NavState& after, TimeNs instant_ns,
                          const GpsSample& fix, const Antenna& antenna) {
  const geo::Geodetic truth{fix.latitude_rad, fix.longitude_rad, fix.altitude_m};
  const Eigen::Vector3d a = geo::difference_N(truth, antenna_position(before, antenna));
  const Eigen::Vector3d b = geo::difference_N(truth, antenna_position(after, antenna));
  const auto span = static_cast<double>(after.header.stamp_ns - before.header.stamp_ns);
  const double share = span > 0.0 ? static_cast<double>(instant_ns - before.header.stamp_ns) / span : 0.0;
  const Eigen::Vector3d error = a + share * (b - a);
  return std::hypot(error.x(), error.y());
}

// Radius that 95 % of the errors stay within along the worse horizontal axis of the filter's covariance.
double predicted_95_m(const NavState& state) {
  const auto& p = state.position_covariance_N_m2;
  const double mean = 0.5 * (p[0] + p[4]);
  const double largest = mean + std::hypot(0.5 * (p[0] - p[4]), p[1]);
  return std::sqrt(kChiSquare95TwoDof * largest);
}

void pool(OutageFigures& figures) {
  std::vector<double> errors;
  double sum2 = 0.0;
  double smoothed2 = 0.0;
  for (const OutageWindow& window : figures.windows) {
    if (!known(window.horizontal_error_m)) continue;
    errors.push_back(window.horizontal_error_m);
    sum2 += window.horizontal_error_m * window.horizontal_error_m;
    smoothed2 += window.smoothed_horizontal_error_m * window.smoothed_horizontal_error_m;
  }
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  figures.rms_m = std::sqrt(sum2 / count);
  figures.smoothed_rms_m = std::sqrt(smoothed2 / count);
  figures.p95_m = errors[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  figures.max_m = errors.back();
}

std::vector<GpsWindow> planned(const dataset::Dataset& data, const OutageRequest& request, double duration_s,
                               double offset_s, TimeNs epoch_ns, const std::string& directory) {
  const auto motion = motion_of(data.gps);
  if (!motion) {
    throw Failure(ExitCode::bad_input,
                  directory + "/gps.csv: no fix in motion, expected a moving vehicle for --gps-outage");
  }
  const TimeNs start_ns = request.start_s ? epoch_ns + from_seconds(*request.start_s)
                                          : motion->first_ns + from_seconds(kDefaultStart_s);
  return windows(start_ns + from_seconds(offset_s), motion->last_ns, from_seconds(duration_s),
                 from_seconds(request.recover_s));
}

// The last usable fix inside a window, or none.
const GpsSample* last_fix(const std::vector<GpsSample>& gps, const GpsWindow& window) {
  const GpsSample* last = nullptr;
  for (const GpsSample& fix : gps) {
    if (fix.fix != GpsFix::none && window.contains(fix.header.stamp_ns)) last = &fix;
  }
  return last;
}

// One passage with windows removed; appends what became of them.
void run_windows(Passage passage, const std::vector<GpsWindow>& removed, bool smooth, TimeNs epoch_ns,
                 OutageFigures& figures) {
  const Antenna antenna = antenna_of(*passage.config);
  struct Watch {
    OutageWindow window;
    TimeNs begin_ns;
    const GpsSample* fix;
    TimeNs instant_ns;
    bool forecast_taken = false;
    bool done = false;
  };
  std::vector<Watch> watches;
  for (const GpsWindow& window : removed) {
    const GpsSample* fix = last_fix(passage.data->gps, window);
    if (fix == nullptr) continue;  // GPS was out by itself: nothing to compare with
    Watch watch{{}, window.begin_ns, fix, fix->header.stamp_ns - antenna.latency_ns};
    watch.window.start_s = to_seconds(window.begin_ns - epoch_ns);
    watch.window.end_s = to_seconds(fix->header.stamp_ns - epoch_ns);
    watches.push_back(watch);
  }
  passage.gps_removed = removed;
  NavState before;
  std::size_t next = 0;
  passage.on_state = [&](const NavState& state, estimation::FusionEngine& engine) {
    if (next < watches.size() && known(state.latitude_rad)) {
      Watch& watch = watches[next];
      if (!watch.forecast_taken && state.header.stamp_ns >= watch.begin_ns) {
        watch.forecast_taken = true;
        Forecast forecast;
        engine.fill(forecast);
        watch.window.forecast_95_m =
            forecast.horizontal_95_m +
            forecast.horizontal_growth_m_s * to_seconds(watch.instant_ns - watch.begin_ns);
        for (std::uint32_t i = 0; i < forecast.limit_count; ++i) {
          watch.window.time_to_limit_s[forecast.limits[i].name.str()] = forecast.limits[i].time_to_limit_s;
        }
      }
      if (state.header.stamp_ns >= watch.instant_ns) {
        const NavState& from = known(before.latitude_rad) ? before : state;
        watch.window.horizontal_error_m =
            horizontal_error_m(from, state, watch.instant_ns, *watch.fix, antenna);
        watch.window.predicted_95_m = predicted_95_m(state);
        watch.done = true;
        ++next;
      }
    }
    before = state;
  };
  static_cast<void>(run(passage));
  if (smooth) {
    next = 0;
    before = NavState{};
    const auto meet = [&](const NavState& state) {
      for (; next < watches.size() && state.header.stamp_ns >= watches[next].instant_ns; ++next) {
        if (!known(state.latitude_rad)) continue;
        Watch& watch = watches[next];
        const NavState& from = known(before.latitude_rad) ? before : state;
        watch.window.smoothed_horizontal_error_m =
            horizontal_error_m(from, state, watch.instant_ns, *watch.fix, antenna);
      }
      before = state;
    };
    static_cast<void>(run_smoothed(passage, {{}, meet}));
  }
  for (const Watch& watch : watches) {
    if (watch.done) figures.windows.push_back(watch.window);
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
  while (true) {
    const auto comma = rest.find(',');
    const double duration_s = seconds_in(rest.substr(0, comma), text);
    if (!(duration_s > 0.0)) refuse(text);
    request.durations_s.push_back(duration_s);
    if (comma == std::string_view::npos) return request;
    rest = rest.substr(comma + 1);
  }
}

std::optional<Motion> motion_of(const std::vector<GpsSample>& gps) {
  std::vector<double> speeds;
  for (const GpsSample& fix : gps) {
    if (const double speed = speed_m_s(fix); known(speed)) speeds.push_back(speed);
  }
  if (speeds.empty()) return std::nullopt;
  const auto high =
      speeds.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(speeds.size() - 1));
  std::nth_element(speeds.begin(), high, speeds.end());
  const double threshold = std::max(0.5, 0.25 * *high);
  std::optional<Motion> motion;
  for (const GpsSample& fix : gps) {
    if (!(speed_m_s(fix) > threshold)) continue;
    if (!motion) motion = Motion{fix.header.stamp_ns, fix.header.stamp_ns};
    motion->last_ns = fix.header.stamp_ns;
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
  return planned(data, request, request.durations_s.front(), 0.0, epoch_ns, directory);
}

std::vector<OutageFigures> run_outages(const Passage& passage, const OutageRequest& request, bool smooth,
                                       TimeNs epoch_ns, const std::string& directory) {
  std::vector<OutageFigures> all;
  for (const double duration_s : request.durations_s) {
    OutageFigures& figures = all.emplace_back();
    figures.duration_s = duration_s;
    for (const double offset_s : kPooledStarts_s) {
      const auto removed = planned(*passage.data, request, duration_s, offset_s, epoch_ns, directory);
      if (removed.empty()) continue;
      Passage one = passage;
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
