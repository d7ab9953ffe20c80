#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimation/aiding/registry.hpp"
#include "estimation/navigator/navigator.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::Normal;

/// The correlation matrix: its eigenvalues say whether the covariance is positive, free of units.
Eigen::MatrixXd correlations(const ErrorFilter& filter) {
  Eigen::MatrixXd p(filter.size(), filter.size());
  for (int i = 0; i < filter.size(); ++i)
    for (int j = 0; j < filter.size(); ++j) p(i, j) = filter(i, j) / std::sqrt(filter(i, i) * filter(j, j));
  return p;
}

TEST(Covariance, StaysSymmetricAndPositive) {
  for (const char* name : {"gps_ins15", "standard", "hybrid25", "full"}) {
    EngineConfig config;
    ASSERT_TRUE(named_state_groups(name, config.groups));
    const estimation::Setup setup(config);
    const StateIndex& index = setup.index;
    Normal normal(11);
    for (int trial = 0; trial < 5; ++trial) {
      ErrorFilter filter(index.size());
      std::array<double, kMaxStates> sigma = setup.initial_sigma;
      for (std::size_t i = 0; i < 9; ++i) sigma[i] = i < 3 ? 10.0 : (i < 6 ? 1.0 : 0.1);
      filter.reset(sigma);
      FilterState state;
      state.nav.position = {0.6, 0.2, -10.0};
      ProcessNoise noise;
      noise.drift = &setup.drift;
      noise.velocity = 1e-7 * Eigen::Matrix3d::Identity();
      noise.attitude = 1e-9 * Eigen::Matrix3d::Identity();
      std::array<double, kMaxStates> x{};
      for (int step = 0; step < 2000; ++step) {
        state.nav.q_NB = geo::from_rpy(normal.vector(1.0));
        state.nav.v_N_m_s = normal.vector(5.0);
        const Eigen::Matrix3d c = geo::to_matrix(state.nav.q_NB);
        const Vector3d force = normal.vector(4.0) - c.transpose() * Vector3d(0.0, 0.0, 9.8);
        filter.propagate(NavTransition(index, state.nav, normal.vector(0.5), force, 0.01), noise);
        if (step % 3 != 0) continue;
        const AidingState aiding(index, state, normal.vector(0.5), 0.0);
        SensorConfig sensor = default_sensor(SourceKind::dvl, "dvl0");
        sensor.lever_B_m = {1.0, 0.5, 0.2};
        sensor.sigma = {1e-4, 1e-4, 1e-4};
        sensor.use_sample_sigma = false;
        sensor.proportional_sigma = 0.0;
        EventSample sample;
        const int kind = (step / 3) % 4;
        if (kind == 0) {
          DvlSample dvl;
          dvl.velocity_D_m_s = {1.0, 0.0, 0.0};
          sample = dvl;
        } else if (kind == 1) {
          GpsSample gps;
          gps.fix = GpsFix::rtk_fixed;
          gps.latitude_rad = 0.6;
          gps.longitude_rad = 0.2;
          gps.altitude_m = -10.0;
          sample = gps;
        } else if (kind == 2) {
          DepthSample depth;
          depth.depth_m = 10.0;
          sample = depth;
        } else {
          HeadingSample heading;
          heading.heading_rad = 1.0;
          sample = heading;
        }
        const SourceKind sources[] = {SourceKind::dvl, SourceKind::gps, SourceKind::depth,
                                      SourceKind::heading};
        Observation observation;
        for (const AidingEntry& entry : aiding_registry())
          if (entry.source == sources[kind]) (void)entry.observe({aiding, sensor, 0.0}, sample, observation);
        if (observation.rows == 0) continue;
        observation.list_columns(index.size());
        InnovationStatistics statistics;
        filter.statistics(observation, 1.0, statistics);
        ASSERT_TRUE(filter.update(observation, statistics, x));
      }
      for (int i = 0; i < index.size(); ++i)
        for (int j = 0; j < i; ++j) ASSERT_EQ(filter(i, j), filter(j, i)) << name;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlations(filter));
      EXPECT_GT(solver.eigenvalues().minCoeff(), 0.0) << name;
    }
  }
}

