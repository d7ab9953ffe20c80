#include "estimation/filter/error_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/wide.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

constexpr int kRows = Observation::kMaxRows;
/// A measurement whose variance is less than this share of what P has there: of the fifteen digits of
/// P - K S K' six are left.
constexpr double kDwarfed = 1e-9;
/// What rounding may take of the least variance that a measurement leaves.
constexpr double kRoundingLeaves = 0.5;

/// Lower Cholesky factor in place; false when not positive definite.
bool factorise(std::array<double, kStatisticsStride * kStatisticsStride>& a, int n) {
  const auto at = [](int i, int j) {
    return static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(j);
  };
  for (int j = 0; j < n; ++j) {
    double diagonal = a[at(j, j)];
    for (int k = 0; k < j; ++k) diagonal -= a[at(j, k)] * a[at(j, k)];
    if (!(diagonal > 0.0)) return false;
    const double root = std::sqrt(diagonal);
    a[at(j, j)] = root;
    for (int i = j + 1; i < n; ++i) {
      double value = a[at(i, j)];
      for (int k = 0; k < j; ++k) value -= a[at(i, k)] * a[at(j, k)];
      a[at(i, j)] = value / root;
    }
  }
  return true;
}

/// P <- P - V' V for kCount rows of V, but for what the considered states share among themselves. Both halves
/// are computed, by the same products in the same order, which costs less than copying one.
template <int kCount>
FATHOM_WITHIN void subtract(const double* v, int states, int estimated, double* p) {
  const int width = (states + 1) & ~1;
  for (int r = 0; r < states; ++r) {
    double* target = p + static_cast<std::size_t>(r * kRowStride);
    const int columns = r < estimated ? width : estimated;
    if constexpr (kCount == 3) {
      const double a = v[r];
      const double b = v[r + kMaxStates];
      const double c = v[r + 2 * kMaxStates];
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j)
        target[j] -= a * v[j] + b * v[j + kMaxStates] + c * v[j + 2 * kMaxStates];
    } else if constexpr (kCount == 2) {
      const double a = v[r];
      const double b = v[r + kMaxStates];
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j) target[j] -= a * v[j] + b * v[j + kMaxStates];
    } else {
      const double a = v[r];
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j) target[j] -= a * v[j];
    }
  }
}

}  // namespace

FATHOM_WIDE void ErrorFilter::copy(const ErrorFilter& other) {
  // Rows are short: a call for each would cost more than its copying.
  const int columns = width();
  for (int i = 0; i < n_; ++i) {
    const double* from = other.p_.data() + at(i, 0);
    double* to = p_.data() + at(i, 0);
    int j = 0;
    for (; j + 4 <= columns; j += 4) {
      const double a = from[j];
      const double b = from[j + 1];
      const double c = from[j + 2];
      const double d = from[j + 3];
      to[j] = a;
      to[j + 1] = b;
      to[j + 2] = c;
      to[j + 3] = d;
    }
    for (; j < columns; ++j) to[j] = from[j];
  }
}

void ErrorFilter::reset(const std::array<double, kMaxStates>& sigma) {
  if (tape_ != nullptr) tape_->restarted();
  std::fill(p_.begin(), p_.end(), 0.0);
  for (int i = 0; i < n_; ++i) {
    const double s = sigma[static_cast<std::size_t>(i)];
    p_[at(i, i)] = s * s;
  }
}

void ErrorFilter::widen_drifted(const std::array<double, kNavStates>& variance) {
  for (int i = 0; i < kNavStates; ++i) widen(i, variance[static_cast<std::size_t>(i)]);
  if (tape_ != nullptr) tape_->drifted(*this, variance);
}

void ErrorFilter::shift(const std::array<double, kMaxStates>& column, double mean, double variance) {
  // (GATE-9)
  if (tape_ != nullptr) tape_->shifted(*this, column, mean, variance);
  for (int i = 0; i < n_; ++i) {
    const double factor = variance * column[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j) set(i, j, (*this)(i, j) + factor * column[static_cast<std::size_t>(j)]);
    const double left = i < estimated_ ? 0.0 : mean * column[static_cast<std::size_t>(i)];
    widen(i, left * left);
  }
}

