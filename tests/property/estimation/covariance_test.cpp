#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimation/aiding/registry.hpp"
#include "estimation/core.hpp"
#include "support/analytic_vehicle.hpp"

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
      noise.walk = setup.walk;
      noise.decay_per_s = setup.decay_per_s;
      noise.velocity = 1e-7 * Eigen::Matrix3d::Identity();
      noise.attitude = 1e-9 * Eigen::Matrix3d::Identity();
      std::array<double, kMaxStates> x{};
      for (int step = 0; step < 2000; ++step) {
        state.nav.q_NB = geo::from_rpy(normal.vector(1.0));
        state.nav.v_N_m_s = normal.vector(5.0);
        const Eigen::Matrix3d c = geo::to_matrix(state.nav.q_NB);
        const Vector3d force = normal.vector(4.0) - c.transpose() * Vector3d(0.0, 0.0, 9.8);
        filter.propagate(error_dynamics(state.nav, c * force),
                         imu_error_columns(index, c, normal.vector(0.5), force), 0.01, noise);
        if (step % 3 != 0) continue;
        const AidingState aiding(index, state, normal.vector(0.5), 0.0);
        SensorConfig sensor = default_sensor(SourceKind::dvl, "dvl0");
        sensor.lever_B_m = {1.0, 0.5, 0.2};
        sensor.sigma = {1e-4, 1e-4, 1e-4};
        sensor.use_sample_sigma = false;
        sensor.proportional_sigma = 0.0;
        AnySample sample;
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
      EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-7) << name;
    }
  }
}

TEST(Covariance, PropagationEqualsTheDenseProduct) {
  EngineConfig config;
  ASSERT_TRUE(named_state_groups("full", config.groups));
  const estimation::Setup setup(config);
  const StateIndex& index = setup.index;
  const int n = index.size();
  Normal normal(3);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd root(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) root(i, j) = normal();
    const Eigen::MatrixXd p0 = root * root.transpose();
    ErrorFilter filter(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) filter.set(i, j, p0(i, j));
    NavSolution nav;
    nav.position = {0.5, 1.0, 200.0};
    nav.v_N_m_s = normal.vector(20.0);
    nav.q_NB = geo::from_rpy(normal.vector(1.0));
    const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
    const Vector3d force = normal.vector(10.0);
    const Matrix9 f = error_dynamics(nav, c * force);
    const ImuColumns g = imu_error_columns(index, c, normal.vector(1.0), force);
    ProcessNoise noise;
    noise.walk = setup.walk;
    noise.decay_per_s = setup.decay_per_s;
    constexpr double dt = 0.02;
    filter.propagate(f, g, dt, noise);

    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    full.topLeftCorner(9, 9) = f;
    full.block(0, 9, 9, g.cols()) = g;
    Eigen::MatrixXd phi = Eigen::MatrixXd::Identity(n, n) + dt * full + 0.5 * dt * dt * full * full;
    for (int i = 9; i < n; ++i) phi(i, i) = std::exp(-dt * setup.decay_per_s[static_cast<std::size_t>(i)]);
    Eigen::MatrixXd expected = phi * p0 * phi.transpose();
    for (int i = 9; i < n; ++i) expected(i, i) += dt * setup.walk[static_cast<std::size_t>(i)];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        ASSERT_NEAR(filter(i, j), expected(i, j), 1e-11 * p0.cwiseAbs().maxCoeff()) << i << ' ' << j;
  }
}

}  // namespace
}  // namespace fathom::estimation
