#include "cli/solve/compare/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "cli/progress.hpp"
#include "cli/solve/compare/verdict_changes.hpp"
#include "cli/solve/smooth.hpp"
#include "dataset/score.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::cli {
namespace {

constexpr double kMostRows = 4000.0;
constexpr DurationNs kSmoothedStep_ns = 40'000'000;  // between two of them a path is straight to a millimetre

Truth truth_of(const NavState& state) {
  Truth truth;
  truth.header = state.header;
  truth.latitude_rad = state.latitude_rad;
  truth.longitude_rad = state.longitude_rad;
  truth.altitude_m = state.altitude_m;
  truth.velocity_N_m_s = state.velocity_N_m_s;
  truth.rpy_rad = state.rpy_rad;
  return truth;
}

bool navigates(const NavState& state) {
  return gives_position(state.mode) && known(state.latitude_rad);
}

dataset::TruthTrack smoothed_track(const SolveRun& first) {
  SolveRun smoothed = first;
  smoothed.label = "smoother";
  dataset::TruthTrack track;
  std::optional<TimeNs> last_ns;
  (void)run_smoothed(smoothed, {nullptr, [&](const NavState& state) {
                                  if (!navigates(state)) return;
                                  if (last_ns && state.header.stamp_ns - *last_ns < kSmoothedStep_ns) return;
                                  last_ns = state.header.stamp_ns;
                                  track.add(truth_of(state));
                                }});
  return track;
}

/// One of the two engines and its figures.
class Side {
 public:
  explicit Side(const SolveRun& solve_run)
      : run_(solve_run), engine_(std::make_unique<estimation::FusionEngine>(engine_of(solve_run))) {
    if (const auto start = start_of(solve_run)) engine_->start_from(*start);
  }

  template <class Sample>
  void add(const Sample& sample) {
    fresh_ = false;
    if (run_.withholds(sample)) return;
    if constexpr (std::is_same_v<Sample, ImuSample>) {
      if (!first_ns_) first_ns_ = sample.header.stamp_ns;
      fresh_ = engine_->add(sample);
      if (fresh_) look(engine_->nav_state());
    } else {
      engine_->add(sample);
    }
  }
  void finish() { engine_->finish(); }

  template <class Consumer>
  void take_verdicts(Consumer&& consumer) {
    Verdict verdict;
    while (engine_->next_verdict(verdict))
      if (verdict.is_final && verdict.source != SourceKind::imu) consumer(verdict);
  }
  /// Of the sample before, where there was one.
  [[nodiscard]] const NavState* state() const { return fresh_ ? &engine_->nav_state() : nullptr; }

  void score(const dataset::NavError& error) { scorer_.add(error); }

  void fill(report::ComparedSolution& out) const {
    out = figures_;
    out.score = scorer_.score();
    if (sigmas_ > 0) out.horizontal_sigma_rms_m = std::sqrt(sigma2_m2_ / static_cast<double>(sigmas_));
  }

 private:
  void look(const NavState& state) {
    figures_.alignment = state.alignment;
    if (state.alignment == AlignmentPhase::aligned && !known(figures_.aligned_after_s))
      figures_.aligned_after_s = to_seconds(state.header.stamp_ns - *first_ns_);
    if (!known(state.latitude_rad)) return;
    ++figures_.positions;
    const double variance = state.position_covariance_N_m2[0] + state.position_covariance_N_m2[4];
    if (!known(variance)) return;
    ++sigmas_;
    sigma2_m2_ += variance;
    figures_.horizontal_sigma_end_m = std::sqrt(variance);
  }

  const SolveRun& run_;
  std::unique_ptr<estimation::FusionEngine> engine_;
  std::optional<TimeNs> first_ns_;
  bool fresh_ = false;
  report::ComparedSolution figures_;
  dataset::Scorer scorer_;
  std::uint64_t sigmas_ = 0;
  double sigma2_m2_ = 0.0;
};

}  // namespace

report::Comparison compare(const CompareRequest& request) {
  const dataset::Dataset& data = *request.first->data;
  report::Comparison out;
  dataset::TruthTrack truth(data.reference);
  if (!truth.rows().empty()) {
    out.against = "the reference";
  } else {
    truth = smoothed_track(*request.first);
    if (!truth.rows().empty()) out.against = "the smoother over the first settings";
  }
  const auto seconds_of = [&request](TimeNs stamp_ns) { return to_seconds(stamp_ns - request.epoch_ns); };
  out.begin_s = seconds_of(data.of<ImuSample>().front().header.stamp_ns);
  out.end_s = seconds_of(data.of<ImuSample>().back().header.stamp_ns);
  const double step_s = std::max(0.1, (out.end_s - out.begin_s) / kMostRows);

  std::array<Side, 2> sides{Side(*request.first), Side(*request.second)};
  VerdictChanges changes(request.epoch_ns);
  dataset::Scorer differences;
  const auto take_verdicts = [&] {
    for (std::size_t which = 0; which < 2; ++which)
      sides[which].take_verdicts([&](const Verdict& verdict) { changes.add(which, verdict); });
  };
  const auto look = [&] {
    const std::array<const NavState*, 2> states{sides[0].state(), sides[1].state()};
    report::ComparedRow row;
    for (std::size_t which = 0; which < 2; ++which) {
      const NavState* state = states[which];
      if (state == nullptr || !navigates(*state)) continue;
      const auto at = truth.at(state->header.stamp_ns);
      if (!at) continue;
      row.error[which] = dataset::error_of(*state, *at);
      sides[which].score(row.error[which]);
    }
    if (states[0] == nullptr || states[1] == nullptr) return;
    row.t_s = seconds_of(states[0]->header.stamp_ns);
    row.latitude_rad = states[0]->latitude_rad;
    row.longitude_rad = states[0]->longitude_rad;
    row.difference = dataset::error_of(*states[1], truth_of(*states[0]));
    for (std::size_t which = 0; which < 2; ++which) {
      row.mode[which] = states[which]->mode;
      for (std::size_t i = 0; i < 3; ++i)
        row.position_sigma_N_m[which][i] = std::sqrt(states[which]->position_covariance_N_m2[4 * i]);
    }
    if (known(row.difference.horizontal_m)) {
      ++out.compared;
      differences.add(row.difference);
    }
    if (request.on_row) request.on_row(row);
    if (out.rows.empty() || row.t_s - out.rows.back().t_s >= step_s) out.rows.push_back(row);
  };

  Progress progress("compare", request.first->arrivals->size());
  std::uint64_t done = 0;
  for (const dataset::Arrival& arrival : *request.first->arrivals) {
    progress.update(++done);
    dataset::visit(data, arrival, [&]<class Sample>(const Sample& sample) {
      for (Side& side : sides) side.add(sample);
      if constexpr (std::is_same_v<Sample, ImuSample>) look();
    });
    take_verdicts();
  }
  for (Side& side : sides) side.finish();
  take_verdicts();
  changes.finish();

  for (std::size_t which = 0; which < 2; ++which) sides[which].fill(out.solutions[which]);
  out.difference = differences.score();
  const auto& all = differences.errors();
  const auto farthest = std::max_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.horizontal_m < b.horizontal_m; });
  if (farthest != all.end()) out.farthest_s = seconds_of(farthest->stamp_ns);
  out.measurements = changes.measurements();
  out.changes = changes.changes();
  out.runs = changes.runs();
  return out;
}

}  // namespace fathom::cli
