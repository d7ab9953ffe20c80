#include "support/vectors.hpp"

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/aiding/depth.hpp"
#include "estimation/aiding/dvl_velocity.hpp"
#include "estimation/aiding/heading.hpp"
#include "estimation/alignment/rest_window.hpp"
#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/strapdown.hpp"

namespace fathom::estimation {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using nlohmann::json;
using test::matrix;
using test::relative_error;
using test::vector3;

class Vectors : public test::VectorsTest {};

geo::Quaternion quaternion(const json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>(), j.at(3).get<double>()};
}

void expect_equal(const geo::Quaternion& q, const json& expected, double tolerance) {
  EXPECT_NEAR(q.w, expected.at(0).get<double>(), tolerance);
  EXPECT_NEAR(q.x, expected.at(1).get<double>(), tolerance);
  EXPECT_NEAR(q.y, expected.at(2).get<double>(), tolerance);
  EXPECT_NEAR(q.z, expected.at(3).get<double>(), tolerance);
}

TEST_F(Vectors, Gravity) {
  const auto& expected = out("gravity_somigliana");
  const auto& cases = in("gravity_somigliana").at("cases_lat_deg_h_m");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double latitude = cases.at(i).at(0).get<double>() * kRadPerDeg;
    EXPECT_NEAR(geo::gravity(latitude, cases.at(i).at(1).get<double>()), expected.at(i).get<double>(), 1e-9);
  }
}

TEST_F(Vectors, Radii) {
  const auto& latitudes = in("curvature_radii").at("lat_deg");
  for (std::size_t i = 0; i < latitudes.size(); ++i) {
    const geo::Radii r = geo::radii(latitudes.at(i).get<double>() * kRadPerDeg);
    EXPECT_NEAR(r.meridian_m, out("curvature_radii").at("RM").at(i).get<double>(), 1e-6);
    EXPECT_NEAR(r.normal_m, out("curvature_radii").at("RN").at(i).get<double>(), 1e-6);
  }
}

TEST_F(Vectors, EulerAngles) {
  const Vector3d rpy = kRadPerDeg * vector3(in("euler_to_dcm_quat").at("rpy_deg"));
  const geo::Quaternion q = geo::from_rpy(rpy);
  expect_equal(q, out("euler_to_dcm_quat").at("q_wxyz"), 1e-14);
  EXPECT_LT(relative_error(geo::to_matrix(q), matrix(out("euler_to_dcm_quat").at("C_bn"))), 1e-14);
  EXPECT_LT((geo::to_rpy(q) - rpy).norm(), 1e-14);
}

TEST_F(Vectors, RotationVector) {
  const auto& cases = in("rotation_vector_to_quat").at("rotvec");
  for (std::size_t i = 0; i < cases.size(); ++i)
    expect_equal(geo::exp(vector3(cases.at(i))), out("rotation_vector_to_quat").at(i), 1e-15);
}

struct Start {
  NavSolution nav;
  Increments in;
};

Start mechanisation_start(const json& j) {
  Start s;
  s.nav.position = {j.at("lat_deg").get<double>() * kRadPerDeg, j.at("lon_deg").get<double>() * kRadPerDeg,
                    j.at("h").get<double>()};
  s.nav.v_N_m_s = vector3(j.at("v_ned"));
  s.nav.q_NB = quaternion(j.at("q_wxyz"));
  s.in.dt_s = j.at("dt").get<double>();
  s.in.dtheta_rad = vector3(j.at("dtheta"));
  s.in.dv_m_s = vector3(j.at("dv"));
  s.in.dtheta_before_rad = vector3(j.at("dtheta_prev"));
  s.in.dv_before_m_s = vector3(j.at("dv_prev"));
  return s;
}