void ErrorFilter::forget(int state, double sigma) {
  if (tape_ != nullptr) tape_->forgot(state);
  for (int j = 0; j < n_; ++j) set(state, j, 0.0);
  p_[at(state, state)] = sigma * sigma;
}

FATHOM_WIDE void ErrorFilter::propagate(const NavTransition& transition, const ProcessNoise& noise) {
  // (KF-1)
  if (tape_ != nullptr) tape_->propagated(transition, noise);
  double* p = p_.data();
  const double dt = transition.dt_s();
  transition.apply(p, width());
  // What the others share with the navigation states is now in the nine rows; the columns follow. The corner
  // is turned over, so that the same map, applied to it once more, completes Phi P Phi'.
  const int n = n_;
  for (int i = 1; i < kNavStates; ++i)
    for (int j = 0; j < i; ++j) std::swap(p[i * kRowStride + j], p[j * kRowStride + i]);
  for (int i = kNavStates; i < n; ++i) {
    double* row = p + i * kRowStride;
    const double* column = p + i;
#pragma GCC ivdep
#pragma GCC unroll 9
    for (int j = 0; j < kNavStates; ++j) row[j] = column[j * kRowStride];
  }
  transition.apply(p, kNavStates);

  // White noise of the acceleration reaches the position through the velocity within the step.
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double q = dt * noise.velocity(i, j);
      p[at(i, j)] += dt * dt * (1.0 / 3.0) * q;
      p[at(3 + i, j)] += 0.5 * dt * q;
      p[at(3 + i, 3 + j)] += q;
      p[at(6 + i, 6 + j)] += dt * noise.attitude(i, j);
    }
  for (int i = 1; i < kNavStates; ++i)
    for (int j = 0; j < i; ++j) p[at(j, i)] = p[at(i, j)];

  if (noise.drift == nullptr) return;
  for (const std::uint8_t state : noise.drift->decaying()) {
    const double kept = noise.drift->kept(state, dt);
    double* row = p + state * kRowStride;
    double* column = p + state;
#pragma GCC ivdep
    for (int j = 0; j < n; ++j) row[j] *= kept;
    row[state] *= kept;
#pragma GCC ivdep
    for (int j = 0; j < n; ++j) column[j * kRowStride] = row[j];
  }
  for (const std::uint8_t state : noise.drift->walking())
    p[at(state, state)] += dt * noise.drift->walk(state);
}

FATHOM_WIDE void ErrorFilter::statistics(const Observation& observation, double noise_scale,
                                         InnovationStatistics& out) const {
  // (KF-2)
  const int m = observation.rows;
  const auto n = static_cast<std::size_t>(width());
  out.rows = m;
  out.s.fill(0.0);
  for (int i = 0; i < m; ++i) {
    double* ph = out.ph.data() + static_cast<std::size_t>(i) * kMaxStates;
    std::fill(ph, ph + n, 0.0);
    const auto& h = observation.h[static_cast<std::size_t>(i)];
    for (int c = 0; c < observation.column_count; ++c) {
      const auto column = observation.columns[static_cast<std::size_t>(c)];
      const double factor = h[column];
      if (factor == 0.0) continue;
      const double* row = p_.data() + at(column, 0);
      for (std::size_t j = 0; j < n; ++j) ph[j] += factor * row[j];
    }
  }
  for (int i = 0; i < m; ++i) {
    const double* ph = out.ph.data() + static_cast<std::size_t>(i) * kMaxStates;
    for (int j = 0; j <= i; ++j) {
      const auto& h = observation.h[static_cast<std::size_t>(j)];
      double sum = 0.0;
      for (int c = 0; c < observation.column_count; ++c) {
        const auto column = observation.columns[static_cast<std::size_t>(c)];
        sum += h[column] * ph[column];
      }
      const double sigma = observation.sigma[static_cast<std::size_t>(i)];
      if (i == j) {
        out.noise[static_cast<std::size_t>(i)] = noise_scale * sigma * sigma;
        sum += out.noise[static_cast<std::size_t>(i)];
      }
      out.s[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(j)] = sum;
      out.s[static_cast<std::size_t>(j) * kStatisticsStride + static_cast<std::size_t>(i)] = sum;
    }
  }
  out.squared_distance = squared_distance(observation, out);
}

