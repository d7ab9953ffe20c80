#include "cli/report/gather.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/median.hpp"
#include "dataset/score.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::cli {
namespace {

using report::Material;

constexpr double kMostRows = 4000.0;
constexpr double kOutage_s = 5.0;
constexpr std::size_t kMostOutages = 40;
constexpr double kGapSteps = 5.0;
/// Ages of an outage for which its forecast is kept, s.
constexpr std::array<double, 12> kAges_s{5, 10, 15, 20, 30, 45, 60, 120, 300, 600, 1800, 7200};

double horizontal_sigma_m(const NavState& state) {
  return std::sqrt(state.position_covariance_N_m2[0] + state.position_covariance_N_m2[4]);
}

/// Sees outages of GPS begin and end.
class OutageWatch {
 public:
  void add(const NavState& state, double t_s, double error_m, estimation::FusionEngine& engine) {
    const double outage_s = state.gps_outage_s;
    if (!known(outage_s)) return;
    if (outage_s < last_outage_s_) close();
    if (outage_s < 1.0) {
      sigma_before_m_ = horizontal_sigma_m(state);
    } else if (outage_s >= kOutage_s && !open_) {
      open_ = report::Outage{t_s - outage_s, t_s, sigma_before_m_, kUnknown, kUnknown, kUnknown};
      engine.take_forecast();
      for (std::size_t i = 0; i < kAges_s.size(); ++i)
        forecast_m_[i] = engine.forecast_horizontal_95_m(std::max(0.0, kAges_s[i] - outage_s));
    }
    if (open_) {
      open_->end_s = t_s;
      open_->sigma_after_m = horizontal_sigma_m(state);
      open_->error_m = error_m;
    }
    last_outage_s_ = outage_s;
  }
  void close() {
    if (open_) {
      open_->forecast_95_m = forecast_at(open_->end_s - open_->begin_s);
      outages_.push_back(*open_);
    }
    open_.reset();
  }
  std::vector<report::Outage> longest() {
    const auto longer = [](const report::Outage& a, const report::Outage& b) {
      return a.end_s - a.begin_s > b.end_s - b.begin_s;
    };
    std::stable_sort(outages_.begin(), outages_.end(), longer);
    if (outages_.size() > kMostOutages) outages_.resize(kMostOutages);
    std::stable_sort(outages_.begin(), outages_.end(),
                     [](const auto& a, const auto& b) { return a.begin_s < b.begin_s; });
    return std::move(outages_);
  }

 private:
  [[nodiscard]] double forecast_at(double age_s) const {
    for (std::size_t i = 1; i < kAges_s.size(); ++i) {
      if (age_s > kAges_s[i]) continue;
      const double part = (age_s - kAges_s[i - 1]) / (kAges_s[i] - kAges_s[i - 1]);
      return forecast_m_[i - 1] + part * (forecast_m_[i] - forecast_m_[i - 1]);
    }
    return kUnknown;
  }

  std::optional<report::Outage> open_;
  std::array<double, kAges_s.size()> forecast_m_{};
  double sigma_before_m_ = kUnknown;
  double last_outage_s_ = 0.0;
  std::vector<report::Outage> outages_;
};

void look_at_inertial(const std::vector<ImuSample>& samples, TimeNs epoch_ns, Material& out) {
  const auto seconds_of = [epoch_ns](TimeNs stamp_ns) { return to_seconds(stamp_ns - epoch_ns); };
  out.imu_samples = samples.size();
  out.begin_s = seconds_of(samples.front().header.stamp_ns);
  out.end_s = seconds_of(samples.back().header.stamp_ns);
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps.push_back(to_seconds(samples[i].header.stamp_ns - samples[i - 1].header.stamp_ns));
  if (steps.empty()) return;
  out.imu_step_s = median(steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] > kGapSteps * out.imu_step_s)
      out.imu_gaps.push_back({seconds_of(samples[i].header.stamp_ns), steps[i]});
  }
}

