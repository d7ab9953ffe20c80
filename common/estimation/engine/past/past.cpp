#include "estimation/engine/past/past.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kFixRows, kFixRows>;

/// A keyframe waits no longer for the covariance: measurements that come with every step may part all
/// strides.
constexpr DurationNs kPatience_ns = kNsPerSecond;

Knot knot_of(const Navigator& navigator) {
  const NavSolution& nav = navigator.state().nav;
  return {navigator.now_ns(), navigator.estimate().travelled_N_m, nav.v_N_m_s, nav.q_NB};
}

/// Way between two knots: the cubic with their places and velocities.
Vector3d way_at(const Knot& a, const Knot& b, TimeNs instant_ns) {
  const double whole_s = to_seconds(b.now_ns - a.now_ns);
  if (!(whole_s > 0.0)) return b.travelled_N_m;
  const double s = to_seconds(instant_ns - a.now_ns) / whole_s;
  const double t = 1.0 - s;
  return t * t * (1.0 + 2.0 * s) * a.travelled_N_m + s * s * (3.0 - 2.0 * s) * b.travelled_N_m +
         whole_s * (s * t * t * a.v_N_m_s - s * s * t * b.v_N_m_s);
}

/// So that all of them, saved, take no more than this.
std::uint64_t most_kept(int states) {
  constexpr std::uint64_t kMostBytes = 1'500'000;
  const auto n = static_cast<std::uint64_t>(states);
  // Transition and half of the curvature; rows of P and the gradient; the way and what else there is.
  const std::uint64_t bytes = sizeof(double) * (n * n + n * (n + 1) / 2 + (kFixStates + 1) * n + 300);
  return std::clamp(kMostBytes / bytes, 2 * Past::kForFixes, Past::kMostKept + Past::kForFixes) -
         Past::kForFixes;
}

/// Of one that asks for more than is remembered.
Judgement unremembered(const Navigator& navigator, const Measurement& measurement) {
  Judgement out;
  out.kind = VerdictKind::late;
  if (!navigator.navigating()) out.kind = VerdictKind::not_aligned;
  if (!navigator.sensor(measurement.sensor).enabled) out.kind = VerdictKind::source_disabled;
  return out;
}

}  // namespace

TimeNs instant_of(const Setup& setup, const SampleHeader& header, int sensor) {
  return header.stamp_ns - from_seconds(setup.sensor(sensor).latency_s);
}

TimeNs acting_of(const Setup& setup, const SampleHeader& header, int sensor) {
  const TimeNs instant_ns = instant_of(setup, header, sensor);
  const bool may_be_old = setup.config.remembers() && setup.sensor(sensor).kind == SourceKind::fix;
  if (!may_be_old || !sound_stamp(header.received_ns)) return instant_ns;
  const bool old = header.received_ns - instant_ns > from_seconds(0.5 * setup.config.horizon_s);
  return old ? header.received_ns : instant_ns;
}

/// One late fix on its way through the judge.
class Past::View final : public Remembered {
 public:
  View(Past& past, const Leg& leg, const LateFix& where, TimeNs instant_ns)
      : past_(past),
        leg_(leg),
        fix_(where),
        instant_ns_(instant_ns),
        state_(past.state_at(where, instant_ns)) {}

  [[nodiscard]] TimeNs instant_ns() const override { return instant_ns_; }
  [[nodiscard]] const FilterState& state() const override { return state_; }