double squared_distance(const Observation& observation, const InnovationStatistics& statistics) {
  const int m = statistics.rows;
  auto lower = statistics.s;
  if (!factorise(lower, m)) return std::numeric_limits<double>::infinity();
  double distance = 0.0;
  std::array<double, kRows> y{};
  for (int i = 0; i < m; ++i) {
    double value = observation.innovation[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k)
      value -= lower[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(k)] *
               y[static_cast<std::size_t>(k)];
    value /= lower[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(i)];
    y[static_cast<std::size_t>(i)] = value;
    distance += value * value;
  }
  return distance;
}

FATHOM_WIDE bool ErrorFilter::update(const Observation& observation, const InnovationStatistics& statistics,
                                     std::array<double, kMaxStates>& x) {
  // (KF-3): with S = L L', V = L^-1 (P H')' and y = L^-1 innovation: x = V' y and P <- P - V' V.
  const int m = statistics.rows;
  const auto n = static_cast<std::size_t>(width());
  auto lower = statistics.s;
  if (!factorise(lower, m)) return false;
  if (tape_ != nullptr) tape_->updated(observation, statistics);
  std::array<double, static_cast<std::size_t>(kRows) * kMaxStates> v;
  std::array<double, kRows> y{};
  for (int i = 0; i < m; ++i) {
    double* row = v.data() + static_cast<std::size_t>(i) * kMaxStates;
    std::copy_n(statistics.ph.data() + static_cast<std::size_t>(i) * kMaxStates, n, row);
    double value = observation.innovation[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) {
      const double factor =
          lower[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(k)];
      const double* other = v.data() + static_cast<std::size_t>(k) * kMaxStates;
      for (std::size_t j = 0; j < n; ++j) row[j] -= factor * other[j];
      value -= factor * y[static_cast<std::size_t>(k)];
    }
    const double inverse =
        1.0 / lower[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(i)];
    for (std::size_t j = 0; j < n; ++j) row[j] *= inverse;
    y[static_cast<std::size_t>(i)] = value * inverse;
  }
  x.fill(0.0);
  for (int i = 0; i < m; ++i) {
    const double* row = v.data() + static_cast<std::size_t>(i) * kMaxStates;
    for (std::size_t j = 0; j < static_cast<std::size_t>(estimated_); ++j)
      x[j] += row[j] * y[static_cast<std::size_t>(i)];
  }
  // No measurement leaves less of a variance than its noise is of its innovation's, row by row.
  std::array<double, kMaxStates> least;
  double left = kRoundingLeaves;
  for (int i = 0; i < m; ++i) {
    const double root = lower[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(i)];
    left *= statistics.noise[static_cast<std::size_t>(i)] / (root * root);
  }
  for (int i = 0; i < n_; ++i) least[static_cast<std::size_t>(i)] = left * p_[at(i, i)];
  const bool careful = dwarfs(observation, statistics);
  // Three rows at a time: each element of P is fetched and stored once for them.
  int i = 0;
  for (; i + 3 <= m; i += 3)
    subtract<3>(v.data() + static_cast<std::size_t>(i) * kMaxStates, n_, estimated_, p_.data());
  if (m - i == 2) subtract<2>(v.data() + static_cast<std::size_t>(i) * kMaxStates, n_, estimated_, p_.data());
  if (m - i == 1) subtract<1>(v.data() + static_cast<std::size_t>(i) * kMaxStates, n_, estimated_, p_.data());
  if (careful) {
    // K' = L'^-1 V, in place.
    for (int i = m - 1; i >= 0; --i) {
      double* row = v.data() + static_cast<std::size_t>(i) * kMaxStates;
      for (int k = i + 1; k < m; ++k) {
        const double factor =
            lower[static_cast<std::size_t>(k) * kStatisticsStride + static_cast<std::size_t>(i)];
        const double* other = v.data() + static_cast<std::size_t>(k) * kMaxStates;
        for (std::size_t j = 0; j < n; ++j) row[j] -= factor * other[j];
      }
      const double inverse =
          1.0 / lower[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(i)];
      for (std::size_t j = 0; j < n; ++j) row[j] *= inverse;
      std::fill(row + estimated_, row + n, 0.0);
    }
    settle_rounding(observation, statistics, v.data());
  }
  for (int i = 0; i < n_; ++i) p_[at(i, i)] = std::max(p_[at(i, i)], least[static_cast<std::size_t>(i)]);
  return true;
}

