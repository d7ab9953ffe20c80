#include "study/consistency/consistency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/position/gives_position.hpp"
#include "study/consistency/cell_run.hpp"
#include "study/consistency/errors.hpp"

namespace fathom::study {
namespace {

constexpr std::array<std::string_view, 6> kConfigurations{"gps_ins15", "gps_ins24", "gps_ins36",
                                                          "standard",  "hybrid25",  "full"};
constexpr std::string_view kTilt = "nees_tilt";
constexpr std::string_view kHeading = "nees_heading";
constexpr std::string_view kVelocity = "nees_velocity";
constexpr std::string_view kPosition = "nees_position";
constexpr std::string_view kFirstTilt = "nees_tilt_at_start";
constexpr std::string_view kCovered = "coverage_95";
constexpr std::string_view kForecast = "forecast_coverage";
constexpr std::string_view kTiltError = "tilt_error";
constexpr std::string_view kHeadingError = "heading_error";
constexpr std::string_view kHorizontalError = "horizontal_error";
constexpr std::string_view kAligned = "time_to_aligned";

constexpr double kScoreEvery_s = 10.0;
constexpr double kLongestForecast_s = 120.0;

/// One configuration in one run.
class Contender {
 public:
  Contender(std::string_view configuration, const Cell& cell, const Pose& start, std::uint64_t seed)
      : name_(configuration), cell_(&cell), engine_(consistency_config(cell, configuration)) {
    if (const auto state = draw_given_start(cell, start, seed)) engine_.start_from(*state);
  }

  template <class Sample>
  void take(const Sample& sample) {
    engine_.add(sample);
  }
  /// Behind each inertial sample; the truth is asked for only where it is needed.
  template <class Truth>
  void look(double t_s, const Truth& truth) {
    for (Verdict verdict; engine_.next_verdict(verdict);) continue;
    const NavState& nav = engine_.nav_state();
    if (!gives_position(nav.mode)) return;
    if (!known(aligned_s_) && nav.alignment == AlignmentPhase::aligned) aligned_s_ = t_s;
    if (!known(forecast_m_) && t_s >= cell_->forecast_at_s) {
      forecast_until_s_ = std::min(cell_->duration_s, t_s + kLongestForecast_s) - 0.05;
      forecast_m_ = engine_.forecast_horizontal_95_m(forecast_until_s_ - t_s);
    }
    const bool forecast_due = known(forecast_m_) && !known(forecast_holds_) && t_s >= forecast_until_s_;
    if (t_s < next_s_ && !forecast_due) return;
    const Errors errors = errors_of(nav, engine_.navigation_covariance(), truth());
    if (forecast_due) forecast_holds_ = errors.horizontal_m <= forecast_m_ ? 1.0 : 0.0;
    if (t_s < next_s_) return;
    next_s_ = t_s + kScoreEvery_s;
    errors_.push_back(errors);
  }
  void report(Scores& scores) const {
    const auto n = static_cast<double>(errors_.size());
    const auto mean = [&](auto field) {
      double sum = 0.0;
      for (const Errors& one : errors_) sum += field(one);
      return errors_.empty() ? kUnknown : sum / n;
    };
    const auto rms = [&](auto field) {
      return std::sqrt(mean([&](const Errors& one) { return field(one) * field(one); }));
    };
    scores.add(name_, kTilt, mean([](const Errors& one) { return one.tilt; }));
    scores.add(name_, kHeading, mean([](const Errors& one) { return one.heading; }));
    scores.add(name_, kVelocity, mean([](const Errors& one) { return one.velocity; }));
    scores.add(name_, kPosition, mean([](const Errors& one) { return one.position; }));
    scores.add(name_, kFirstTilt, errors_.empty() ? kUnknown : errors_.front().tilt);
    scores.add(name_, kCovered, mean([](const Errors& one) { return one.covered ? 1.0 : 0.0; }));
    scores.add(name_, kForecast, forecast_holds_);
    scores.add(name_, kTiltError, kDegPerRad * rms([](const Errors& one) { return one.tilt_rad; }));
    scores.add(name_, kHeadingError, kDegPerRad * rms([](const Errors& one) { return one.heading_rad; }));
    scores.add(name_, kHorizontalError, rms([](const Errors& one) { return one.horizontal_m; }));
    scores.add(name_, kAligned, aligned_s_);
  }

 private:
  std::string_view name_;
  const Cell* cell_;
  estimation::FusionEngine engine_;
  double next_s_ = 0.0;
  double aligned_s_ = kUnknown;
  double forecast_m_ = kUnknown;
  double forecast_until_s_ = kUnknown;
  double forecast_holds_ = kUnknown;
  std::vector<Errors> errors_;
};

class Consistency final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "consistency"; }
  [[nodiscard]] std::string_view description() const override {
    return "is the published uncertainty true: every named configuration over vehicles, motions, grades, "
           "starts and latitudes; NEES as means over a run";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override {
    std::vector<std::string_view> names;
    for (const Cell& cell : consistency_cells()) names.push_back(cell.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string_view> methods() const override {
    return {kConfigurations.begin(), kConfigurations.end()};
  }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    return {{kTilt, "1"},
            {kHeading, "1"},
            {kVelocity, "1"},
            {kPosition, "1"},
            {kFirstTilt, "1"},
            {kCovered, "fraction"},
            {kForecast, "fraction"},
            {kTiltError, "deg"},
            {kHeadingError, "deg"},
            {kHorizontalError, "m"},
            {kAligned, "s", Summary::distribution, Presence::if_it_happens}};
  }
  [[nodiscard]] int default_runs() const override { return 20; }
  void run(const RunRequest& request, Scores& scores) const override;
};

/// GPS alone knows nothing of water: the configurations with states for it are those of submersibles.
bool suits(const Cell& cell, std::string_view configuration) {
  const bool of_water = configuration == "standard" || configuration == "hybrid25" || configuration == "full";
  return of_water == cell.under_water;
}

void Consistency::run(const RunRequest& request, Scores& scores) const {
  const auto cells = consistency_cells();
  const Cell& cell = *std::find_if(cells.begin(), cells.end(),
                                   [&](const Cell& one) { return one.name == request.case_name; });
  CellRun run(cell, request.seed);
  std::vector<Contender> contenders;
  contenders.reserve(kConfigurations.size());
  for (const std::string_view one : kConfigurations)
    if (request.wants(one) && suits(cell, one)) contenders.emplace_back(one, cell, run.pose(), request.seed);
  if (contenders.empty()) return;

  const auto steps = std::lround(cell.duration_s * cell.imu_rate_hz);
  for (long step = 0; step < steps; ++step) {
    run.step([&](const auto& sample) {
      for (Contender& one : contenders) one.take(sample);
    });
    for (Contender& one : contenders) one.look(run.time_s(), [&] { return run.pose(); });
  }
  for (const Contender& one : contenders) one.report(scores);
}

}  // namespace

std::unique_ptr<const Study> make_consistency_study() {
  return std::make_unique<Consistency>();
}

}  // namespace fathom::study