  [[nodiscard]] bool look_back(Observation& whole, InnovationStatistics& statistics) override {
    take_rows(whole);
    if (!past_.look_back(leg_, fix_)) return false;
    statistics.rows = whole.rows;
    statistics.s.fill(0.0);
    for (int i = 0; i < whole.rows; ++i) {
      const auto row = static_cast<std::size_t>(i);
      whole.innovation[row] -= past_.mean_(i);
      statistics.noise[row] = whole.sigma[row] * whole.sigma[row];
      for (int j = 0; j < whole.rows; ++j)
        statistics.s[row * Observation::kMaxRows + static_cast<std::size_t>(j)] =
            past_.sums_(i, j) + (i == j ? statistics.noise[row] : 0.0);
      auto* ph = statistics.ph.data() + row * kMaxStates;
      std::fill_n(ph, kMaxStates, 0.0);
      for (int j = 0; j < past_.columns_.rows(); ++j) ph[j] = past_.columns_(j, i);
    }
    statistics.squared_distance = squared_distance(whole, statistics);
    return true;
  }

  void acts(const Observation& kept) override {
    take_rows(kept);
    for (std::size_t i = 0; i < static_cast<std::size_t>(kept.rows); ++i) {
      fix_.sigma[i] = kept.sigma[i];
      fix_.innovation[i] = kept.innovation[i];
    }
    Keyframe& here = past_.frame(leg_.count - 1);
    here.acted = true;
    here.fix = fix_;
  }

 private:
  void take_rows(const Observation& rows) {
    fix_.rows = rows.rows;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows.rows); ++i)
      for (std::size_t q = 0; q < kFixStates; ++q)
        fix_.h[i][q] = past_.states_[q] < 0 ? 0.0 : rows.h[i][static_cast<std::size_t>(past_.states_[q])];
  }

  Past& past_;
  const Leg& leg_;
  LateFix fix_;
  TimeNs instant_ns_;
  FilterState state_;
};

Past::Past(const Setup& setup)
    : setup_(&setup),
      kept_(most_kept(setup.index.size())),
      interval_ns_(from_seconds(setup.config.late_fix_memory_s / static_cast<double>(kept_))),
      states_{0, 1, 2, 6, 7, 8, setup.index.of(Group::surface_altitude)} {
  if (setup.config.remembers())
    frames_.assign(kMostKept + kForFixes + 2 * kMargin, Keyframe(setup.index.size()));
}

std::uint64_t Past::oldest(const Leg& leg) const {
  const auto before = [](std::uint64_t count, std::uint64_t room) { return count > room ? count - room : 0; };
  // What is kept is one function of the events; what has been overwritten by a navigator ahead is gone.
  return std::max({leg.oldest, before(leg.count, kept_ + kForFixes), before(made_, frames_.size())});
}

void Past::forget(Leg& leg) {
  leg.oldest = leg.count;
  leg.track.count = 0;
  leg.passage.begin();
}

void Past::close(Navigator& navigator, Leg& leg) {
  navigator.follow();
  if (leg.under_way()) {
    Keyframe& before = frame(leg.count - 1);
    before.track = leg.track;
    before.onward = leg.passage;
  }
  Keyframe& now = frame(leg.count);
  now.here = knot_of(navigator);
  now.position = navigator.state().nav.position;
  now.x = navigator.state().x;
  const ErrorFilter& filter = navigator.filter();
  for (std::size_t q = 0; q < kFixStates; ++q)
    for (int j = 0; j < filter.size(); ++j)
      now.p[q][static_cast<std::size_t>(j)] = states_[q] < 0 ? 0.0 : filter(states_[q], j);
  now.acted = false;
  now.track.count = 0;
  ++leg.count;
  made_ = std::max(made_, leg.count);
  leg.begun_ns = leg.knot_ns = navigator.now_ns();
  leg.track.count = 0;
  leg.passage.begin();
}

void Past::follow(Navigator& navigator, Leg& leg) {
  if (!navigator.navigating() || navigator.descent().aligning()) {
    if (leg.under_way()) forget(leg);
    return;
  }
  if (leg.passage.is_cut()) forget(leg);
  const TimeNs now_ns = navigator.now_ns();
  if (!leg.under_way() || now_ns - leg.begun_ns >= interval_ns_) {
    // Where the covariance has followed anyway: whoever remembers navigates as whoever does not.
    const TimeNs since_ns = std::max(leg.begun_ns, navigator.estimate().began_ns);
    if (navigator.estimate().stride.is_empty() || now_ns - since_ns >= interval_ns_ + kPatience_ns)
      close(navigator, leg);
  } else if (leg.track.count < Track::kKnots &&
             now_ns - leg.knot_ns >= interval_ns_ / static_cast<DurationNs>(Track::kKnots + 1)) {
    leg.track.knots[leg.track.count++] = knot_of(navigator);
    leg.knot_ns = now_ns;
  }
}

