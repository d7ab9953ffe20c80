#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fathom::study {

/// Spread and weights of the sigma points (UKF-1).
struct UkfTuning {
  double alpha = 0.5;
  double beta = 2.0;
  double kappa = 0.0;
};

/// Unscented Kalman filter of N states in a vector space. Fixed size, nothing allocated. Sigma points are
/// the mean and the columns of gamma L about it, P = L L' (lower). A small alpha makes the centre's weight
/// negative: covariances are symmetrised, and where the negative share would leave one indefinite it is left
/// out, which errs on the wide side (UKF-2).
template <int N>
class Ukf {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  static constexpr int kPoints = 2 * N + 1;
  using Points = std::array<Vector, kPoints>;

  /// What a measurement of M components did.
  template <int M>
  struct Update {
    Eigen::Matrix<double, M, 1> predicted;
    Eigen::Matrix<double, M, 1> innovation;  ///< measured - predicted
    Eigen::Matrix<double, M, M> covariance;  ///< of the innovation
    Eigen::Matrix<double, N, M> gain;
    bool used = false;
  };

  explicit Ukf(const UkfTuning& tuning = {}) {
    // (UKF-1)
    const double spread = tuning.alpha * tuning.alpha * (N + tuning.kappa);
    gamma_ = std::sqrt(spread);
    mean_0_ = 1.0 - N / spread;
    covariance_0_ = mean_0_ + 1.0 - tuning.alpha * tuning.alpha + tuning.beta;
    each_ = 0.5 / spread;
  }

  Vector x = Vector::Zero();
  Matrix P = Matrix::Zero();

  /// x <- mean of f over the sigma points, P <- their spread + Q. `f` maps a state to the one after the step.
  template <class F>
  void predict(const F& f, const Matrix& Q) {
    Points points = draw();
    for (Vector& point : points) point = f(point);
    x = mean_0_ * points[0];
    for (int i = 1; i < kPoints; ++i) x += each_ * points[static_cast<std::size_t>(i)];
    Matrix around = Q;
    for (int i = 1; i < kPoints; ++i) {
      const Vector d = points[static_cast<std::size_t>(i)] - x;
      around.template selfadjointView<Eigen::Lower>().rankUpdate(d, each_);
    }
    Matrix whole = around;
    whole.template selfadjointView<Eigen::Lower>().rankUpdate(points[0] - x, covariance_0_);
    const bool good = covariance_0_ >= 0.0 || Eigen::LLT<Matrix>(whole).info() == Eigen::Success;
    P = (good ? whole : around).template selfadjointView<Eigen::Lower>();
  }

  /// `h` maps a state to the measurement; the sigma points are drawn anew from x and P. Above
  /// `squared_distance_limit` the measurement is not used.
  template <int M, class H>
  Update<M> update(const H& h, const Eigen::Matrix<double, M, 1>& measured,
                   const Eigen::Matrix<double, M, M>& R, double squared_distance_limit = HUGE_VAL) {
    Update<M> out;
    const Points points = draw();
    std::array<Eigen::Matrix<double, M, 1>, kPoints> images;
    for (std::size_t i = 0; i < points.size(); ++i) images[i] = h(points[i]);
    out.predicted = mean_0_ * images[0];
    for (std::size_t i = 1; i < images.size(); ++i) out.predicted += each_ * images[i];
    Eigen::Matrix<double, M, M> around = R;
    Eigen::Matrix<double, N, M> cross = Eigen::Matrix<double, N, M>::Zero();
    for (std::size_t i = 1; i < images.size(); ++i) {
      const Eigen::Matrix<double, M, 1> d = images[i] - out.predicted;
      around += each_ * d * d.transpose();
      cross += each_ * (points[i] - x) * d.transpose();
    }
    // The centre point is the mean itself: it adds to the spread of the images, not to the cross terms.
    const Eigen::Matrix<double, M, 1> d0 = images[0] - out.predicted;
    const Eigen::Matrix<double, M, M> whole = around + covariance_0_ * d0 * d0.transpose();
    Eigen::LLT<Eigen::Matrix<double, M, M>> factor(whole);
    out.covariance = whole;
    if (factor.info() != Eigen::Success) {
      out.covariance = around;
      factor.compute(around);
    }
    out.innovation = measured - out.predicted;
    out.gain = factor.solve(cross.transpose()).transpose();
    const double squared = out.innovation.dot(factor.solve(out.innovation));
    if (factor.info() != Eigen::Success || !(squared <= squared_distance_limit)) return out;
    x += out.gain * out.innovation;
    // K S K' = V V' with V = cross L^-T: symmetric by construction.
    const Eigen::Matrix<double, N, M> v = factor.matrixL().solve(cross.transpose()).transpose();
    P -= v * v.transpose();
    P = (0.5 * (P + P.transpose())).eval();
    out.used = true;
    return out;
  }

  /// A linear measurement `H x`: what the sigma points would give, without drawing them.
  template <int M>
  Update<M> update_linear(const Eigen::Matrix<double, M, N>& H, const Eigen::Matrix<double, M, 1>& measured,
                          const Eigen::Matrix<double, M, M>& R) {
    Update<M> out;
    const Eigen::Matrix<double, N, M> cross = P * H.transpose();
    out.predicted = H * x;
    out.covariance = H * cross + R;
    out.innovation = measured - out.predicted;
    const Eigen::LLT<Eigen::Matrix<double, M, M>> factor(out.covariance);
    if (factor.info() != Eigen::Success) return out;
    out.gain = factor.solve(cross.transpose()).transpose();
    x += out.gain * out.innovation;
    const Eigen::Matrix<double, N, M> v = factor.matrixL().solve(cross.transpose()).transpose();
    P -= v * v.transpose();
    P = (0.5 * (P + P.transpose())).eval();
    out.used = true;
    return out;
  }

 private:
  [[nodiscard]] Points draw() const {
    // A variance that rounding has made vanish or worse gets a hair's breadth.
    Matrix p = P;
    Eigen::LLT<Matrix> factor(p);
    for (double share = 1e-14; factor.info() != Eigen::Success && share < 1e9; share *= 100.0) {
      for (int i = 0; i < N; ++i) p(i, i) = std::max(P(i, i), 0.0) * (1.0 + share) + 1e-30;
      factor.compute(p);
    }
    const Matrix l = factor.matrixL();
    Points points;
    points[0] = x;
    for (int i = 0; i < N; ++i) {
      points[static_cast<std::size_t>(1 + i)] = x + gamma_ * l.col(i);
      points[static_cast<std::size_t>(1 + N + i)] = x - gamma_ * l.col(i);
    }
    return points;
  }

  double gamma_ = 0.0;
  double mean_0_ = 0.0;
  double covariance_0_ = 0.0;
  double each_ = 0.0;
};

}  // namespace fathom::study