TEST_F(Vectors, MechanisationStep) {
  const Start s = mechanisation_start(in("mechanisation_step"));
  const NavSolution end = mechanise(s.nav, correct(s.in));
  const json& e = out("mechanisation_step");
  EXPECT_NEAR(end.position.latitude_rad, e.at("lat_rad").get<double>(), 1e-15);
  EXPECT_NEAR(end.position.longitude_rad, e.at("lon_rad").get<double>(), 1e-15);
  EXPECT_NEAR(end.position.altitude_m, e.at("h").get<double>(), 1e-9);
  EXPECT_LT((end.v_N_m_s - vector3(e.at("v_ned"))).norm(), 1e-12);
  expect_equal(end.q_NB, e.at("q_wxyz"), 1e-14);
}

TEST_F(Vectors, MechanisationHundredSteps) {
  Start s = mechanisation_start(in("mechanisation_step"));
  for (int k = 0; k < 100; ++k) {
    s.in.dtheta_rad = {1e-3 * std::sin(0.3 * k), 1e-3 * std::cos(0.3 * k), 1.9e-3};
    s.in.dv_m_s = {0.003 * std::cos(0.2 * k), 0.003, -0.098 + 0.001 * std::sin(0.5 * k)};
    s.nav = mechanise(s.nav, correct(s.in));
    s.in.dtheta_before_rad = s.in.dtheta_rad;
    s.in.dv_before_m_s = s.in.dv_m_s;
  }
  const json& e = out("mechanisation_100_steps");
  EXPECT_NEAR(s.nav.position.latitude_rad, e.at("lat_rad").get<double>(), 1e-14);
  EXPECT_NEAR(s.nav.position.longitude_rad, e.at("lon_rad").get<double>(), 1e-14);
  EXPECT_NEAR(s.nav.position.altitude_m, e.at("h").get<double>(), 1e-9);
  EXPECT_LT((s.nav.v_N_m_s - vector3(e.at("v_ned"))).norm(), 1e-10);
  expect_equal(s.nav.q_NB, e.at("q_wxyz"), 1e-12);
}

TEST_F(Vectors, ErrorDynamics) {
  const json& j = in("F_matrix_9_geodetic");
  NavSolution nav;
  nav.position = {j.at("lat_deg").get<double>() * kRadPerDeg, 0.0, j.at("h").get<double>()};
  nav.v_N_m_s = vector3(j.at("v_ned"));
  nav.q_NB = geo::from_rpy(kRadPerDeg * vector3(j.at("rpy_deg")));
  const Matrix9 f = error_dynamics(nav, geo::to_matrix(nav.q_NB) * vector3(j.at("f_body")));
  // The vector speaks of latitude, longitude and height; ours of metres north, east and down. Besides the
  // units, the metric itself changes on the way: d(R dL)/dt has a part from dR/dt.
  const geo::Radii r = geo::radii(nav.position.latitude_rad);
  const double rm = r.meridian_m + nav.position.altitude_m;
  const double rn = r.normal_m + nav.position.altitude_m;
  const double cosine = std::cos(nav.position.latitude_rad);
  MatrixXd to_metres = MatrixXd::Identity(9, 9);
  to_metres(0, 0) = rm;
  to_metres(1, 1) = rn * cosine;
  to_metres(2, 2) = -1.0;
  MatrixXd expected = to_metres * matrix(out("F_matrix_9_geodetic").at("F")) * to_metres.inverse();
  expected(0, 0) += -nav.v_N_m_s.z() / rm;
  // The radius of a parallel changes with latitude by -(R_M + h) sin L, whatever the radii of curvature do.
  expected(1, 1) += -nav.v_N_m_s.z() / rn - nav.v_N_m_s.x() / rn * std::tan(nav.position.latitude_rad);
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column) {
      const double value = expected(row, column);
      EXPECT_NEAR(f(row, column), value, std::max(1e-9 * std::abs(value), 1e-20)) << row << ' ' << column;
    }
}