Judgement Past::judge(Navigator& navigator, Leg& leg, const Measurement& measurement) {
  const TimeNs instant_ns = instant_of(*setup_, measurement.header(), measurement.sensor);
  if (leg.passage.is_cut()) forget(leg);
  if (!leg.under_way()) return unremembered(navigator, measurement);
  close(navigator, leg);
  const std::optional<LateFix> where = place(leg, instant_ns);
  if (!where) return unremembered(navigator, measurement);
  View view(*this, leg, *where, instant_ns);
  const Judgement judgement = navigator.apply_late(measurement, view);
  // What it has moved is another filter, at the same instant.
  if (frame(leg.count - 1).acted) close(navigator, leg);
  return judgement;
}

std::optional<LateFix> Past::place(const Leg& leg, TimeNs instant_ns) const {
  const std::uint64_t first = oldest(leg);
  // Between two keyframes: of a single one nothing is known but the present.
  if (leg.count < first + 2 || instant_ns < frame(first).here.now_ns) return std::nullopt;
  LateFix out;
  out.after = leg.count - 2;
  while (out.after > first && frame(out.after).here.now_ns > instant_ns) --out.after;
  const TimeNs begin_ns = frame(out.after).here.now_ns;
  const double whole_s = to_seconds(frame(out.after + 1).here.now_ns - begin_ns);
  out.share = whole_s > 0.0 ? to_seconds(instant_ns - begin_ns) / whole_s : 1.0;
  return out;
}

FilterState Past::state_at(const LateFix& where, TimeNs instant_ns) const {
  const Keyframe& a = frame(where.after);
  const Keyframe& b = frame(where.after + 1);
  const Knot* before = &a.here;
  const Knot* behind = &b.here;
  for (std::size_t i = 0; i < a.track.count; ++i) {
    const Knot& one = a.track.knots[i];
    if (one.now_ns > instant_ns) {
      behind = &one;
      break;
    }
    before = &one;
  }
  // (LATE-3): the way by the velocity, drawn out to where the filter was at both ends.
  const Vector3d way = b.here.travelled_N_m - a.here.travelled_N_m;
  const Vector3d drawn = geo::difference_N(a.position, b.position) - way;
  const Vector3d moved = way_at(*before, *behind, instant_ns) - a.here.travelled_N_m + where.share * drawn;
  const bool nearer_before = 2 * instant_ns < before->now_ns + behind->now_ns;
  FilterState out;
  out.nav.position = geo::moved_by(a.position, moved);
  out.nav.v_N_m_s = nearer_before ? before->v_N_m_s : behind->v_N_m_s;
  out.nav.q_NB = nearer_before ? before->q_NB : behind->q_NB;
  for (std::size_t i = 0; i < kMaxStates; ++i) out.x[i] = (1.0 - where.share) * a.x[i] + where.share * b.x[i];
  return out;
}

