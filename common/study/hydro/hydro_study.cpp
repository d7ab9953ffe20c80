#include "study/hydro/hydro_study.hpp"

#include <array>
#include <cmath>

#include "study/hydro/embedded_method.hpp"
#include "study/hydro/engine_method.hpp"

namespace fathom::study {
namespace {

using namespace hydro;

constexpr std::array<Case, 10> kCases{{
    {.name = "perfect"},
    {.name = "coeff_10pct", .coefficient_share = 0.1},
    {.name = "coeff_30pct", .coefficient_share = 0.3},
    {.name = "current_0.3", .current_m_s = 0.3},
    {.name = "tilt_0.1deg", .tilt_sigma_deg = 0.1},
    {.name = "dvl_loss_300s", .dvl_loss = true},
    {.name = "dvl_loss_300s_current_0.3", .current_m_s = 0.3, .dvl_loss = true},
    {.name = "dvl_loss_300s_coeff_30pct", .coefficient_share = 0.3, .dvl_loss = true},
    {.name = "dvl_loss_300s_straight", .dvl_loss = true, .straight = true},
    {.name = "dvl_loss_300s_other_vehicle", .dvl_loss = true, .other_vehicle = true},
}};

struct Method {
  std::string_view name;
  std::vector<ErrorPoint> (*run)(const Run& run);
  bool states_uncertainty = true;
};

constexpr std::array<Method, 6> kMethods{{
    {"ins", run_ins, false},
    {"ins_dvl", [](const Run& run) { return run_engine(run, EngineMethod::conventional); }},
    {"printed", run_printed},
    {"linked", run_linked},
    {"engine", [](const Run& run) { return run_engine(run, EngineMethod::with_model); }},
    {"engine_no_model", [](const Run& run) { return run_engine(run, EngineMethod::without_model); }},
}};

double horizontal(const ErrorPoint& point) {
  return std::hypot(point.north_m, point.east_m);
}

/// The point at a whole second; empty tracks have none.
const ErrorPoint* at(const std::vector<ErrorPoint>& track, double t_s) {
  const auto i = static_cast<std::size_t>(std::lround(t_s));
  return i >= 1 && i <= track.size() ? &track[i - 1] : nullptr;
}

double mean_error(const std::vector<ErrorPoint>& track) {
  double sum = 0.0;
  for (const ErrorPoint& point : track) sum += horizontal(point);
  return track.empty() ? kUnknown : sum / static_cast<double>(track.size());
}

}  // namespace

std::string_view HydroStudy::description() const {
  return "a vehicle model in the filter, and in place of a lost DVL";
}

std::vector<std::string_view> HydroStudy::cases() const {
  std::vector<std::string_view> out;
  for (const Case& one : kCases) out.push_back(one.name);
  return out;
}

std::vector<std::string_view> HydroStudy::methods() const {
  std::vector<std::string_view> out;
  for (const Method& one : kMethods) out.push_back(one.name);
  return out;
}

std::vector<Metric> HydroStudy::metrics() const {
  return {{"position_rms_199s", "m", Summary::root_mean_square},
          {"time_mean_ratio_to_ins", "1"},
          {"drift_since_loss", "m"},
          {"nees_position", "1"}};
}

void HydroStudy::run(const RunRequest& request, Scores& scores) const {
  const Case* which = nullptr;
  for (const Case& one : kCases)
    if (one.name == request.case_name) which = &one;
  if (which == nullptr) return;
  const Run run = make_run(*which, request.seed);
  const double inertial = mean_error(run_ins(run));
  for (const Method& method : kMethods) {
    if (!request.wants(method.name)) continue;
    const std::vector<ErrorPoint> track = method.run(run);
    const ErrorPoint* published = at(track, kPublished_s);
    scores.add(method.name, "position_rms_199s", published != nullptr ? horizontal(*published) : kUnknown);
    scores.add(method.name, "time_mean_ratio_to_ins", mean_error(track) / inertial);
    const ErrorPoint* end = at(track, duration_s(*which));
    const ErrorPoint* lost = at(track, kLossFrom_s);
    if (which->dvl_loss)
      scores.add(method.name, "drift_since_loss",
                 end != nullptr && lost != nullptr
                     ? std::hypot(end->north_m - lost->north_m, end->east_m - lost->east_m)
                     : kUnknown);
    if (method.states_uncertainty)
      scores.add(method.name, "nees_position", end != nullptr ? end->nees : kUnknown);
  }
}

}  // namespace fathom::study
