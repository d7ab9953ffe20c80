#include "estimation/filter/passage.hpp"

#include <cmath>

#include "base/wide.hpp"
#include "estimation/filter/adjoint.hpp"

namespace fathom::estimation {
namespace {

/// Cholesky factor of S.
struct Lower {
  explicit Lower(const InnovationStatistics& statistics) : rows(statistics.rows) {
    for (int j = 0; j < rows; ++j)
      for (int i = j; i < rows; ++i) {
        double value = statistics.s[static_cast<std::size_t>(i * Observation::kMaxRows + j)];
        for (int k = 0; k < j; ++k) value -= (*this)(i, k) * (*this)(j, k);
        l[static_cast<std::size_t>(i * Observation::kMaxRows + j)] =
            i == j ? std::sqrt(value) : value / (*this)(j, j);
      }
  }
  [[nodiscard]] double operator()(int i, int j) const {
    return l[static_cast<std::size_t>(i * Observation::kMaxRows + j)];
  }

  int rows;
  std::array<double, static_cast<std::size_t>(Observation::kMaxRows) * Observation::kMaxRows> l{};
};
using Block = std::array<double, static_cast<std::size_t>(Observation::kMaxRows) * kMaxStates>;

/// Rows <- L^-1 rows, in place.
FATHOM_WITHIN void solve(const Lower& lower, double* rows, int columns) {
  for (int i = 0; i < lower.rows; ++i) {
    double* row = rows + i * kMaxStates;
    for (int k = 0; k < i; ++k) {
      const double factor = lower(i, k);
      const double* other = rows + k * kMaxStates;
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j) row[j] -= factor * other[j];
    }
    const double inverse = 1.0 / lower(i, i);
    for (int j = 0; j < columns; ++j) row[j] *= inverse;
  }
}

/// target <- target + sign left' right.
FATHOM_WITHIN void add_product(double sign, const double* left, const double* right, int rows, int states,
                               int columns, double* target) {
  for (int k = 0; k < rows; ++k) {
    const double* from = right + k * kMaxStates;
    for (int r = 0; r < states; ++r) {
      const double factor = sign * left[k * kMaxStates + r];
      double* to = target + static_cast<std::size_t>(r * kRowStride);
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j) to[j] += factor * from[j];
    }
  }
}

/// seen <- H a.
FATHOM_WITHIN void look(const Observation& observation, const double* a, int columns, double* seen) {
  for (int i = 0; i < observation.rows; ++i) {
    double* row = seen + i * kMaxStates;
    std::fill(row, row + columns, 0.0);
    for (int c = 0; c < observation.column_count; ++c) {
      const auto column = observation.columns[static_cast<std::size_t>(c)];
      const double factor = observation.h[static_cast<std::size_t>(i)][column];
      const double* from = a + static_cast<std::size_t>(column) * kRowStride;
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j) row[j] += factor * from[j];
    }
  }
}

/// (LATE-1) of an update, but for the gradient: `seen` becomes L^-1 H A, `gain` is L^-1 H P.
FATHOM_WIDE void take_in(const Observation& observation, const Lower& lower, double* gain, int states,
                         int columns, double* a, double* w, double* seen) {
  look(observation, a, columns, seen);
  solve(lower, seen, columns);
  solve(lower, gain, columns);
  add_product(1.0, seen, seen, observation.rows, states, columns, w);
  add_product(-1.0, gain, seen, observation.rows, states, columns, a);
}

}  // namespace

void Passage::begin() {
  cut_ = false;
  gradient_.fill(0.0);
  for (int i = 0; i < n_; ++i) {
    std::fill_n(a_.data() + at(i, 0), kMaxStates, 0.0);
    std::fill_n(w_.data() + at(i, 0), kMaxStates, 0.0);
    a_[at(i, i)] = 1.0;
  }
}

void Passage::propagated(const NavTransition& transition, const ProcessNoise& noise) {
  transition.apply(a_.data(), width());
  if (noise.drift == nullptr) return;
  for (const std::uint8_t state : noise.drift->decaying()) {
    const double kept = noise.drift->kept(state, transition.dt_s());
    double* row = a_.data() + at(state, 0);
    for (int j = 0; j < n_; ++j) row[j] *= kept;
  }
}

