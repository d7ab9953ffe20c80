// The way back over a filter: equality with the solution of all equations at once.
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "estimation/smoothing/filter_log.hpp"
#include "geo/so3.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::estimation {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A filter with all kinds of states on a fixed course, next to the joint distribution of its errors at all
/// instants, from which the conditional means come by solving for all at once.
class BatchTest : public ::testing::Test {
 protected:
  static constexpr int kStates = 17;  // 15 of the inertial navigator, a decaying one, a constant
  static constexpr int kSteps = 24;

  BatchTest() {
    const Vector3d force_N(0.4, -0.3, -9.8);
    const Vector3d rate_B(0.1, 0.0, 0.2);
    const Vector3d force_B(0.5, 0.1, -9.7);
    const Eigen::Matrix3d c = geo::to_matrix(nav().q_NB);
    const StateIndex index{StateGroups{}};
    const Matrix9 f = error_dynamics(nav(), force_N);
    const ImuColumns g = imu_error_columns(index, c, rate_B, force_B);
    const ErrorRates rates = error_rates(geo::LocalEarth(nav().position), nav().v_N_m_s, force_N);
    const NavTransition step(index, rates, c, rate_B, force_B, 1.0);
    std::array<double, kMaxStates> walk{};
    std::array<double, kMaxStates> decay_per_s{};
    for (std::size_t i = 9; i < 15; ++i) walk[i] = 1e-8;
    walk[15] = 0.02;
    decay_per_s[15] = 0.1;
    const StateDrift drift(walk, decay_per_s, kStates);
    ProcessNoise noise;
    noise.velocity = 0.04 * Eigen::Matrix3d::Identity();
    noise.attitude = 1e-6 * Eigen::Matrix3d::Identity();
    noise.drift = &drift;
    std::array<double, kMaxStates> sigma{};
    for (std::size_t i = 0; i < kStates; ++i) sigma[i] = i < 3 ? 5.0 : i < 6 ? 1.0 : i < 15 ? 0.01 : 0.5;

    ErrorFilter filter(kStates);
    ErrorFilter prior(kStates);  // never measures
    filter.reset(sigma);
    prior.reset(sigma);
    filter.record_to(&log_);
    joint_ = MatrixXd::Zero(kStates * (kSteps + 1), kStates * (kSteps + 1));
    VectorXd mean = VectorXd::Zero(kStates);
    MatrixXd transition = MatrixXd::Identity(kStates, kStates);
    place(0, prior, transition);
    for (int k = 0; k < kSteps; ++k) {
      measure(k, filter, mean);
      filters_.push_back(filter);
      means_.push_back(mean);
      ends_.push_back(log_.size());
      const auto move = [&](ErrorFilter& one) {
        one.propagate(step, noise);
        if (k == 9) one.widen(3, 0.7);
        if (k == 15) one.forget(1, 20.0);
      };
      move(filter);
      move(prior);
      // The transition as the covariance shows it: that of unit vectors.
      transition = transition_of(f, g, noise);
      if (k == 15) transition.row(1).setZero();
      mean = (transition * mean).eval();
      place(k + 1, prior, transition);
    }
    filters_.push_back(filter);
    means_.push_back(mean);
    ends_.push_back(log_.size());
  }

  static NavSolution nav() {
    NavSolution out;
    out.position = {0.6, 0.2, 10.0};
    out.v_N_m_s = {20.0, -10.0, 1.0};
    out.q_NB = geo::from_rpy({0.1, -0.2, 1.2});
    return out;
  }
  static MatrixXd transition_of(const Matrix9& f, const ImuColumns& g, const ProcessNoise& noise) {
    MatrixXd rate = MatrixXd::Zero(kStates, kStates);
    rate.topLeftCorner(9, 9) = f;
    rate.block(0, 9, 9, 6) = g;
    MatrixXd phi = MatrixXd::Identity(kStates, kStates) + rate + 0.5 * rate * rate;
    for (int i = 9; i < kStates; ++i) phi(i, i) = std::exp(-noise.drift->decay_per_s(i) * 1.0);
    return phi;
  }
  /// Enters instant k: its own covariance, and that with all instants before.
  void place(int k, const ErrorFilter& prior, const MatrixXd& transition) {
    for (int i = 0; i < kStates; ++i)
      for (int j = 0; j < kStates; ++j) joint_(k * kStates + i, k * kStates + j) = prior(i, j);
    if (k == 0) return;
    joint_.block(k * kStates, 0, kStates, k * kStates) =
        transition * joint_.block((k - 1) * kStates, 0, kStates, k * kStates);
    joint_.block(0, k * kStates, k * kStates, kStates) =
        joint_.block(k * kStates, 0, kStates, k * kStates).transpose();
  }
  void measure(int k, ErrorFilter& filter, VectorXd& mean) {
    Observation observation;
    if (k % 3 == 1) {
      observation.rows = 2;
      observation.h[0][0] = observation.h[1][1] = 1.0;
      observation.h[0][15] = -1.0;
      observation.sigma = {2.0, 3.0};
    } else if (k % 2 == 0) {
      observation.rows = 1;
      observation.h[0][3] = 0.8;
      observation.h[0][4] = -0.6;
      observation.h[0][8] = 1.5;
      observation.h[0][16] = 1.0;
      observation.sigma = {0.1};
    } else {
      return;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(observation.rows); ++i) {
      VectorXd row = VectorXd::Zero(joint_.rows());
      double expected = 0.0;
      for (int s = 0; s < kStates; ++s) {
        row(k * kStates + s) = observation.h[i][static_cast<std::size_t>(s)];
        expected += row(k * kStates + s) * mean(s);
      }
      const double value = normal_(3.0);
      rows_.push_back(row);
      values_.push_back(value);
      variances_.push_back(observation.sigma[i] * observation.sigma[i]);
      // The estimate in use already has what was found before taken off.
      observation.innovation[i] = value - expected;
    }
    observation.list_columns(kStates);
    InnovationStatistics statistics;
    filter.statistics(observation, 1.0, statistics);
    std::array<double, kMaxStates> x{};
    ASSERT_TRUE(filter.update(observation, statistics, x));
    for (int s = 0; s < kStates; ++s) mean(s) += x[static_cast<std::size_t>(s)];
  }

