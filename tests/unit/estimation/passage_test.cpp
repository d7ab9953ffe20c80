// What is remembered of a filter going forward: equal to the way back over the same steps.

#include "estimation/filter/passage.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimation/smoothing/filter_log.hpp"
#include "geo/so3.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::estimation {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::Normal;

constexpr int kStates = 17;

/// Tells two.
class Both final : public FilterTape {
 public:
  Both(FilterTape& a, FilterTape& b) : a_(a), b_(b) {}
  void propagated(const NavTransition& step, const ProcessNoise& noise) override {
    a_.propagated(step, noise);
    b_.propagated(step, noise);
  }
  void updated(const Observation& observation, const InnovationStatistics& statistics) override {
    a_.updated(observation, statistics);
    b_.updated(observation, statistics);
  }
  void forgot(int state) override {
    a_.forgot(state);
    b_.forgot(state);
  }
  void drifted(const ErrorFilter& widened, const std::array<double, kNavStates>& variance) override {
    a_.drifted(widened, variance);
    b_.drifted(widened, variance);
  }
  void shifted(const ErrorFilter& filter, const std::array<double, kMaxStates>& column, double mean,
               double variance) override {
    a_.shifted(filter, column, mean, variance);
    b_.shifted(filter, column, mean, variance);
  }
  void carried(const Carry& carry) override {
    a_.carried(carry);
    b_.carried(carry);
  }
  void restarted() override {
    a_.restarted();
    b_.restarted();
  }

 private:
  FilterTape& a_;
  FilterTape& b_;
};

/// What happens half way.
enum class Event : std::uint8_t { none, room, shift };

struct Course {
  explicit Course(std::uint64_t seed, Event event) : log(kStates), passage(kStates), both(log, passage) {
    Normal normal(seed);
    std::array<double, kMaxStates> sigma{};
    for (std::size_t i = 0; i < kStates; ++i) sigma[i] = i < 3 ? 5.0 : i < 6 ? 1.0 : i < 15 ? 0.01 : 0.5;
    ErrorFilter filter(kStates);
    filter.reset(sigma);
    move(filter, normal, 3, Event::none);  // so that everything shares something
    first = filter;
    filter.record_to(&both);
    move(filter, normal, 12, event);
    last = filter;
    last.record_to(nullptr);
  }

  void move(ErrorFilter& filter, Normal& normal, int steps, Event event) {
    const StateIndex index{StateGroups{}};
    NavSolution nav;
    nav.position = {0.6, 0.2, 10.0};
    nav.v_N_m_s = {1.0, 0.5, 0.0};
    nav.q_NB = geo::from_rpy({0.1, -0.05, 0.8});
    const Vector3d force_B(0.5, 0.1, -9.7);
    const NavTransition step(index, nav, Vector3d(0.1, 0.0, 0.2), force_B, 1.0);
    std::array<double, kMaxStates> walk{};
    std::array<double, kMaxStates> decay_per_s{};
    walk[15] = 0.02;
    decay_per_s[15] = 0.1;
    const StateDrift drift(walk, decay_per_s, kStates);
    ProcessNoise noise;
    noise.velocity = 0.04 * Eigen::Matrix3d::Identity();
    noise.attitude = 1e-6 * Eigen::Matrix3d::Identity();
    noise.drift = &drift;
    for (int k = 0; k < steps; ++k) {
      filter.propagate(step, noise);
      Observation observation;
      observation.rows = 1 + k % 3;
      for (std::size_t i = 0; i < static_cast<std::size_t>(observation.rows); ++i) {
        observation.h[i][3 + i] = 1.0;
        observation.h[i][6 + (i + 1) % 3] = 1.5;
        observation.h[i][15 + i % 2] = 0.3;
        observation.sigma[i] = 0.3;
        observation.innovation[i] = normal(0.8);
      }
      observation.list_columns(kStates);
      InnovationStatistics statistics;
      filter.statistics(observation, 1.0, statistics);
      std::array<double, kMaxStates> x{};
      ASSERT_TRUE(filter.update(observation, statistics, x));
      Carry carry;
      carry.turn = geo::to_matrix(geo::exp(Vector3d(0.0, 0.0, normal(0.02))));
      carry.velocity_by_attitude = geo::skew(normal.vector(0.01));
      carry.bias_own = geo::to_matrix(geo::exp(normal.vector(0.01)));
      filter.carry(carry);
      if (k == 4) filter.forget(16, 0.4);
      if (k == 6 && event == Event::room) {
        std::array<double, kNavStates> variance{};
        variance[0] = 30.0;
        variance[1] = 20.0;
        variance[4] = 0.5;
        filter.widen_drifted(variance);
      }
      if (k == 6 && event == Event::shift) {
        std::array<double, kMaxStates> column{};
        for (std::size_t i = 0; i < kStates; ++i)
          column[i] = normal(std::sqrt(filter(static_cast<int>(i), static_cast<int>(i))));
        filter.shift(column, 5.0, 1.5);
      }
    }
  }