void Passage::updated(const Observation& observation, const InnovationStatistics& statistics) {
  const int m = statistics.rows;
  const Lower lower(statistics);
  Block gain;
  Block seen;
  std::array<double, Observation::kMaxRows> y{};
  for (int i = 0; i < m; ++i) {
    const auto row = static_cast<std::size_t>(i) * kMaxStates;
    std::copy_n(statistics.ph.data() + row, kMaxStates, gain.data() + row);
    double value = observation.innovation[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) value -= lower(i, k) * y[static_cast<std::size_t>(k)];
    y[static_cast<std::size_t>(i)] = value / lower(i, i);
  }
  take_in(observation, lower, gain.data(), n_, width(), a_.data(), w_.data(), seen.data());
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n_; ++j)
      gradient_[static_cast<std::size_t>(j)] -=
          seen[static_cast<std::size_t>(i * kMaxStates + j)] * y[static_cast<std::size_t>(i)];
}

void Passage::forgot(int state) {
  // (SMOOTH-4)
  std::fill_n(a_.begin() + static_cast<std::ptrdiff_t>(at(state, 0)), width(), 0.0);
}

void Passage::drifted(const ErrorFilter& widened, const std::array<double, kNavStates>& variance) {
  // (SMOOTH-5)
  const DriftRecord drift(widened, variance);
  const Eigen::Index n = drift.known.rows();
  const auto state = [&](Eigen::Index i) { return drift.states[static_cast<std::size_t>(i)]; };
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kNavStates, kMaxStates> rows(n, n_);
  for (Eigen::Index i = 0; i < n; ++i)
    for (int j = 0; j < n_; ++j) rows(i, j) = a_[at(state(i), j)];
  const DriftRecord::Block made = drift.stretch * drift.known;
  const DriftRecord::Block even = 0.5 * (made + made.transpose());
  const decltype(rows) weighed = even * rows;
  for (int r = 0; r < n_; ++r)
    for (int j = 0; j <= r; ++j) {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) sum += rows(i, r) * weighed(i, j);
      w_[at(r, j)] -= sum;
      w_[at(j, r)] = w_[at(r, j)];
    }
  const decltype(rows) more = drift.stretch.transpose() * rows;
  for (Eigen::Index i = 0; i < n; ++i)
    for (int j = 0; j < n_; ++j) a_[at(state(i), j)] += more(i, j);
}

void Passage::shifted(const ErrorFilter& filter, const std::array<double, kMaxStates>& column, double mean,
                      double variance) {
  // (SMOOTH-6)
  const ShiftRecord shift(filter, column, mean, variance);
  std::array<double, kMaxStates> seen{};  // A' w
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < n_; ++j) seen[static_cast<std::size_t>(j)] += shift.known(i) * a_[at(i, j)];
  for (int i = 0; i < n_; ++i) {
    const double own = seen[static_cast<std::size_t>(i)];
    gradient_[static_cast<std::size_t>(i)] -= mean * own;
    const double factor = variance * shift.column(i);
    for (int j = 0; j < n_; ++j) a_[at(i, j)] += factor * seen[static_cast<std::size_t>(j)];
    for (int j = 0; j <= i; ++j) {
      w_[at(i, j)] -= variance * own * seen[static_cast<std::size_t>(j)];
      w_[at(j, i)] = w_[at(i, j)];
    }
  }
}

void Passage::carried(const Carry& carry) {
  using Rows =
      Eigen::Matrix<double, Carry::kStates, Eigen::Dynamic, Eigen::RowMajor, Carry::kStates, kMaxStates>;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
             Eigen::OuterStride<kRowStride>>
      rows(a_.data() + at(Carry::kFirst, 0), Carry::kStates, n_);
  const Rows before = rows;
  rows.topRows<3>() = carry.turn * before.topRows<3>();
  rows.topRows<3>() += carry.velocity_by_attitude * before.middleRows<3>(3);
  rows.middleRows<3>(3) = carry.turn * before.middleRows<3>(3);
  rows.bottomRows<3>() = carry.bias_own * before.bottomRows<3>();
}

void Passage::restarted() {
  begin();
  cut_ = true;
}

void Passage::carry_along(Columns& columns, Square& sums, Vector& mean) const {
  // (LATE-2)
  Columns weighed(n_, columns.cols());
  weighed.noalias() = curvature().lazyProduct(columns);
  sums.noalias() -= columns.transpose().lazyProduct(weighed);
  mean.noalias() -= columns.transpose().lazyProduct(
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>>(gradient_.data(), n_));
  weighed.noalias() = transition().lazyProduct(columns);
  columns = weighed;
}

}  // namespace fathom::estimation