bool ErrorFilter::dwarfs(const Observation& observation, const InnovationStatistics& statistics) const {
  for (int i = 0; i < statistics.rows; ++i) {
    const auto& h = observation.h[static_cast<std::size_t>(i)];
    const double noise = statistics.noise[static_cast<std::size_t>(i)];
    for (int c = 0; c < observation.column_count; ++c) {
      const auto column = observation.columns[static_cast<std::size_t>(c)];
      if (h[column] * h[column] * p_[at(column, column)] * kDwarfed > noise) return true;
    }
  }
  return false;
}

void ErrorFilter::settle_rounding(const Observation& observation, const InnovationStatistics& statistics,
                                  const double* gain) {
  // (KF-3): Q = P H' - K R, which is nothing but rounding; W = Q - K (H Q) / 2; P <- P - W K' - K W'.
  const int m = statistics.rows;
  const auto row_of = [](int i) { return static_cast<std::size_t>(i) * kMaxStates; };
  std::array<double, static_cast<std::size_t>(kRows) * kMaxStates> q{};
  std::array<double, kStatisticsStride * kStatisticsStride> hq{};
  for (int i = 0; i < m; ++i) {
    double* row = q.data() + row_of(i);
    const auto& h = observation.h[static_cast<std::size_t>(i)];
    for (int c = 0; c < observation.column_count; ++c) {
      const auto column = observation.columns[static_cast<std::size_t>(c)];
      for (int j = 0; j < n_; ++j) row[j] += h[column] * p_[at(column, j)];
    }
    for (int j = 0; j < n_; ++j)
      row[j] -= statistics.noise[static_cast<std::size_t>(i)] * gain[row_of(i) + static_cast<std::size_t>(j)];
    std::fill(row + estimated_, row + n_, 0.0);
  }
  for (int i = 0; i < m; ++i) {
    const auto& h = observation.h[static_cast<std::size_t>(i)];
    for (int j = 0; j < m; ++j)
      for (int c = 0; c < observation.column_count; ++c) {
        const auto column = observation.columns[static_cast<std::size_t>(c)];
        hq[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(j)] +=
            h[column] * q[row_of(j) + column];
      }
  }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      const double half =
          0.5 * hq[static_cast<std::size_t>(i) * kStatisticsStride + static_cast<std::size_t>(j)];
      for (std::size_t k = 0; k < static_cast<std::size_t>(n_); ++k)
        q[row_of(j) + k] -= half * gain[row_of(i) + k];
    }
  for (int r = 0; r < n_; ++r)
    for (int c = 0; c <= r; ++c) {
      double change = 0.0;
      for (int i = 0; i < m; ++i) {
        const double* w = q.data() + row_of(i);
        const double* k = gain + row_of(i);
        change += w[r] * k[c] + k[r] * w[c];
      }
      set(r, c, (*this)(r, c) - change);
    }
}

void remove_error(const std::array<double, kMaxStates>& x, int states, FilterState& state) {
  // (KF-4)
  NavSolution& nav = state.nav;
  nav.position = geo::moved_by(nav.position, -Eigen::Vector3d(x[0], x[1], x[2]));
  nav.v_N_m_s -= Eigen::Vector3d(x[3], x[4], x[5]);
  nav.q_NB = geo::normalized(geo::exp(Eigen::Vector3d(0.0, 0.0, x[8])) *
                             geo::exp(Eigen::Vector3d(x[6], x[7], 0.0)) * nav.q_NB);
  for (int i = kNavStates; i < states; ++i)
    state.x[static_cast<std::size_t>(i)] += x[static_cast<std::size_t>(i)];
}

}  // namespace fathom::estimation
