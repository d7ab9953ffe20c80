// States that are considered (KF-6): in the covariance as if they were estimated, but never found.
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "estimation/filter/error_filter.hpp"
#include "geo/wgs84.hpp"
#include "support/sanitized.hpp"
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

/// Horizontal error over its sigma, squared, a dimension: of a vehicle that hovers for half an hour by a DVL
/// that is off by a constant of `off_m_s` along each axis.
double hover(std::uint64_t seed, double off_m_s, double told_m_s) {
  constexpr double kRate_hz = 20.0;
  constexpr double kFor_s = 1800.0;
  const geo::Geodetic place{0.9, 0.1, -20.0};
  EngineConfig config;
  EXPECT_TRUE(named_state_groups("standard", config.groups));
  config.imu.nominal_rate_hz = kRate_hz;
  config.alignment.mode = StartMode::given;
  config.states.dvl_bias_sigma_m_s = told_m_s;
  SensorConfig dvl = default_sensor(SourceKind::dvl, "dvl");
  dvl.sigma.fill(0.005);
  config.sensors = {dvl};
  FusionEngine engine(config);
  InitialState start;
  start.latitude_rad = place.latitude_rad;
  start.longitude_rad = place.longitude_rad;
  start.altitude_m = place.altitude_m;
  start.position_sigma_N_m.fill(0.1);
  start.velocity_sigma_N_m_s.fill(0.01);
  start.attitude_sigma_rad.fill(1e-3);
  engine.start_from(start);
  test::Normal normal(seed);
  const Eigen::Vector3d off = normal.vector(off_m_s);
  ImuSample imu;
  imu.specific_force_B_m_s2 = {0.0, 0.0, -geo::gravity(place.latitude_rad, place.altitude_m)};
  imu.angular_rate_B_rad_s = geo::arr(geo::earth_rate_N(place.latitude_rad));
  DvlSample seen;
  constexpr int kSteps = static_cast<int>(kFor_s * kRate_hz);
  for (int k = 1; k <= kSteps; ++k) {
    const TimeNs now_ns = kNsPerSecond + from_seconds(k / kRate_hz);
    const auto count = static_cast<std::uint64_t>(k);
    imu.header = {"auv", "imu", now_ns, now_ns, count};
    engine.add(imu);
    if (k % 4 != 0) continue;
    seen.header = {"auv", "dvl", now_ns, now_ns, count};
    seen.velocity_D_m_s = geo::arr(off + normal.vector(0.005));
    engine.add(seen);
  }
  const NavState& nav = engine.nav_state();
  const Eigen::Vector3d error_N_m =
      geo::difference_N({nav.latitude_rad, nav.longitude_rad, nav.altitude_m}, place);
  return 0.5 * (error_N_m.x() * error_N_m.x() / nav.position_covariance_N_m2[0] +
                error_N_m.y() * error_N_m.y() / nav.position_covariance_N_m2[4]);
}

TEST(Considered, ABiasOfTheDvlCarriesAVehicleThatHoversAway) {
  FATHOM_MANY_RUNS();
  constexpr double kOff_m_s = 0.002;
  constexpr int kRuns = 12;
  double known = 0.0;
  double unknown = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    known += hover(seed, kOff_m_s, kOff_m_s) / kRuns;
    unknown += hover(seed, kOff_m_s, 0.0) / kRuns;
  }
  // Twenty-four draws: 99.9 % of such means lie between.
  EXPECT_GT(known, 0.3);
  EXPECT_LT(known, 2.2);
  EXPECT_GT(unknown, 10.0);
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
