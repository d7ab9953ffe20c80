#include "cli/study/scenarios.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "cli/study/device_path.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "config/service_config.hpp"
#include "dataset/score.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "samples/position/gives_position.hpp"
#include "sim/simulation.hpp"

namespace fathom::cli {
namespace {

using study::Metric;
using study::Presence;
using study::Summary;

constexpr std::string_view kMethod = "fusion";
constexpr TimeNs kEpochNs = 1'700'000'000 * kNsPerSecond;
constexpr double kInside95 = 5.991464547107979;  // of chi-square with two degrees of freedom

struct ScenarioCase {
  std::string name;
  sim::Scenario scenario;
  estimation::EngineConfig engine;
  std::optional<estimation::InitialState> start;
};

/// A navigation state as published, with the covariance of its attitude.
struct Kept {
  NavState state;
  Eigen::Matrix3d attitude_covariance;
};

/// Hands measurements over in the order of their arrival.
class Arrivals {
 public:
  void add(const std::vector<sim::Measurement>& fresh) {
    waiting_.insert(waiting_.end(), fresh.begin(), fresh.end());
    std::stable_sort(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
      return header_of(a).received_ns < header_of(b).received_ns;
    });
  }
  template <class Take>
  void until(TimeNs now_ns, const Take& take) {
    std::size_t arrived = 0;
    while (arrived < waiting_.size() && header_of(waiting_[arrived]).received_ns <= now_ns)
      take(waiting_[arrived++]);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(arrived));
  }

 private:
  std::vector<sim::Measurement> waiting_;
};

double tilt_nees(const Kept& kept, const Truth& truth) {
  const geo::Quaternion q{kept.state.q_NB[0], kept.state.q_NB[1], kept.state.q_NB[2], kept.state.q_NB[3]};
  const Eigen::Matrix3d turn =
      geo::to_matrix(geo::from_rpy(geo::vec(truth.rpy_rad))) * geo::to_matrix(q).transpose();
  const Eigen::Vector2d tilt = geo::log(geo::from_matrix(turn)).head<2>();
  const Eigen::Matrix2d p = kept.attitude_covariance.topLeftCorner<2, 2>();
  return tilt.dot(p.inverse() * tilt);
}

ScenarioCase load_case(const std::string& name, const std::filesystem::path& directory) {
  ScenarioCase out;
  out.name = name;
  out.scenario = config::load_scenario({config::scenario_file(name), {}});
  std::vector<std::string> sets{"engine.imu.nominal_rate_hz=" +
                                nlohmann::json(out.scenario.sensors.of<ImuSample>().rate_hz).dump()};
  const auto overrides = config::service_overrides(out.scenario, {});
  if (const auto found = overrides.find("fusion"); found != overrides.end())
    sets.insert(sets.end(), found->second.begin(), found->second.end());
  const auto fusion =
      config::load_service_config<config::FusionConfig>({(directory / "fusion.json").string(), sets}).value;
  out.engine = config::engine_config(fusion);
  if (config::starts_from_state(fusion.start.mode)) out.start = config::initial_state(fusion);
  return out;
}

class ScenarioStudy final : public study::Study {
 public:
  ScenarioStudy() : directory_(std::filesystem::path(config::scenario_directory()).parent_path()) {
    for (const std::string& name : config::scenario_names()) cases_.push_back(load_case(name, directory_));
    if (cases_.empty())
      throw config::ConfigError("scenarios", "FATHOM_SCENARIO_DIR", config::scenario_directory(),
                                "a folder with scenarios (*.json); the executable has none beside it");
  }

