#include "study/gps_outage/gps_outage.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include <Eigen/Cholesky>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "study/engine_run.hpp"
#include "study/gps_outage/gps_outage_rig.hpp"
#include "study/instruments.hpp"

namespace fathom::study {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using fixed_gain::Navigator;
using fixed_gain::OutageMode;

constexpr std::string_view kMean = "fixed_gain_mean";
constexpr std::string_view kHold = "fixed_gain_hold";
constexpr std::string_view kEkf15 = "ekf15";
constexpr std::string_view kEkf24 = "ekf24";
constexpr std::string_view kEkf36 = "ekf36";
constexpr std::string_view kUncompensated = "ekf36_uncompensated";
constexpr std::string_view kAsFlown = "ekf36_as_flown";  ///< switched on in flight: finds its start itself

constexpr std::string_view kHorizontal = "horizontal_error";
constexpr std::string_view kVertical = "vertical_error";
constexpr std::string_view kTilt = "attitude_tilt";
constexpr std::string_view kHeading = "attitude_heading";
constexpr std::string_view kAttitude = "attitude";
constexpr std::string_view kNees = "nees9";
constexpr std::string_view kTimeTo = "time_to_100m";
constexpr std::string_view kPredicted = "predicted_time_to_100m";
constexpr std::string_view kRatio = "predicted_over_actual";

constexpr std::string_view kCoverage = "forecast_coverage";

constexpr double kLimit_m = 100.0;
constexpr double kLongestOutage_s = 300.0;
/// From here on the start is forgotten.
constexpr double kAidedFrom_s = 120.0;

struct Errors {
  double horizontal_m = kUnknown;
  double vertical_m = kUnknown;
  double tilt_rad = kUnknown;
  double heading_rad = kUnknown;
  double nees9 = kUnknown;
};

/// Means of squares, for a flight that is scored all along.
struct Sums {
  double count = 0.0;
  double horizontal = 0.0;
  double vertical = 0.0;
  double tilt = 0.0;
  double heading = 0.0;
  double nees9 = 0.0;
  void add(const Errors& e) {
    count += 1.0;
    horizontal += e.horizontal_m * e.horizontal_m;
    vertical += e.vertical_m * e.vertical_m;
    tilt += e.tilt_rad * e.tilt_rad;
    heading += e.heading_rad * e.heading_rad;
    nees9 += e.nees9;
  }
  [[nodiscard]] Errors rms() const {
    return {std::sqrt(horizontal / count), std::sqrt(vertical / count), std::sqrt(tilt / count),
            std::sqrt(heading / count), nees9 / count};
  }
};

geo::Geodetic place_of(const Truth& truth) {
  return {truth.latitude_rad, truth.longitude_rad, truth.altitude_m};
}

/// Rotation vector phi along N of an estimate that is (I - phi x) times the truth.
Vector3d attitude_error(const Matrix3d& estimate_NB, const Matrix3d& truth_NB) {
  const Matrix3d turn = truth_NB * estimate_NB.transpose();
  return geo::log(geo::from_matrix(turn));
}

Errors errors_of(const estimation::FusionEngine& engine, const Truth& truth) {
  const NavState& nav = engine.nav_state();
  const Vector3d position =
      geo::difference_N(place_of(truth), {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  const Vector3d velocity = geo::vec(nav.velocity_N_m_s) - geo::vec(truth.velocity_N_m_s);
  const geo::Quaternion q{nav.q_NB[0], nav.q_NB[1], nav.q_NB[2], nav.q_NB[3]};
  const Vector3d phi =
      attitude_error(geo::to_matrix(q), geo::to_matrix(geo::from_rpy(geo::vec(truth.rpy_rad))));
  Eigen::Matrix<double, 9, 1> error;
  error << position, velocity, phi;
  const Eigen::Matrix<double, 9, 9> p = engine.navigation_covariance();
  return {position.head<2>().norm(), std::abs(position.z()), phi.head<2>().norm(), std::abs(phi.z()),
          error.dot(p.llt().solve(error))};
}

Errors errors_of(const Navigator& navigator, const Truth& truth) {
  const geo::Geodetic at = place_of(truth);
  const Vector3d position = navigator.position_T_m() - navigator.frame().position_T_m(at);
  const Matrix3d truth_TB =
      navigator.frame().R_TN(at) * geo::to_matrix(geo::from_rpy(geo::vec(truth.rpy_rad)));
  const Vector3d phi = attitude_error(navigator.R_TB(), truth_TB);
  return {position.head<2>().norm(), std::abs(position.z()), phi.head<2>().norm(), std::abs(phi.z()),
          kUnknown};
}

/// An estimator under test and what became of it.
struct Runner {
  Runner(std::string_view name, const estimation::EngineConfig& config) : method(name), engine(config) {}
  Runner(std::string_view name, const Navigator::Config& config, const estimation::InitialState& start)
      : method(name), navigator(std::in_place, config, start) {}

  void start(const estimation::InitialState& state) {
    if (engine && method != kAsFlown) engine->start_from(state);
  }
  void take(const sim::Measurement& measurement) {
    std::visit(
        [&](const auto& sample) {
          if (engine) engine->add(sample);
          using Sample = std::decay_t<decltype(sample)>;
          if constexpr (std::is_same_v<Sample, ImuSample> || std::is_same_v<Sample, GpsSample>)
            if (navigator) navigator->add(sample);
        },
        measurement);
    Verdict verdict;
    while (engine && engine->next_verdict(verdict)) {
    }
  }
  [[nodiscard]] Errors errors(const Truth& truth) const {
    return engine ? errors_of(*engine, truth) : errors_of(*navigator, truth);
  }
  void predict() {
    if (!engine) return;
    Forecast forecast;
    engine->fill(forecast);
    predicted_s = forecast.limits[0].time_expected_s;
  }

  std::string_view method;
  std::optional<estimation::FusionEngine> engine;
  std::optional<Navigator> navigator;
  Sums sums;
  Errors scored;
  double time_to_limit_s = kUnknown;
  double predicted_s = kUnknown;
  double predicted_m = kUnknown;  ///< 95 % radius at the end of the outage
};

void report(const Runner& one, bool outage, Scores& scores) {
  const Errors e = outage ? one.scored : one.sums.rms();
  scores.add(one.method, kHorizontal, e.horizontal_m);
  scores.add(one.method, kVertical, e.vertical_m);
  scores.add(one.method, kTilt, e.tilt_rad / kRadPerDeg);
  scores.add(one.method, kHeading, e.heading_rad / kRadPerDeg);
  scores.add(one.method, kAttitude, std::hypot(e.tilt_rad, e.heading_rad) / kRadPerDeg);
  if (one.engine) scores.add(one.method, kNees, e.nees9);
  if (!outage) return;
  scores.add(one.method, kTimeTo, one.time_to_limit_s);
  if (!one.engine) return;
  scores.add(one.method, kPredicted, one.predicted_s);
  scores.add(one.method, kRatio, one.predicted_s / one.time_to_limit_s);
}

class GpsOutage final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "gps_outage"; }
  [[nodiscard]] std::string_view description() const override {
    return "a light aircraft loses GPS in a climb, a steep turn or a Dutch roll";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override {
    std::vector<std::string_view> names;
    for (const FlightCase& one : flight_cases()) names.push_back(one.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string_view> methods() const override {
    return {kMean, kHold, kEkf15, kEkf24, kEkf36, kUncompensated, kAsFlown};
  }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    constexpr auto kMayNotHappen = Presence::if_it_happens;  // an error that never passes the limit
    constexpr auto kValues = Summary::distribution;
    return {{kHorizontal, "m"},
            {kVertical, "m"},
            {kTimeTo, "s", kValues, kMayNotHappen},
            {kPredicted, "s", kValues, kMayNotHappen},
            {kRatio, "1", kValues, kMayNotHappen},
            {kNees, "1"},
            {kAttitude, "deg"},
            {kTilt, "deg"},
            {kHeading, "deg"},
            {kCoverage, "1"}};
  }
  [[nodiscard]] int default_runs() const override { return 40; }

  void run(const RunRequest& request, Scores& scores) const override {
    const auto all = flight_cases();
    const FlightCase& one = *std::find_if(all.begin(), all.end(),
                                          [&](const FlightCase& c) { return c.name == request.case_name; });
    const bool outage = one.outage_at_s > 0.0;
    const estimation::InitialState start = draw_flight_start(request.seed);
    std::vector<Runner> runners = runners_of(request, one, start);

    sim::Simulation::Options options;
    options.seed = request.seed;
    sim::Simulation simulation(flight_scenario(), options);
    for (Runner& runner : runners) runner.start(start);
    if (one.random) {
      run_random(simulation, draw_outages(request.seed), runners, scores);
      return;
    }
    const double end_s = outage ? one.outage_at_s + kLongestOutage_s : kFlight_s;
    std::vector<sim::Measurement> fresh;
    std::vector<GpsSample> under_way;
    bool begun = false;
    bool scored = false;
    while (simulation.time_s() < std::min(end_s, kFlight_s) - 1e-6) {
      fresh.clear();
      simulation.advance(fresh);
      const double t = simulation.time_s();
      const Truth truth = simulation.truth();
      for (sim::Measurement& measurement : fresh) {
        auto* gps = std::get_if<GpsSample>(&measurement);
        if (gps == nullptr) continue;
        gps->header.stamp_ns += from_seconds(one.gps_late_s);
        gps->header.received_ns = gps->header.stamp_ns;
        under_way.push_back(*gps);
      }
      while (!under_way.empty() && under_way.front().header.received_ns <= truth.header.stamp_ns) {
        const GpsSample fix = under_way.front();
        under_way.erase(under_way.begin());
        if (outage && to_seconds(fix.header.stamp_ns) > one.outage_at_s + 1e-6) continue;
        for (Runner& runner : runners) runner.take(fix);
      }
      for (const sim::Measurement& measurement : fresh)
        if (std::holds_alternative<ImuSample>(measurement))
          for (Runner& runner : runners) runner.take(measurement);

      if (!outage) {
        const bool whole = std::abs(t - std::round(t)) < 1e-6;
        if (whole && t >= kAidedFrom_s)
          for (Runner& runner : runners) runner.sums.add(runner.errors(truth));
        continue;
      }
      const double gone_s = t - one.outage_at_s;
      if (!begun && gone_s > -1e-6) {
        begun = true;
        for (Runner& runner : runners) runner.predict();
      }
      if (!begun) continue;
      const bool due = !scored && gone_s > one.scored_after_s - 1e-6;
      scored = scored || due;
      bool waiting = !scored;
      for (Runner& runner : runners) {
        if (!due && known(runner.time_to_limit_s)) continue;
        const Errors errors = runner.errors(truth);
        if (due) runner.scored = errors;
        if (!known(runner.time_to_limit_s) && errors.horizontal_m > kLimit_m) runner.time_to_limit_s = gone_s;
        waiting = waiting || !known(runner.time_to_limit_s);
      }
      if (!waiting) break;
    }
    for (const Runner& runner : runners) report(runner, outage, scores);
  }

 private:
  /// Whether the error at the end of each outage is inside what was forecast at its beginning.
  static void run_random(sim::Simulation& simulation, const std::vector<sim::Window>& outages,
                         std::vector<Runner>& runners, Scores& scores) {
    std::vector<sim::Measurement> fresh;
    std::size_t next = 0;
    bool inside = false;
    while (next < outages.size()) {
      fresh.clear();
      simulation.advance(fresh);
      const double t = simulation.time_s();
      for (const sim::Measurement& measurement : fresh) {
        if (std::holds_alternative<GpsSample>(measurement) && inside) continue;
        for (Runner& runner : runners) runner.take(measurement);
      }
      const sim::Window& outage = outages[next];
      if (!inside && t >= outage.from_s) {
        inside = true;
        for (Runner& runner : runners)
          if (runner.engine) runner.predicted_m = runner.engine->forecast_horizontal_95_m(outage.to_s - t);
      } else if (inside && t >= outage.to_s) {
        inside = false;
        ++next;
        for (const Runner& runner : runners)
          if (runner.engine)
            scores.add(runner.method, kCoverage,
                       runner.errors(simulation.truth()).horizontal_m <= runner.predicted_m ? 1.0 : 0.0);
      }
    }
  }

  static std::vector<Runner> runners_of(const RunRequest& request, const FlightCase& one,
                                        const estimation::InitialState& start) {
    std::vector<Runner> out;
    out.reserve(7);
    if (request.wants(kMean)) out.emplace_back(kMean, flight_config(OutageMode::mean), start);
    if (request.wants(kHold)) out.emplace_back(kHold, flight_config(OutageMode::hold), start);
    const auto enter = [&](std::string_view method, FlightFilter filter, double latency_s) {
      if (request.wants(method)) out.emplace_back(method, flight_config(filter, latency_s));
    };
    enter(kEkf15, FlightFilter::ekf15, one.gps_late_s);
    enter(kEkf24, FlightFilter::ekf24, one.gps_late_s);
    enter(kEkf36, FlightFilter::ekf36, one.gps_late_s);
    if (one.gps_late_s > 0.0) enter(kUncompensated, FlightFilter::ekf36, 0.0);
    if (request.wants(kAsFlown))
      out.emplace_back(kAsFlown, begun_in_flight(flight_config(FlightFilter::ekf36, one.gps_late_s)));
    return out;
  }
};

}  // namespace

std::unique_ptr<const Study> make_gps_outage_study() {
  return std::make_unique<GpsOutage>();
}

}  // namespace fathom::study