/// A random situation: everything that one step of the covariance depends on.
struct Situation {
  explicit Situation(Normal& normal) {
    nav.position = {normal.uniform(-1.2, 1.2), normal.uniform(-3.0, 3.0), 200.0};
    nav.v_N_m_s = normal.vector(20.0);
    nav.q_NB = geo::from_rpy(normal.vector(1.0));
    force_B = normal.vector(10.0);
    rate_B = normal.vector(1.0);
  }
  NavSolution nav;
  Vector3d force_B;
  Vector3d rate_B;
};

TEST(Covariance, PropagationEqualsTheDenseProduct) {
  // With every subset of the inertial groups: scale and misalignment stand in different rows each time.
  for (int groups = 0; groups < 16; ++groups) {
    EngineConfig config;
    ASSERT_TRUE(named_state_groups("full", config.groups));
    config.groups.accel_scale = (groups & 1) != 0;
    config.groups.gyro_scale = (groups & 2) != 0;
    config.groups.accel_misalignment = (groups & 4) != 0;
    config.groups.gyro_misalignment = (groups & 8) != 0;
    config.states.heading_bias_time_constant_s = 5.0;
    const estimation::Setup setup(config);
    const int n = setup.index.size();
    Normal normal(static_cast<std::uint64_t>(3 + groups));
    Eigen::MatrixXd root(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) root(i, j) = normal();
    const Eigen::MatrixXd p0 = root * root.transpose();
    ErrorFilter filter(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) filter.set(i, j, p0(i, j));
    const Situation at(normal);
    ProcessNoise noise;
    noise.drift = &setup.drift;
    noise.velocity = Vector3d(0.1, 0.2, 0.3).asDiagonal();
    noise.attitude = Vector3d(0.3, 0.1, 0.2).asDiagonal();
    constexpr double dt = 0.02;
    const NavTransition transition(setup.index, at.nav, at.rate_B, at.force_B, dt);
    filter.propagate(transition, noise);

    Eigen::MatrixXd phi = Eigen::MatrixXd::Identity(n, n);
    phi.topRows<9>() = transition.rows(n);
    for (int i = 9; i < n; ++i) phi(i, i) = std::exp(-dt * setup.decay_per_s[static_cast<std::size_t>(i)]);
    Eigen::MatrixXd expected = phi * p0 * phi.transpose();
    for (int i = 9; i < n; ++i) expected(i, i) += dt * setup.walk[static_cast<std::size_t>(i)];
    expected.block<3, 3>(0, 0) += dt * dt * dt / 3.0 * noise.velocity;
    expected.block<3, 3>(3, 0) += dt * dt / 2.0 * noise.velocity;
    expected.block<3, 3>(0, 3) += dt * dt / 2.0 * noise.velocity;
    expected.block<3, 3>(3, 3) += dt * noise.velocity;
    expected.block<3, 3>(6, 6) += dt * noise.attitude;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        ASSERT_EQ(filter(i, j), filter(j, i));
        ASSERT_NEAR(filter(i, j), expected(i, j), 1e-13 * p0.cwiseAbs().maxCoeff()) << i << ' ' << j;
      }
  }
}

TEST(Covariance, TransitionEqualsTheSecondOrderExponentialOfF) {
  EngineConfig config;
  ASSERT_TRUE(named_state_groups("full", config.groups));
  const StateIndex index(config.groups);
  const int n = index.imu_end();
  Normal normal(8);
  for (int trial = 0; trial < 200; ++trial) {
    const Situation at(normal);
    const double dt = trial % 2 == 0 ? 0.01 : 0.25;
    const NavTransition transition(index, at.nav, at.rate_B, at.force_B, dt);
    const Eigen::Matrix3d c = geo::to_matrix(at.nav.q_NB);
    Eigen::MatrixXd f = Eigen::MatrixXd::Zero(n, n);
    f.topLeftCorner(9, 9) = error_dynamics(at.nav, c * at.force_B);
    f.topRightCorner(9, n - 9) = imu_error_columns(index, c, at.rate_B, at.force_B);
    const Eigen::MatrixXd second = 0.5 * dt * dt * f * f;
    const Eigen::MatrixXd expected = (Eigen::MatrixXd::Identity(n, n) + dt * f + second).topRows(9);
    const Eigen::MatrixXd own = transition.rows(n);
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < n; ++j)
        ASSERT_NEAR(own(i, j), expected(i, j), 1e-12 * std::max(std::abs(expected(i, j)), 1e-6))
            << i << ' ' << j << " trial " << trial;
  }
}

}  // namespace
}  // namespace fathom::estimation