  FilterLog log;
  Passage passage;
  Both both;
  ErrorFilter first{kStates};
  ErrorFilter last{kStates};
};

class PassageTest : public ::testing::TestWithParam<Event> {};

TEST_P(PassageTest, SaysOfTheErrorAtItsBeginWhatTheWayBackSays) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Course course(seed, GetParam());
    Adjoint adjoint(kStates);
    course.log.back_through(course.log.size(), 0, adjoint);
    std::array<double, kMaxStates> x{};
    adjoint.smoothed_error(course.first, x);
    ErrorFilter smoothed = course.first;
    const std::array<int, 4> states{0, 1, 7, 15};
    adjoint.smooth_covariance(states, smoothed);

    Passage::Columns columns(kStates, 4);
    Passage::Square sums(4, 4);
    Passage::Vector mean = Passage::Vector::Zero(4);
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < kStates; ++i) columns(i, j) = course.first(i, states[static_cast<std::size_t>(j)]);
      for (int i = 0; i < 4; ++i)
        sums(i, j) = course.first(states[static_cast<std::size_t>(i)], states[static_cast<std::size_t>(j)]);
    }
    course.passage.carry_along(columns, sums, mean);
    for (int j = 0; j < 4; ++j) {
      const int state = states[static_cast<std::size_t>(j)];
      const double sigma = std::sqrt(course.first(state, state));
      EXPECT_NEAR(mean(j), x[static_cast<std::size_t>(state)], 1e-9 * sigma);
      for (int i = 0; i <= j; ++i) {
        const int other = states[static_cast<std::size_t>(i)];
        EXPECT_NEAR(sums(i, j), smoothed(other, state), 1e-9 * sigma * std::sqrt(course.first(other, other)));
      }
    }
  }
}

TEST(Passage, LeavesOfThePresentCovarianceWhatIsNewSince) {
  const Course course(7, Event::none);
  // The closed-loop transition as unit columns show it, and with it P of now from P of then.
  Passage::Columns unit = Passage::Columns::Identity(kStates, kStates);
  Passage::Square sums = Passage::Square::Zero(kStates, kStates);
  Passage::Vector mean = Passage::Vector::Zero(kStates);
  course.passage.carry_along(unit, sums, mean);
  MatrixXd then(kStates, kStates);
  MatrixXd now(kStates, kStates);
  for (int i = 0; i < kStates; ++i)
    for (int j = 0; j < kStates; ++j) {
      then(i, j) = course.first(i, j);
      now(i, j) = course.last(i, j);
    }
  // What is new since is a covariance: now - A then A' has no negative direction.
  const MatrixXd fresh = now - unit * then * unit.transpose();
  const VectorXd scale = now.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * fresh * scale.asDiagonal());
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-9);
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithRoomOrShift, PassageTest,
                         ::testing::Values(Event::none, Event::room, Event::shift));

TEST(Passage, BehindANewStartNothingFollowsFromBefore) {
  Passage passage(kStates);
  EXPECT_FALSE(passage.is_cut());
  passage.restarted();
  EXPECT_TRUE(passage.is_cut());
  passage.begin();
  EXPECT_FALSE(passage.is_cut());
}

}  // namespace
}  // namespace fathom::estimation
