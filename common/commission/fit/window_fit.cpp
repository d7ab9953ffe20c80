#include "commission/fit/window_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

namespace fathom::commission {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<Span> windows_of(const Series& series, const VectorSeries& velocity, double length_s,
                             std::size_t least, std::size_t most) {
  struct Scored {
    Span span;
    double score;
  };
  std::vector<Scored> all;
  const ImuSeries& imu = series.imu;
  if (velocity.size() == 0 || imu.size() == 0) return {};
  std::size_t i = 0;
  std::size_t j = 0;
  const double end_s = std::min(imu.t_s.back(), velocity.t_s.back());
  for (double from = std::max(imu.t_s.front() + 2.0, velocity.t_s.front()); from + length_s < end_s - 1.0;
       from += length_s) {
    const double to = from + length_s;
    std::size_t heard = 0;
    Vector3d low = Vector3d::Constant(1e9);
    Vector3d high = Vector3d::Constant(-1e9);
    while (j < velocity.size() && velocity.t_s[j] < from) ++j;
    for (; j < velocity.size() && velocity.t_s[j] <= to; ++j, ++heard) {
      low = low.cwiseMin(velocity.v[j]);
      high = high.cwiseMax(velocity.v[j]);
    }
    while (i < imu.size() && imu.t_s[i] < from) ++i;
    double turn2 = 0.0;
    double n = 0.0;
    for (; i < imu.size() && imu.t_s[i] <= to; ++i, n += 1.0) turn2 += imu.rate[i].squaredNorm();
    if (heard < least || n < 10.0) continue;
    all.push_back({{from, to}, (high - low).norm() * std::sqrt(turn2 / n)});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Scored& a, const Scored& b) { return a.score > b.score; });
  if (all.size() > most) all.resize(most);
  std::stable_sort(all.begin(), all.end(),
                   [](const Scored& a, const Scored& b) { return a.span.from_s < b.span.from_s; });
  std::vector<Span> out;
  for (const Scored& each : all) out.push_back(each.span);
  return out;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_in(const VectorSeries& velocity, const Span& span,
                                                          double apart_s, double gap_s) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  auto i = static_cast<std::size_t>(std::lower_bound(velocity.t_s.begin(), velocity.t_s.end(), span.from_s) -
                                    velocity.t_s.begin());
  std::size_t from = i;
  for (++i; i < velocity.size() && velocity.t_s[i] <= span.to_s; ++i) {
    const double apart = velocity.t_s[i] - velocity.t_s[from];
    if (apart < apart_s - 1e-3) continue;
    if (apart <= gap_s) out.emplace_back(from, i);
    from = i;
  }
  return out;
}

std::vector<std::size_t> rows_in(const VectorSeries& velocity, const Span& span, double apart_s) {
  std::vector<std::size_t> out;
  auto i = static_cast<std::size_t>(std::lower_bound(velocity.t_s.begin(), velocity.t_s.end(), span.from_s) -
                                    velocity.t_s.begin());
  for (; i < velocity.size() && velocity.t_s[i] <= span.to_s; ++i)
    if (out.empty() || velocity.t_s[i] - velocity.t_s[out.back()] >= apart_s - 1e-3) out.push_back(i);
  return out;
}

void WindowFit::add(const MatrixXd& J, const MatrixXd& Jw, const VectorXd& r) {
  const MatrixXd own = Jw.transpose() * Jw + 1e-9 * MatrixXd::Identity(Jw.cols(), Jw.cols());
  const Eigen::LDLT<MatrixXd> factor(own);
  const MatrixXd cross = Jw.transpose() * J;
  const VectorXd own_right = Jw.transpose() * r;
  Part part;
  part.N = J.transpose() * J - cross.transpose() * factor.solve(cross);
  part.b = J.transpose() * r - cross.transpose() * factor.solve(own_right);
  normal_ += part.N;
  right_ += part.b;
  squares_ += r.squaredNorm() - own_right.dot(factor.solve(own_right));
  rows_ += static_cast<double>(r.size() - Jw.cols());
  parts_.push_back(std::move(part));
}

void WindowFit::prior(int index, double offset, double sigma, double residual_sigma) {
  const double weight = residual_sigma * residual_sigma / (sigma * sigma);
  normal_(index, index) += weight;
  right_(index) += weight * offset;
}

void WindowFit::hold(int index, const Eigen::Vector3d& along, double sigma, double residual_sigma) {
  const double weight = residual_sigma * residual_sigma / (sigma * sigma);
  normal_.block<3, 3>(index, index) += weight * along * along.transpose();
}

WindowFit::Solution WindowFit::solve() const {
  Solution out;
  out.windows = parts_.size();
  const Eigen::LDLT<MatrixXd> factor(normal_ + 1e-12 * MatrixXd::Identity(common_, common_));
  out.step = -factor.solve(right_);
  out.squares = squares_ + out.step.dot(right_);
  out.freedom = std::max(1.0, rows_ - common_);
  const MatrixXd inverse = factor.solve(MatrixXd::Identity(common_, common_));
  // Leaving out one window after the other (jackknife): few windows make it larger, never smaller.
  VectorXd mean = VectorXd::Zero(common_);
  std::vector<VectorXd> without;
  for (const Part& part : parts_) {
    const MatrixXd N = normal_ - part.N + 1e-12 * MatrixXd::Identity(common_, common_);
    without.push_back(-N.ldlt().solve(right_ - part.b));
    mean += without.back();
  }
  const auto count = static_cast<double>(std::max<std::size_t>(parts_.size(), 1));
  mean /= count;
  MatrixXd jackknife = MatrixXd::Zero(common_, common_);
  for (const VectorXd& step : without) jackknife += (step - mean) * (step - mean).transpose();
  jackknife *= (count - 1.0) / count;
  // Never less than white noise would leave.
  const MatrixXd white = out.squares / out.freedom * inverse;
  out.covariance = white;
  for (int i = 0; i < common_; ++i) {
    const double ratio = jackknife(i, i) / std::max(white(i, i), 1e-300);
    if (ratio <= 1.0) continue;
    const double stretch = std::sqrt(ratio);
    out.covariance.row(i) *= stretch;
    out.covariance.col(i) *= stretch;
  }
  return out;
}

}  // namespace fathom::commission