template <class Sample>
std::vector<report::Place> places(const std::vector<Sample>& samples, TimeNs epoch_ns) {
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / static_cast<std::size_t>(kMostRows));
  std::vector<report::Place> out;
  for (std::size_t i = 0; i < samples.size(); i += stride)
    out.push_back({to_seconds(samples[i].header.stamp_ns - epoch_ns), samples[i].latitude_rad,
                   samples[i].longitude_rad});
  return out;
}

class Gatherer {
 public:
  Gatherer(const SolveRun& solve_run, TimeNs epoch_ns)
      : epoch_ns_(epoch_ns), truth_(solve_run.data->reference) {
    const dataset::Dataset& data = *solve_run.data;
    look_at_inertial(data.of<ImuSample>(), epoch_ns_, out_);
    step_s_ = std::max(0.1, (out_.end_s - out_.begin_s) / kMostRows);
    for_each_kind([&](auto kind) {
      const std::size_t rows = data.of<typename decltype(kind)::Sample>().size();
      if (rows > 0) out_.samples[std::string(kind.kWord)] = rows;
    });
    out_.reference = places(data.reference, epoch_ns_);
    std::vector<GpsSample> fixes;
    for (const GpsSample& fix : data.of<GpsSample>())
      if (fix.fix != GpsFix::none && !solve_run.removes(fix)) fixes.push_back(fix);
    out_.fixes = places(fixes, epoch_ns_);
  }

  void add(const NavState& state, estimation::FusionEngine& engine) {
    const double t_s = seconds_of(state.header.stamp_ns);
    if (out_.phases.empty() || out_.phases.back().phase != state.alignment)
      out_.phases.push_back({t_s, state.alignment});
    std::optional<dataset::NavError> error;
    if (gives_position(state.mode)) {
      if (const auto truth = truth_.at(state.header.stamp_ns)) error = dataset::error_of(state, *truth);
    }
    if (error) scorer_.add(*error);
    outages_.add(state, t_s, error ? error->horizontal_m : kUnknown, engine);
    if (!out_.states.empty() && t_s - out_.states.back().t_s < step_s_) return;
    out_.states.push_back(report::row_of(state, t_s));
    if (error) out_.errors.push_back({t_s, *error, out_.states.back().position_sigma_N_m});
  }

  void add(const Verdict& verdict) {
    if (verdict.source == SourceKind::imu) return;
    const std::string sensor(verdict.header.sensor.view());
    const std::string model(verdict.model.view());
    auto found = std::find_if(out_.sources.begin(), out_.sources.end(), [&](const report::Source& one) {
      return one.kind == verdict.source && one.sensor == sensor && one.model == model;
    });
    if (found == out_.sources.end()) {
      report::Source& fresh = out_.sources.emplace_back();
      fresh.kind = verdict.source;
      fresh.sensor = sensor;
      fresh.model = model;
      found = std::prev(out_.sources.end());
    }
    found->add(verdict, seconds_of(verdict.header.stamp_ns));
  }

  Material finish() {
    outages_.close();
    out_.outages = outages_.longest();
    out_.score = scorer_.score();
    std::stable_sort(out_.sources.begin(), out_.sources.end(),
                     [](const report::Source& a, const report::Source& b) { return a.kind < b.kind; });
    return std::move(out_);
  }

 private:
  [[nodiscard]] double seconds_of(TimeNs stamp_ns) const { return to_seconds(stamp_ns - epoch_ns_); }

  TimeNs epoch_ns_;
  Material out_;
  dataset::TruthTrack truth_;
  dataset::Scorer scorer_;
  OutageWatch outages_;
  double step_s_ = 0.1;
};

}  // namespace

Material gather(const SolveRun& solve_run, TimeNs epoch_ns) {
  Gatherer gatherer(solve_run, epoch_ns);
  SolveRun own = solve_run;
  own.on_state = [&](const NavState& state, estimation::FusionEngine& engine) {
    gatherer.add(state, engine);
  };
  own.on_verdict = [&](const Verdict& verdict) { gatherer.add(verdict); };
  const SolveResult result = run(own);
  Material out = gatherer.finish();
  out.start_heading_error_rad = start_heading_error_rad(result.alignment);
  out.noise_factors = result.noise_factors;
  for (const auto& [axis, one] : result.biases) out.biases.push_back(one);
  return out;
}

}  // namespace fathom::cli
