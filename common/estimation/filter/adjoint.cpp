#include "estimation/filter/adjoint.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "geo/so3.hpp"

namespace fathom::estimation {

using Eigen::Index;

Transition transition(const NavTransition& step, const ProcessNoise& noise) {
  // (KF-1)
  Transition out;
  const NavTransition::Rows rows = step.rows(step.driven());
  out.a = rows.leftCols<kNavStates>();
  out.b = rows.rightCols(step.driven() - kNavStates);
  out.keep.fill(1.0);
  if (noise.drift != nullptr)
    for (const std::uint8_t state : noise.drift->decaying())
      out.keep[state] = noise.drift->kept(state, step.dt_s());
  return out;
}

UpdateRecord::UpdateRecord(const Observation& observation, const InnovationStatistics& statistics,
                           int states) {
  const Index m = statistics.rows;
  Square s(m, m);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Observation::kMaxRows, 1> z(m);
  h.resize(m, states);
  gain.resize(m, states);
  for (Index i = 0; i < m; ++i) {
    const auto row = static_cast<std::size_t>(i);
    z(i) = observation.innovation[row];
    for (Index j = 0; j < m; ++j)
      s(i, j) = statistics.s[row * Observation::kMaxRows + static_cast<std::size_t>(j)];
    for (Index j = 0; j < states; ++j) {
      h(i, j) = observation.h[row][static_cast<std::size_t>(j)];
      gain(i, j) = statistics.ph[row * kMaxStates + static_cast<std::size_t>(j)];
    }
  }
  const Eigen::LLT<Square> factor(s);
  weight = factor.solve(Square::Identity(m, m));
  weighted_innovation = factor.solve(z);
  gain = (weight * gain).eval();
}

DriftRecord::DriftRecord(const ErrorFilter& widened, const std::array<double, kNavStates>& variance) {
  Index n = 0;
  for (int i = 0; i < kNavStates; ++i)
    if (variance[static_cast<std::size_t>(i)] > 0.0) states[static_cast<std::size_t>(n++)] = i;
  const auto state = [&](Index i) { return states[static_cast<std::size_t>(i)]; };
  Block before(n, n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) before(i, j) = widened(state(i), state(j));
    before(i, i) -= variance[static_cast<std::size_t>(state(i))];
  }
  // Metres beside radians: scaled, so that the inverse keeps its digits.
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNavStates, 1> scale =
      before.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Block scaled = scale.asDiagonal() * before * scale.asDiagonal();
  known = scale.asDiagonal() * Eigen::LDLT<Block>(scaled).solve(Block::Identity(n, n)) * scale.asDiagonal();
  stretch = known;
  for (Index j = 0; j < n; ++j) stretch.col(j) *= variance[static_cast<std::size_t>(state(j))];
}

ShiftRecord::ShiftRecord(const ErrorFilter& filter, const std::array<double, kMaxStates>& of,
                         double most_likely, double about)
    : column(filter.size()), known(Vector::Zero(filter.size())), mean(most_likely), variance(about) {
  const Index n = filter.estimated();
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
  Square p(n, n);
  for (Index i = 0; i < column.size(); ++i) column(i) = of[static_cast<std::size_t>(i)];
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) p(i, j) = filter(static_cast<int>(i), static_cast<int>(j));
  // Metres beside radians: scaled, so that the solution keeps its digits.
  const Vector scale = p.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Square scaled = scale.asDiagonal() * p * scale.asDiagonal();
  const Vector weighed = scale.cwiseProduct(column.head(n));
  known.head(n) = scale.cwiseProduct(Vector(Eigen::LDLT<Square>(scaled).solve(weighed)));
}

Adjoint::Adjoint(int states) : lambda_(Vector::Zero(states)), curvature_(Matrix::Zero(states, states)) {}

void Adjoint::back_through(const Transition& step) {
  // (SMOOTH-2): lambda <- Phi' lambda, Lambda <- Phi' Lambda Phi, column by column and then row by row.
  const Index n = size();
  const Index m = step.b.cols();
  const auto keep = [&](Index i) { return step.keep[static_cast<std::size_t>(i)]; };

  const Eigen::Matrix<double, kNavStates, 1> nav = lambda_.head<kNavStates>();
  lambda_.head<kNavStates>() = step.a.transpose() * nav;
  for (Index i = kNavStates; i < n; ++i) lambda_(i) *= keep(i);
  lambda_.segment(kNavStates, m) += step.b.transpose() * nav;

  const Eigen::Matrix<double, Eigen::Dynamic, kNavStates, 0, kMaxStates, kNavStates> columns =
      curvature_.leftCols<kNavStates>();
  for (Index i = kNavStates; i < n; ++i)
    if (keep(i) != 1.0) curvature_.col(i) *= keep(i);
  curvature_.leftCols<kNavStates>().noalias() = columns * step.a;
  curvature_.middleCols(kNavStates, m).noalias() += columns * step.b;

  const Eigen::Matrix<double, kNavStates, Eigen::Dynamic, 0, kNavStates, kMaxStates> rows =
      curvature_.topRows<kNavStates>();
  for (Index i = kNavStates; i < n; ++i)
    if (keep(i) != 1.0) curvature_.row(i) *= keep(i);
  curvature_.topRows<kNavStates>().noalias() = step.a.transpose() * rows;
  curvature_.middleRows(kNavStates, m).noalias() += step.b.transpose() * rows;
  curvature_ = (0.5 * (curvature_ + curvature_.transpose())).eval();
}

