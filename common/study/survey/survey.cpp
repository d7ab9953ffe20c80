#include "study/survey/survey.hpp"

#include <cmath>
#include <string>

#include "geo/wgs84.hpp"
#include "study/engine_run.hpp"
#include "study/instruments.hpp"
#include "study/survey/survey_rig.hpp"

namespace fathom::study {
namespace {

constexpr std::string_view kHybrid = "hybrid25";
constexpr std::string_view kHybridEqual = "hybrid25_equal";
constexpr std::string_view kFull = "full";

constexpr std::string_view kEndPercent = "end_error_percent";
constexpr std::string_view kEndError = "horizontal_end_error";
constexpr std::string_view kNees = "nees_horizontal";
constexpr std::string_view kScaleError = "dvl_scale_error";
constexpr std::string_view kYawError = "dvl_misalignment_error";

/// Value of a state by its name; unknown where it is not estimated.
double state_value(const estimation::FusionEngine& engine, std::string_view name) {
  NavDetail detail;
  engine.fill(detail);
  for (std::uint32_t i = 0; i < detail.count; ++i)
    if (detail.states[i].name == Name(name)) return detail.states[i].value;
  return kUnknown;
}

class Survey final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "survey"; }
  [[nodiscard]] std::string_view description() const override {
    return "5 min on the surface with GPS, then 60 min at 2 m/s under water: straight or a lawn-mower "
           "pattern";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override {
    std::vector<std::string_view> names;
    for (const SurveyCase& one : survey_cases()) names.push_back(one.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string_view> methods() const override {
    return {kHybrid, kHybridEqual, kFull};
  }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    return {{kEndPercent, "%"}, {kEndError, "m"}, {kNees, "1"}, {kScaleError, "%"}, {kYawError, "deg"}};
  }
  [[nodiscard]] int default_runs() const override { return 16; }

  void run(const RunRequest& request, Scores& scores) const override {
    const auto all = survey_cases();
    const SurveyCase& one = *std::find_if(all.begin(), all.end(),
                                          [&](const SurveyCase& c) { return c.name == request.case_name; });
    sim::Simulation::Options options;
    options.seed = request.seed;
    sim::Simulation simulation(survey_scenario(one, request.seed), options);
    std::vector<std::pair<std::string_view, EngineRun>> engines;
    engines.reserve(3);
    const auto enter = [&](std::string_view method, SurveyFilter filter) {
      if (request.wants(method)) engines.emplace_back(method, EngineRun(survey_config(one, filter)));
    };
    enter(kHybrid, SurveyFilter::hybrid25);
    enter(kHybridEqual, SurveyFilter::hybrid25_equal);
    enter(kFull, SurveyFilter::full);
    std::vector<EngineRun*> running;
    for (auto& [method, engine] : engines) running.push_back(&engine);

    double travelled_m = 0.0;
    carry_out(simulation, kSurveyDuration_s, running, [&](const sim::Measurement& measurement) {
      if (!std::holds_alternative<ImuSample>(measurement) || simulation.time_s() < kSurveyDive_s) return;
      const auto v_N_m_s = simulation.truth().velocity_N_m_s;
      travelled_m += 0.01 * std::hypot(v_N_m_s[0], v_N_m_s[1]);
    });

    const Truth truth = simulation.truth();
    const DvlFault fault = draw_dvl_fault(one, request.seed);
    for (const auto& [method, engine] : engines) {
      const HorizontalError error = horizontal_error(engine.engine().nav_state(), truth);
      scores.add(method, kEndPercent, 100.0 * error.error_m / travelled_m);
      scores.add(method, kEndError, error.error_m);
      scores.add(method, kNees, error.nees);
      if (!one.uncalibrated || method != kFull) continue;
      const double scale = state_value(engine.engine(), "dvl_scale");
      const double yaw_rad = state_value(engine.engine(), "dvl_misalignment_z_rad");
      scores.add(method, kScaleError, 100.0 * (scale - fault.scale));
      scores.add(method, kYawError, (yaw_rad - fault.yaw_rad) / kRadPerDeg);
    }
  }
};

}  // namespace

std::unique_ptr<const Study> make_survey_study() {
  return std::make_unique<Survey>();
}

}  // namespace fathom::study