TEST_F(Vectors, DvlJacobian) {
  const json& j = in("H_dvl_body");
  const json& e = out("H_dvl_body");
  StateGroups groups;
  groups.dvl_scale_xyz = groups.dvl_misalignment = groups.dvl_bias = true;
  const StateIndex index(groups);
  FilterState state;
  state.nav.position.latitude_rad = j.at("lat_deg").get<double>() * kRadPerDeg;
  state.nav.q_NB = geo::from_rpy(kRadPerDeg * vector3(j.at("rpy_deg")));
  state.nav.v_N_m_s = vector3(j.at("v_ned"));
  const auto put = [&](Group group, const char* key) {
    for (int i = 0; i < 3; ++i)
      state.x[static_cast<std::size_t>(index.of(group) + i)] =
          j.at(key).at(static_cast<std::size_t>(i)).get<double>();
  };
  put(Group::dvl_scale_xyz, "scale");
  put(Group::dvl_misalignment, "misalign_rad");
  put(Group::dvl_bias, "bias");
  // The vector leaves out the transport rate, which turns the lever by 9e-8 m/s.
  const Vector3d transport_B = geo::to_matrix(state.nav.q_NB).transpose() *
                               geo::transport_rate_N(state.nav.position, state.nav.v_N_m_s);
  const AidingState aiding(index, state, vector3(j.at("w_ib_b")) + transport_B, kUnknown);
  SensorConfig sensor = default_sensor(SourceKind::dvl, "dvl0");
  sensor.lever_B_m = geo::arr(vector3(j.at("lever")));
  DvlSample sample;
  sample.velocity_D_m_s = {0.0, 0.0, 0.0};
  const DvlVelocity model(aiding, sensor, sample);
  EXPECT_LT(relative_error(model.predicted(), vector3(e.at("pred"))), 1e-9);
  Observation observation;
  observe(model, index, observation);
  const auto expect_block = [&](Group group, const char* key) {
    MatrixXd block(3, 3);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        block(r, c) =
            observation.h[static_cast<std::size_t>(r)][static_cast<std::size_t>(index.of(group) + c)];
    EXPECT_LT(relative_error(block, matrix(e.at(key))), 1e-9) << key;
  };
  expect_block(Group::velocity, "H_v");
  expect_block(Group::attitude, "H_phi");
  expect_block(Group::gyro_bias, "H_bg");
  expect_block(Group::dvl_scale_xyz, "H_scale");
  expect_block(Group::dvl_misalignment, "H_misalign");
  expect_block(Group::dvl_bias, "H_bias");
}

TEST_F(Vectors, CompassJacobian) {
  const json& j = in("H_compass");
  const json& e = out("H_compass");
  StateGroups groups;
  groups.heading_bias = groups.heading_deviation = true;
  const StateIndex index(groups);
  FilterState state;
  state.nav.q_NB = geo::from_rpy(kRadPerDeg * vector3(j.at("rpy_deg")));
  state.x[static_cast<std::size_t>(index.of(Group::heading_bias))] =
      j.at("A..E_deg").at(0).get<double>() * kRadPerDeg;
  for (int i = 0; i < 4; ++i)
    state.x[static_cast<std::size_t>(index.of(Group::heading_deviation) + i)] =
        j.at("A..E_deg").at(static_cast<std::size_t>(i + 1)).get<double>() * kRadPerDeg;
  const AidingState aiding(index, state, Vector3d::Zero(), kUnknown);
  const SensorConfig sensor = default_sensor(SourceKind::heading, "compass0");
  HeadingSample sample;
  sample.heading_rad = 2.0;
  const Heading model(aiding, sensor, sample);
  EXPECT_NEAR(model.predicted()(0), e.at("pred_rad").get<double>(), 1e-13);
  Observation observation;
  observe(model, index, observation);
  const auto h = [&](Group group, int i) {
    return observation.h[0][static_cast<std::size_t>(index.of(group) + i)];
  };
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(h(Group::attitude, i), e.at("H_phi_with_dev").at(static_cast<std::size_t>(i)).get<double>(),
                1e-13);
  EXPECT_NEAR(h(Group::heading_bias, 0), e.at("H_ABCDE").at(0).get<double>(), 1e-13);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(h(Group::heading_deviation, i),
                e.at("H_ABCDE").at(static_cast<std::size_t>(i + 1)).get<double>(), 1e-13);
}