void Adjoint::back_through(const UpdateRecord& update) {
  // (SMOOTH-3), the curvature as Lambda + H'T + T'H with T = (K' Lambda K + S^-1) H / 2 - (Lambda K)'.
  lambda_ -= update.h.transpose() * (update.gain * lambda_ + update.weighted_innovation);
  UpdateRecord::Rows spread(update.h.rows(), size());
  spread.noalias() = update.gain * curvature_;
  UpdateRecord::Square own = 0.5 * update.weight;
  own.noalias() += 0.5 * spread * update.gain.transpose();
  UpdateRecord::Rows t = -spread;
  t.noalias() += own * update.h;
  Matrix change(size(), size());
  change.noalias() = update.h.transpose() * t;
  curvature_ += change + change.transpose();
}

void Adjoint::back_through(const DriftRecord& drift) {
  // (SMOOTH-5): with M = I + P^-1 D on the states with room, lambda <- M lambda, Lambda <- M Lambda M' - P^-1
  // D P^-1.
  const Index n = drift.known.rows();
  const auto state = [&](Index i) { return drift.states[static_cast<std::size_t>(i)]; };
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNavStates, 1> own(n);
  for (Index i = 0; i < n; ++i) own(i) = lambda_(state(i));
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNavStates, 1> more = drift.stretch * own;
  for (Index i = 0; i < n; ++i) lambda_(state(i)) += more(i);

  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kNavStates, kMaxStates> rows(n, size());
  for (Index i = 0; i < n; ++i) rows.row(i) = curvature_.row(state(i));
  rows = (drift.stretch * rows).eval();
  for (Index i = 0; i < n; ++i) curvature_.row(state(i)) += rows.row(i);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kNavStates> columns(size(), n);
  for (Index i = 0; i < n; ++i) columns.col(i) = curvature_.col(state(i));
  columns = (columns * drift.stretch.transpose()).eval();
  for (Index i = 0; i < n; ++i) curvature_.col(state(i)) += columns.col(i);
  const DriftRecord::Block made = drift.stretch * drift.known;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) curvature_(state(i), state(j)) -= 0.5 * (made(i, j) + made(j, i));
}

void Adjoint::back_through(const ShiftRecord& shift) {
  // (SMOOTH-6): with w = P^-1 u and M = I + d w u', lambda <- M lambda - m w, Lambda <- M Lambda M' - d w w'.
  lambda_ += (shift.variance * shift.column.dot(lambda_) - shift.mean) * shift.known;
  const Vector seen = shift.variance * (curvature_ * shift.column);
  const double own = shift.variance * (shift.column.dot(seen) - 1.0);
  curvature_ += shift.known * seen.transpose() + seen * shift.known.transpose() +
                own * shift.known * shift.known.transpose();
}

void Adjoint::back_through(const Carry& carry) {
  const Eigen::Matrix<double, Carry::kStates, Carry::kStates> t = carry.matrix();
  lambda_.segment<Carry::kStates>(Carry::kFirst) =
      (t.transpose() * lambda_.segment<Carry::kStates>(Carry::kFirst)).eval();
  curvature_.middleCols<Carry::kStates>(Carry::kFirst) =
      (curvature_.middleCols<Carry::kStates>(Carry::kFirst) * t).eval();
  curvature_.middleRows<Carry::kStates>(Carry::kFirst) =
      (t.transpose() * curvature_.middleRows<Carry::kStates>(Carry::kFirst)).eval();
  curvature_ = (0.5 * (curvature_ + curvature_.transpose())).eval();
}

void Adjoint::back_through_forgotten(int state) {
  // (SMOOTH-4)
  lambda_(state) = 0.0;
  curvature_.row(state).setZero();
  curvature_.col(state).setZero();
}

void Adjoint::cut() {
  lambda_.setZero();
  curvature_.setZero();
}

void Adjoint::smoothed_error(const ErrorFilter& p, std::array<double, kMaxStates>& x) const {
  // (SMOOTH-1)
  x.fill(0.0);
  for (int i = 0; i < size(); ++i) {
    double sum = 0.0;
    for (int j = 0; j < size(); ++j) sum += p(i, j) * lambda_(j);
    x[static_cast<std::size_t>(i)] = -sum;
  }
}

void Adjoint::smooth_covariance(std::span<const int> states, ErrorFilter& p) const {
  // (SMOOTH-1)
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxStates, kMaxStates> rows(
      static_cast<Index>(states.size()), size());
  for (Index r = 0; r < rows.rows(); ++r)
    for (int j = 0; j < size(); ++j) rows(r, j) = p(states[static_cast<std::size_t>(r)], j);
  decltype(rows) product(rows.rows(), rows.cols());
  product.noalias() = rows * curvature_;
  Matrix reduction(rows.rows(), rows.rows());
  reduction.noalias() = product * rows.transpose();
  for (Index r = 0; r < rows.rows(); ++r)
    for (Index c = 0; c <= r; ++c) {
      const int i = states[static_cast<std::size_t>(r)];
      const int j = states[static_cast<std::size_t>(c)];
      const double value = p(i, j) - 0.5 * (reduction(r, c) + reduction(c, r));
      // Rounding must not make a variance negative.
      p.set(i, j, i == j ? std::max(value, 0.0) : value);
    }
}

}  // namespace fathom::estimation
