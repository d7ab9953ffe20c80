#include "study/starts/starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/position/gives_position.hpp"
#include "sim/random.hpp"
#include "study/consistency/cell_run.hpp"
#include "study/consistency/errors.hpp"
#include "study/consistency/motions.hpp"

namespace fathom::study {
namespace {

constexpr std::array<std::string_view, 3> kConfigurations{"gps_ins15", "gps_ins24", "gps_ins36"};

/// Ages of a solution at which it is scored, with the metrics of tilt and heading.
struct Age {
  double s;
  std::string_view tilt;
  std::string_view heading;
};
constexpr std::array<Age, 8> kAges{{{0.0, "nees_tilt_0s", "nees_heading_0s"},
                                    {2.0, "nees_tilt_2s", "nees_heading_2s"},
                                    {5.0, "nees_tilt_5s", "nees_heading_5s"},
                                    {10.0, "nees_tilt_10s", "nees_heading_10s"},
                                    {20.0, "nees_tilt_20s", "nees_heading_20s"},
                                    {40.0, "nees_tilt_40s", "nees_heading_40s"},
                                    {70.0, "nees_tilt_70s", "nees_heading_70s"},
                                    {120.0, "nees_tilt_120s", "nees_heading_120s"}}};
constexpr std::string_view kFirst = "time_to_first_state";
constexpr std::string_view kAligned = "time_to_aligned";
constexpr std::string_view kTiltError = "tilt_error_0s";
/// The vehicle switches on at an instant of its flight that is drawn.
constexpr double kLatestBegin_s = 120.0;
/// Longer than any motion leaves a vehicle without the seconds of smooth flight that a start asks for.
constexpr double kLongestWait_s = 90.0;

/// Gyros of a fibre-optic unit beside accelerometers of 21 mg, as on the light aircraft of the published
/// filter.
constexpr ImuGrade fog_with_accelerometers_of(double bias_mg) {
  ImuGrade grade = kTacticalGrade;
  grade.accel_bias_m_s2 = bias_mg * kMilliG_m_s2;
  grade.accel_in_run_m_s2 = 0.05 * bias_mg * kMilliG_m_s2;
  return grade;
}
constexpr ImuGrade kFog300ug = fog_with_accelerometers_of(0.3);
constexpr ImuGrade kFog21mg = fog_with_accelerometers_of(21.0);
/// A MEMS unit between industrial and consumer grade.
constexpr ImuGrade kMems10mg{.gyro_bias_rad_s = 0.05 * kRadPerDeg,
                             .gyro_in_run_rad_s = 10.0 * kDegPerHour_rad_s,
                             .angle_walk_rad_sqrt_s = 0.3 * kRadPerDeg / 60.0,
                             .gyro_scale = 3e-3,
                             .accel_bias_m_s2 = 10.0 * kMilliG_m_s2,
                             .accel_in_run_m_s2 = 0.5 * kMilliG_m_s2,
                             .velocity_walk_m_s_sqrt_s = 0.06 / 60.0,
                             .accel_scale = 2e-3,
                             .misalignment_rad = 2e-3,
                             .in_run_s = 600.0,
                             .gyro_g_sensitivity_rad_s_per_m_s2 = 0.02 * kRadPerDeg / kStandardGravity_m_s2};

struct Start {
  std::string_view name;
  const ImuGrade* inertial;
  Manoeuvres (*motion)(std::uint64_t seed);
};
using motions::drive_town;
using motions::flight_banks;
using motions::flight_circuit;
using motions::flight_straight;
constexpr std::array<Start, 15> kStarts{{{"0.05mg_straight", &kNavigation, flight_straight},
                                         {"0.05mg_circuit", &kNavigation, flight_circuit},
                                         {"0.3mg_circuit", &kFog300ug, flight_circuit},
                                         {"1mg_straight", &kTacticalGrade, flight_straight},
                                         {"1mg_circuit", &kTacticalGrade, flight_circuit},
                                         {"4mg_straight", &kIndustrialGrade, flight_straight},
                                         {"4mg_banks", &kIndustrialGrade, flight_banks},
                                         {"10mg_circuit", &kMems10mg, flight_circuit},
                                         {"10mg_town", &kMems10mg, drive_town},
                                         {"21mg_straight", &kFog21mg, flight_straight},
                                         {"21mg_circuit", &kFog21mg, flight_circuit},
                                         {"21mg_banks", &kFog21mg, flight_banks},
                                         {"30mg_straight", &kConsumerGrade, flight_straight},
                                         {"30mg_circuit", &kConsumerGrade, flight_circuit},
                                         {"30mg_town", &kConsumerGrade, drive_town}}};

Cell cell_of(const Start& start) {
  return {.name = start.name,
          .motion = start.motion,
          .start = CellStart::in_motion,
          .inertial = start.inertial,
          .latitude_deg = 40.0,
          .height_m = 800.0,
          .duration_s = kLatestBegin_s + kLongestWait_s + kAges.back().s,
          .outage_from_s = 1e9,
          .forecast_at_s = 1e9,
          .gps = kAirborneGps};
}

/// One configuration in one run; times count from when its instruments are switched on.
class Contender {
 public:
  Contender(std::string_view configuration, const Cell& cell)
      : name_(configuration), engine_(consistency_config(cell, configuration)) {}