void Past::join(const LateFix& fix, double weight, const Keyframe& at, int first) {
  const int states = static_cast<int>(columns_.rows());
  for (int i = 0; i < fix.rows; ++i) {
    const auto& h = fix.h[static_cast<std::size_t>(i)];
    // With all that is in the columns already,
    Passage::Vector shared = Passage::Vector::Zero(columns_.cols());
    Passage::Vector error = Passage::Vector::Zero(kFixRows);
    for (std::size_t q = 0; q < kFixStates; ++q) {
      const double factor = weight * h[q];
      if (factor == 0.0) continue;
      shared += factor * columns_.row(states_[q]).transpose();
      for (int j = 0; j < fix.rows; ++j) {
        // and its own rows among themselves.
        double p_h = 0.0;
        for (std::size_t r = 0; r < kFixStates; ++r)
          if (states_[r] >= 0)
            p_h += at.p[q][static_cast<std::size_t>(states_[r])] * fix.h[static_cast<std::size_t>(j)][r];
        error(j) += factor * weight * p_h;
      }
    }
    sums_.row(first + i) += shared.transpose();
    sums_.col(first + i) += shared;
    for (int j = 0; j < fix.rows; ++j) sums_(first + i, first + j) += error(j);
  }
  for (int i = 0; i < fix.rows; ++i)
    for (std::size_t q = 0; q < kFixStates; ++q) {
      const double factor = weight * fix.h[static_cast<std::size_t>(i)][q];
      if (factor == 0.0) continue;
      for (int j = 0; j < states; ++j)
        columns_(j, first + i) += factor * at.p[q][static_cast<std::size_t>(j)];
    }
}

bool Past::look_back(const Leg& leg, const LateFix& fix) {
  const std::uint64_t last = leg.count - 1;
  const std::uint64_t first = oldest(leg);
  // Late fixes that acted since then, and what these ask for in turn.
  std::array<const LateFix*, kMostFixes> fixes{&fix};
  std::array<std::uint64_t, kMostFixes> acting{last};
  std::size_t count = 1;
  std::uint64_t start = fix.after;
  for (std::uint64_t j = last; j > start;) {
    const Keyframe& one = frame(--j);
    if (!one.acted) continue;
    if (count == fixes.size() || one.fix.after < first) return false;
    fixes[count] = &one.fix;
    acting[count++] = j;
    start = std::min(start, one.fix.after);
  }
  const int width = static_cast<int>(count) * kFixRows;
  columns_.setZero(setup_->index.size(), width);
  sums_.setZero(width, width);
  mean_.setZero(width);
  for (std::uint64_t j = start;; ++j) {
    const Keyframe& one = frame(j);
    for (std::size_t k = 0; k < count; ++k)
      if (fixes[k]->after + 1 == j) join(*fixes[k], fixes[k]->share, one, static_cast<int>(k) * kFixRows);
    if (j == last) return true;
    for (std::size_t k = 1; k < count; ++k)
      if (acting[k] == j) act(*fixes[k], static_cast<int>(k) * kFixRows);
    for (std::size_t k = 0; k < count; ++k)
      if (fixes[k]->after == j) join(*fixes[k], 1.0 - fixes[k]->share, one, static_cast<int>(k) * kFixRows);
    one.onward.carry_along(columns_, sums_, mean_);
  }
}

void Past::act(const LateFix& fix, int first) {
  // (LATE-4)
  const int m = fix.rows;
  Small s = sums_.block(first, first, m, m);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kFixRows, 1> z(m);
  for (int i = 0; i < m; ++i) {
    const double sigma = fix.sigma[static_cast<std::size_t>(i)];
    s(i, i) += sigma * sigma;
    z(i) = fix.innovation[static_cast<std::size_t>(i)];
  }
  const Eigen::LLT<Small> factor(s);
  using Wide = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kFixRows, Passage::kColumns>;
  const Wide seen = sums_.middleRows(first, m);
  const Wide weighed = factor.solve(seen);
  mean_.noalias() += seen.transpose().lazyProduct(factor.solve(z));
  const Passage::Columns gain = columns_.middleCols(first, m);
  columns_.noalias() -= gain.lazyProduct(weighed);
  sums_.noalias() -= seen.transpose().lazyProduct(weighed);
  // It has acted: nobody asks for it any more.
  columns_.middleCols(first, kFixRows).setZero();
  sums_.middleRows(first, kFixRows).setZero();
  sums_.middleCols(first, kFixRows).setZero();
}

}  // namespace fathom::estimation