  [[nodiscard]] std::string_view name() const override { return "scenarios"; }
  [[nodiscard]] std::string_view description() const override {
    return "the demonstration's scenarios offline, through device bytes and codecs";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override {
    std::vector<std::string_view> names;
    for (const ScenarioCase& one : cases_) names.push_back(one.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string_view> methods() const override { return {kMethod}; }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    return {{"horizontal_rms", "m"},
            {"horizontal_max", "m"},
            {"horizontal_end_error", "m"},
            {"roll_pitch_rms", "deg"},
            {"yaw_rms", "deg"},
            {"aligned", "fraction"},
            {"time_to_aligned", "s", Summary::distribution, Presence::if_it_happens},
            {"nees_tilt", "1"},
            {"nees_position", "1"},
            {"coverage_95", "fraction"},
            {"end_inside_95", "fraction"}};
  }
  [[nodiscard]] int default_runs() const override { return 20; }

  void run(const study::RunRequest& request, study::Scores& scores) const override;

 private:
  std::filesystem::path directory_;
  std::vector<ScenarioCase> cases_;
};

void report(const std::vector<Kept>& kept, const dataset::TruthTrack& track, double aligned_s,
            study::Scores& scores) {
  dataset::Scorer scorer;
  double tilt = kUnknown;
  double inside = 0.0;
  for (const Kept& one : kept) {
    const auto truth = track.at(one.state.header.stamp_ns);
    if (!truth) continue;
    scorer.add(dataset::error_of(one.state, *truth));
    tilt = tilt_nees(one, *truth);
    if (scorer.errors().back().nees_horizontal <= kInside95) inside += 1.0;
  }
  const dataset::Score score = scorer.score();
  const auto add = [&](std::string_view metric, double value) { scores.add(kMethod, metric, value); };
  const double last = scorer.errors().empty() ? kUnknown : scorer.errors().back().nees_horizontal;
  add("horizontal_rms", score.horizontal_m.rms);
  add("horizontal_max", score.horizontal_m.max);
  add("horizontal_end_error", score.horizontal_m.end);
  add("roll_pitch_rms", std::max(score.rpy_rad[0].rms, score.rpy_rad[1].rms) / kRadPerDeg);
  add("yaw_rms", score.rpy_rad[2].rms / kRadPerDeg);
  add("aligned", known(aligned_s) ? 1.0 : 0.0);
  add("time_to_aligned", aligned_s);
  add("nees_tilt", tilt);
  add("nees_position", last);
  add("coverage_95", kept.empty() ? kUnknown : inside / static_cast<double>(kept.size()));
  add("end_inside_95", known(last) ? (last <= kInside95 ? 1.0 : 0.0) : kUnknown);
}

void ScenarioStudy::run(const study::RunRequest& request, study::Scores& scores) const {
  const ScenarioCase& one = *std::find_if(cases_.begin(), cases_.end(),
                                          [&](const ScenarioCase& c) { return c.name == request.case_name; });
  sim::Simulation simulation(one.scenario, {kEpochNs, request.seed, "auv"});
  DevicePath devices(one.scenario, directory_.string(), kEpochNs);
  estimation::FusionEngine engine(one.engine);
  if (one.start) engine.start_from(*one.start);
  dataset::TruthTrack track;
  std::vector<Kept> kept;
  double aligned_s = kUnknown;
  TimeNs next_score_ns = kEpochNs + from_seconds(one.scenario.limits.score_from_s);

  const auto take = [&](const sim::Measurement& measurement) {
    const auto* imu = std::get_if<ImuSample>(&measurement);
    if (imu == nullptr) {
      std::visit([&](const auto& sample) { engine.add(sample); }, measurement);
    } else if (engine.add(*imu)) {
      const NavState& state = engine.nav_state();
      if (!known(aligned_s) && state.alignment == AlignmentPhase::aligned)
        aligned_s = to_seconds(state.header.stamp_ns - kEpochNs);
      if (state.header.stamp_ns >= next_score_ns && gives_position(state.mode)) {
        kept.push_back({state, engine.navigation_covariance().block<3, 3>(6, 6)});
        next_score_ns += kNsPerSecond;
      }
    }
    for (Verdict verdict; engine.next_verdict(verdict);) continue;
  };
  Arrivals arrivals;
  std::vector<sim::Measurement> fresh;
  track.add(simulation.truth());
  while (simulation.time_s() < one.scenario.duration_s - 1e-6) {
    fresh.clear();
    simulation.advance(fresh);
    track.add(simulation.truth());
    arrivals.add(fresh);
    arrivals.until(simulation.truth().header.stamp_ns,
                   [&](const sim::Measurement& measurement) { devices.send(measurement, take); });
  }
  report(kept, track, aligned_s, scores);
}

}  // namespace

std::unique_ptr<const study::Study> make_scenario_study() {
  return std::make_unique<ScenarioStudy>();
}

}  // namespace fathom::cli