  template <class Sample>
  void take(const Sample& sample) {
    engine_.add(sample);
  }
  void look(double t_s, const CellRun& run) {
    for (Verdict verdict; engine_.next_verdict(verdict);) continue;
    const NavState& nav = engine_.nav_state();
    if (!gives_position(nav.mode)) return;
    if (!known(first_s_)) first_s_ = t_s;
    if (!known(aligned_s_) && nav.alignment == AlignmentPhase::aligned) aligned_s_ = t_s;
    if (done() || t_s - first_s_ < kAges[errors_.size()].s) return;
    errors_.push_back(errors_of(nav, engine_.navigation_covariance(), run.pose()));
  }
  [[nodiscard]] bool done() const { return errors_.size() == kAges.size(); }
  void report(Scores& scores) const {
    for (std::size_t i = 0; i < kAges.size(); ++i) {
      const bool there = i < errors_.size();
      scores.add(name_, kAges[i].tilt, there ? errors_[i].tilt : kUnknown);
      scores.add(name_, kAges[i].heading, there ? errors_[i].heading : kUnknown);
    }
    scores.add(name_, kTiltError, errors_.empty() ? kUnknown : kDegPerRad * errors_.front().tilt_rad);
    scores.add(name_, kFirst, first_s_);
    scores.add(name_, kAligned, aligned_s_);
  }

 private:
  std::string_view name_;
  estimation::FusionEngine engine_;
  double first_s_ = kUnknown;
  double aligned_s_ = kUnknown;
  std::vector<Errors> errors_;
};

class Starts final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "starts"; }
  [[nodiscard]] std::string_view description() const override {
    return "starts in motion at a drawn instant: NEES of tilt and heading from the first published state on, "
           "by accelerometer bias and motion";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override {
    std::vector<std::string_view> names;
    for (const Start& start : kStarts) names.push_back(start.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string_view> methods() const override {
    return {kConfigurations.begin(), kConfigurations.end()};
  }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    std::vector<Metric> out;
    for (const Age& age : kAges) out.push_back({age.tilt, "1"});
    for (const Age& age : kAges) out.push_back({age.heading, "1"});
    out.push_back({kTiltError, "deg", Summary::root_mean_square});
    out.push_back({kFirst, "s"});
    out.push_back({kAligned, "s", Summary::distribution, Presence::if_it_happens});
    return out;
  }
  [[nodiscard]] int default_runs() const override { return 100; }
  void run(const RunRequest& request, Scores& scores) const override;
};

void Starts::run(const RunRequest& request, Scores& scores) const {
  const Start& start = *std::find_if(kStarts.begin(), kStarts.end(),
                                     [&](const Start& one) { return one.name == request.case_name; });
  const Cell cell = cell_of(start);
  std::vector<Contender> contenders;
  contenders.reserve(kConfigurations.size());
  for (const std::string_view one : kConfigurations)
    if (request.wants(one)) contenders.emplace_back(one, cell);

  CellRun run(cell, request.seed);
  sim::Random random(request.seed, "switched on");
  const double begin_s = random.uniform(0.0, kLatestBegin_s);
  while (run.time_s() < cell.duration_s) {
    const bool on = run.time_s() >= begin_s;
    run.step([&](const auto& sample) {
      if (!on) return;
      for (Contender& one : contenders) one.take(sample);
    });
    if (on)
      for (Contender& one : contenders) one.look(run.time_s() - begin_s, run);
    if (std::all_of(contenders.begin(), contenders.end(), [](const Contender& one) { return one.done(); }))
      break;
  }
  for (const Contender& one : contenders) one.report(scores);
}

}  // namespace

std::unique_ptr<const Study> make_starts_study() {
  return std::make_unique<Starts>();
}

}  // namespace fathom::study