  test::Normal normal_{7};
  FilterLog log_{kStates};
  std::vector<std::size_t> ends_;
  std::vector<ErrorFilter> filters_;
  std::vector<VectorXd> means_;
  MatrixXd joint_;
  std::vector<VectorXd> rows_;
  std::vector<double> values_;
  std::vector<double> variances_;
};

TEST_F(BatchTest, IsTheSolutionOfAllEquationsAtOnce) {
  const auto count = static_cast<Eigen::Index>(rows_.size());
  MatrixXd h(count, joint_.rows());
  VectorXd z(count);
  VectorXd r(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    h.row(i) = rows_[static_cast<std::size_t>(i)].transpose();
    z(i) = values_[static_cast<std::size_t>(i)];
    r(i) = variances_[static_cast<std::size_t>(i)];
  }
  const MatrixXd hp = h * joint_;
  const MatrixXd s = hp * h.transpose() + MatrixXd(r.asDiagonal());
  const Eigen::LDLT<MatrixXd> factor(s);
  const VectorXd mean = hp.transpose() * factor.solve(z);
  const MatrixXd covariance = joint_ - hp.transpose() * factor.solve(hp);

  std::array<int, kStates> states{};
  std::iota(states.begin(), states.end(), 0);
  Adjoint adjoint(kStates);
  std::size_t done = log_.size();
  double most = 0.0;
  for (int k = kSteps; k >= 0; --k) {
    const auto at = static_cast<std::size_t>(k);
    log_.back_through(done, ends_[at], adjoint);
    done = ends_[at];
    std::array<double, kMaxStates> x{};
    adjoint.smoothed_error(filters_[at], x);
    ErrorFilter smoothed = filters_[at];
    adjoint.smooth_covariance(states, smoothed);
    for (int i = 0; i < kStates; ++i) {
      const double sigma = std::sqrt(covariance(k * kStates + i, k * kStates + i));
      EXPECT_NEAR(means_[at](i) + x[static_cast<std::size_t>(i)], mean(k * kStates + i), 1e-8 * sigma)
          << "state " << i << " at " << k;
      EXPECT_NEAR(smoothed(i, i) / (sigma * sigma), 1.0, 1e-8) << "state " << i << " at " << k;
      most = std::max(most, std::abs(x[static_cast<std::size_t>(i)]) / sigma);
      for (int j = 0; j < i; ++j) {
        const double other = std::sqrt(covariance(k * kStates + j, k * kStates + j));
        EXPECT_NEAR(smoothed(i, j) / (sigma * other),
                    covariance(k * kStates + i, k * kStates + j) / (sigma * other), 1e-8);
      }
    }
  }
  // Not by doing nothing.
  EXPECT_GT(most, 1.0);
}

// A covariance that is written anew about a corrected estimate (KF-5), and the way back over it.
TEST(SmoothingCarry, IsThatOfTheDenseProductAndItsWayBackToo) {
  test::Normal normal(5);
  constexpr int kSize = 16;
  MatrixXd root(kSize, kSize);
  for (int i = 0; i < kSize; ++i)
    for (int j = 0; j < kSize; ++j) root(i, j) = normal();
  const MatrixXd p = root * root.transpose();
  ErrorFilter filter(kSize);
  for (int i = 0; i < kSize; ++i)
    for (int j = 0; j <= i; ++j) filter.set(i, j, p(i, j));
  const ErrorFilter before = filter;
  FilterLog log(kSize);
  filter.record_to(&log);
  Carry carry;
  carry.turn = geo::to_matrix(geo::exp(Vector3d(0.0, 0.0, 0.3)));
  carry.velocity_by_attitude = geo::skew(Vector3d(2.0, -1.0, 0.5));
  carry.bias_own = geo::to_matrix(geo::exp(Vector3d(0.1, -0.2, 0.05)));
  filter.carry(carry);

  MatrixXd t = MatrixXd::Identity(kSize, kSize);
  t.block<Carry::kStates, Carry::kStates>(Carry::kFirst, Carry::kFirst) = carry.matrix();
  const MatrixXd expected = t * p * t.transpose();
  for (int i = 0; i < kSize; ++i)
    for (int j = 0; j < kSize; ++j) {
      EXPECT_NEAR(filter(i, j), expected(i, j), 1e-12 * expected.norm()) << i << j;
      EXPECT_EQ(filter(i, j), filter(j, i));
    }

  // A gradient of the future says of the past what it says of T times it.
  VectorXd gradient(kSize);
  for (int i = 0; i < kSize; ++i) gradient(i) = normal();
  Adjoint adjoint(gradient, MatrixXd::Zero(kSize, kSize));
  log.back_through(log.size(), 0, adjoint);
  std::array<double, kMaxStates> x{};
  adjoint.smoothed_error(before, x);
  const VectorXd told = -p * t.transpose() * gradient;
  for (int i = 0; i < kSize; ++i)
    EXPECT_NEAR(x[static_cast<std::size_t>(i)], told(i), 1e-12 * told.norm()) << i;
}

}  // namespace
}  // namespace fathom::estimation