TEST_F(Vectors, DepthAndCompassRowsOfHybrid25) {
  StateGroups groups;
  ASSERT_TRUE(named_state_groups("hybrid25", groups));
  const StateIndex index(groups);
  ASSERT_EQ(index.size(), 25);
  const FilterState state;
  const AidingState aiding(index, state, Vector3d::Zero(), kUnknown);
  const SensorConfig sensor = default_sensor(SourceKind::depth, "depth0");
  DepthSample depth;
  depth.depth_m = 3.0;
  Observation observation;
  observe(Depth(aiding, sensor, depth, 0.0), index, observation);
  // The vector's order of states is the published one: +1 on depth (2), -1 on the bias of its gauge (17).
  double sum = 0.0;
  for (int i = 0; i < 25; ++i) sum += std::abs(observation.h[0][static_cast<std::size_t>(i)]);
  EXPECT_EQ(observation.h[0][2], out("H_depth_25").at("H").at(2).get<double>());
  EXPECT_EQ(observation.h[0][static_cast<std::size_t>(index.of(Group::depth_bias))],
            out("H_depth_25").at("H").at(17).get<double>());
  EXPECT_EQ(sum, 2.0);

  HeadingSample heading;
  heading.heading_rad = 0.1;
  Observation compass;
  const SensorConfig compass_config = default_sensor(SourceKind::heading, "c");
  observe(Heading(aiding, compass_config, heading), index, compass);
  EXPECT_EQ(compass.h[0][8], out("H_compass_25").at("H").at(8).get<double>());
  EXPECT_EQ(compass.h[0][static_cast<std::size_t>(index.of(Group::heading_bias))],
            out("H_compass_25").at("H").at(21).get<double>());
}

TEST_F(Vectors, PredictAndUpdate15) {
  const json& j = in("predict_update_15");
  const json& e = out("predict_update_15");
  const StateIndex index{StateGroups{}};
  FilterState state;
  state.nav.position = {j.at("lat_deg").get<double>() * kRadPerDeg, 0.0, j.at("h").get<double>()};
  state.nav.v_N_m_s = vector3(j.at("v_ned"));
  state.nav.q_NB = geo::from_rpy(kRadPerDeg * vector3(j.at("rpy_deg")));
  const Vector3d force = vector3(j.at("f_body"));
  std::array<double, kMaxStates> sigma{};
  for (std::size_t i = 0; i < 15; ++i) sigma[i] = std::sqrt(j.at("P0_diag").at(i).get<double>());
  ErrorFilter filter(15);
  filter.reset(sigma);
  ProcessNoise noise;
  const double vrw = j.at("vrw").get<double>();
  const double arw = j.at("arw").get<double>();
  noise.velocity = vrw * vrw * Eigen::Matrix3d::Identity();
  noise.attitude = arw * arw * Eigen::Matrix3d::Identity();
  filter.propagate(NavTransition(index, state.nav, Vector3d::Zero(), force, j.at("dt").get<double>()), noise);
  for (int i = 0; i < 15; ++i)
    EXPECT_NEAR(filter(i, i) / e.at("Pminus_diag").at(static_cast<std::size_t>(i)).get<double>(), 1.0, 1e-9)
        << i;
  MatrixXd cross(3, 3);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) cross(r, k) = filter(3 + r, 6 + k);
  EXPECT_LT(relative_error(cross, matrix(e.at("Pminus_v_phi"))), 1e-9);

  const AidingState aiding(index, state, Vector3d::Zero(), kUnknown);
  SensorConfig sensor = default_sensor(SourceKind::dvl, "dvl0");
  sensor.lever_B_m = geo::arr(vector3(j.at("lever")));
  DvlSample sample;
  sample.velocity_D_m_s = {0.0, 0.0, 0.0};
  Observation observation;
  observe(DvlVelocity(aiding, sensor, sample), index, observation);
  for (std::size_t i = 0; i < 3; ++i) {
    observation.innovation[i] = j.at("z_body").at(i).get<double>();
    observation.sigma[i] = j.at("R_sigma").get<double>();
  }
  observation.list_columns(15);
  InnovationStatistics statistics;
  filter.statistics(observation, 1.0, statistics);
  EXPECT_NEAR(statistics.squared_distance / e.at("NIS").get<double>(), 1.0, 1e-9);
  std::array<double, kMaxStates> x{};
  ASSERT_TRUE(filter.update(observation, statistics, x));
  for (int i = 0; i < 15; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(filter(i, i) / e.at("Pplus_diag").at(at).get<double>(), 1.0, 1e-9) << i;
    EXPECT_NEAR(x[at] / e.at("x_plus").at(at).get<double>(), 1.0, 1e-9) << i;
  }
}

