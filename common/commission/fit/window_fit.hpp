#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "commission/fit/rest.hpp"
#include "commission/fit/series.hpp"

namespace fathom::commission {

/// Spans of `length_s` one behind the other where the series speaks at least `least` times, those in which
/// the vehicle turned and accelerated most; at most `most` of them, in the order of time.
[[nodiscard]] std::vector<Span> windows_of(const Series& series, const VectorSeries& velocity,
                                           double length_s, std::size_t least, std::size_t most);

/// Pairs of rows of a velocity within a span, at least `apart_s` and at most `gap_s` apart.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> pairs_in(const VectorSeries& velocity,
                                                                        const Span& span, double apart_s,
                                                                        double gap_s);

/// Rows of a velocity within a span, at least `apart_s` apart.
[[nodiscard]] std::vector<std::size_t> rows_in(const VectorSeries& velocity, const Span& span,
                                               double apart_s);

/// Least squares over windows: common unknowns, and some of each window that are eliminated at once. Its
/// covariance is that of the scatter between windows (jackknife), so that what is correlated inside a window
/// counts once.
class WindowFit {
 public:
  explicit WindowFit(int common)
      : common_(common),
        normal_(Eigen::MatrixXd::Zero(common, common)),
        right_(Eigen::VectorXd::Zero(common)) {}
  /// One window: residuals r and their derivatives by the common unknowns and by the window's own.
  void add(const Eigen::MatrixXd& J, const Eigen::MatrixXd& Jw, const Eigen::VectorXd& r);
  /// What is known of an unknown before: its present offset from that and its sigma, in units of the
  /// residual's.
  void prior(int index, double offset, double sigma, double residual_sigma);
  /// The three unknowns from `index` on do not move along a direction by more than a sigma.
  void hold(int index, const Eigen::Vector3d& along, double sigma, double residual_sigma);
  struct Solution {
    Eigen::VectorXd step;  ///< subtract r = r0 + J step
    Eigen::MatrixXd covariance;
    double squares = 0.0;  ///< of the residuals behind the step
    double freedom = 0.0;
    std::size_t windows = 0;
  };
  [[nodiscard]] Solution solve() const;

 private:
  struct Part {
    Eigen::MatrixXd N;
    Eigen::VectorXd b;
  };
  int common_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_;
  std::vector<Part> parts_;
  double squares_ = 0.0;
  double rows_ = 0.0;
};

}  // namespace fathom::commission
