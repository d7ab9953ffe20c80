// States that are considered (KF-6): in the covariance as if they were estimated, but never found.
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "estimation/filter/error_filter.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::estimation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

StateGroups of_the_inertial_unit() {
  StateGroups groups;
  groups.accel_scale = groups.gyro_scale = true;
  groups.accel_misalignment = groups.gyro_misalignment = true;
  return groups;
}

TEST(Considered, StandsBehindWhatIsEstimated) {
  StateGroups estimated;
  estimated.current = true;
  const StateIndex index(estimated, of_the_inertial_unit());
  EXPECT_EQ(index.estimated(), 17);
  EXPECT_EQ(index.size(), 35);
  EXPECT_EQ(index.imu_end(), 15);
  EXPECT_EQ(index.of(Group::current), 15);
  EXPECT_EQ(index.of(Group::accel_scale), 17);
  EXPECT_EQ(index.name(index.of(Group::gyro_misalignment)), "gyro_misalignment_xy_rad");
}

TEST(Considered, IsThatOfTheJosephFormWithoutTheirGain) {
  test::Normal normal(11);
  const StateIndex index(StateGroups{}, of_the_inertial_unit());
  const int n = index.size();
  const int found = index.estimated();
  MatrixXd root(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) root(i, j) = normal();
  const MatrixXd p = root * root.transpose();
  ErrorFilter filter(index);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) filter.set(i, j, p(i, j));
  Observation observation;
  observation.rows = 3;
  MatrixXd h = MatrixXd::Zero(3, n);
  for (int i = 0; i < 3; ++i) {
    observation.innovation[static_cast<std::size_t>(i)] = normal();
    observation.sigma[static_cast<std::size_t>(i)] = 0.5 + i;
    for (const int j : {3 + i, 6, 20, n - 1}) {
      h(i, j) = normal();
      observation.h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = h(i, j);
    }
  }
  observation.list_columns(n);
  InnovationStatistics statistics;
  filter.statistics(observation, 1.0, statistics);
  std::array<double, kMaxStates> x{};
  ASSERT_TRUE(filter.update(observation, statistics, x));

  const MatrixXd r = Eigen::Vector3d(0.25, 2.25, 6.25).asDiagonal();
  const MatrixXd s = h * p * h.transpose() + r;
  MatrixXd gain = p * h.transpose() * s.inverse();
  gain.bottomRows(n - found).setZero();
  const MatrixXd left = MatrixXd::Identity(n, n) - gain * h;
  const MatrixXd expected = left * p * left.transpose() + gain * r * gain.transpose();
  const VectorXd moved =
      gain * Eigen::Vector3d(observation.innovation[0], observation.innovation[1], observation.innovation[2]);
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(x[static_cast<std::size_t>(i)], moved(i), 1e-10);
    for (int j = 0; j < n; ++j) {
      EXPECT_EQ(filter(i, j), filter(j, i));
      EXPECT_NEAR(filter(i, j), expected(i, j), 1e-10 * p.norm()) << i << ' ' << j;
    }
  }
}

TEST(Considered, TooManyAreRefusedWithWhatHelps) {
  EngineConfig config;
  (void)named_state_groups("full", config.groups);
  config.groups.gps_position_bias = config.groups.dvl_scale = config.groups.dvl_misalignment = false;
  config.groups.gyro_misalignment = config.groups.accel_misalignment = false;
  config.groups.gyro_scale = config.groups.accel_scale = false;
  config.groups.gps_lever = config.groups.mount_lever = config.groups.mount_angles = true;
  config.groups.baro_bias = config.groups.airspeed_bias = config.groups.airspeed_scale = true;
  config.groups.flow_angles = config.groups.model_bias = config.groups.model_scale = true;
  config.groups.depth_bias = config.groups.dvl_bias = config.groups.gps_latency = true;
  config.sensors = {default_sensor(SourceKind::gps, "gps"), default_sensor(SourceKind::dvl, "dvl")};
  const std::string refusal = config.validate();
  EXPECT_NE(refusal.find("considered"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("left_out"), std::string::npos) << refusal;
  config.left_out = LeftOut::noise;
  EXPECT_EQ(config.validate(), "");
}

}  // namespace
}  // namespace fathom::estimation