TEST_F(Vectors, Levelling) {
  const Eigen::Vector2d tilt = level(vector3(in("levelling").at("f_body_mean")));
  EXPECT_NEAR(tilt.x(), out("levelling").at("roll").get<double>(), 1e-15);
  EXPECT_NEAR(tilt.y(), out("levelling").at("pitch").get<double>(), 1e-15);
}

TEST_F(Vectors, ConingCorrectionLeavesFivePercent) {
  const json& j = in("coning_drift");
  const double half = j.at("cone_half_angle_deg").get<double>() * kRadPerDeg;
  const double w = 2.0 * 3.14159265358979323846 * j.at("freq_hz").get<double>();
  const double dt = j.at("dt").get<double>();
  // The vector is the limit of a small cone: half of half^2 w, less what one sample sees of it.
  const double limit = 0.5 * half * half * w * (1.0 - std::sin(w * dt) / (w * dt));
  EXPECT_LT(relative_error(limit, out("coning_drift").at("uncompensated_rate").get<double>()), 1e-9);
  const double expected = out("coning_drift").at("after_600s_rad").get<double>();
  EXPECT_LT(relative_error(600.0 * limit, expected), 1e-9);

  // A body whose x axis describes a cone: attitude is a rotation by `half` about an axis that turns in y-z.
  const auto attitude = [&](double t) {
    return geo::exp(half * Vector3d(0.0, std::cos(w * t), std::sin(w * t)));
  };
  const auto drift_in_parts = [&](bool corrected, int parts) {
    geo::Quaternion q = attitude(0.0);
    Vector3d before = Vector3d::Zero();
    const int steps = static_cast<int>(60.0 / dt);
    for (int k = 0; k < steps; ++k) {
      // Integral of the body rate over the interval: many small rotations.
      Vector3d dtheta = Vector3d::Zero();
      for (int i = 0; i < parts; ++i) {
        const double t = (k + static_cast<double>(i) / parts) * dt;
        dtheta += geo::log(geo::conjugate(attitude(t)) * attitude(t + dt / parts));
      }
      if (k == 0) before = dtheta;
      Increments in;
      in.dt_s = dt;
      in.dtheta_rad = dtheta;
      in.dtheta_before_rad = corrected ? before : Vector3d::Zero();
      q = q * geo::exp(correct(in).rotation_rad);
      before = dtheta;
    }
    return std::abs(geo::log(geo::conjugate(attitude(steps * dt)) * q).x()) * 600.0 / 60.0;
  };
  // The parts themselves cone a little, by the square of their length.
  const auto drift = [&](bool corrected) {
    return (4.0 * drift_in_parts(corrected, 16) - drift_in_parts(corrected, 8)) / 3.0;
  };
  EXPECT_NEAR(drift(false) / expected, 1.0, 1e-4);
  EXPECT_NEAR(drift(true) / expected, 0.05, 0.002);
}

}  // namespace
}  // namespace fathom::estimation
