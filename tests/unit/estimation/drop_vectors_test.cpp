#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/alignment/motion_level.hpp"
#include "estimation/alignment/stability_gate.hpp"
#include "estimation/alignment/tilt_filter.hpp"
#include "sim/triad_error.hpp"
#include "support/paths.hpp"
#include "support/vectors.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using nlohmann::json;
using test::vector3;

constexpr double kExact = 1e-10;

class DropVectors : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream in(test::vectors_dir() + "/alignment_and_hydro.json");
    ASSERT_TRUE(in) << "no numerical vectors in " << test::vectors_dir();
    all_ = json::parse(in);
  }
  json all_;
};

Vector3d angles(const json& one) {
  return kRadPerDeg * Vector3d(one.at("roll_deg"), one.at("pitch_deg"), one.at("yaw_deg"));
}

TEST_F(DropVectors, AttitudeMatrix) {
  for (const json& one : all_.at("C_n_b"))
    // Given from N into B: its first row is (cos pitch cos yaw, cos pitch sin yaw, -sin pitch).
    EXPECT_LT((geo::to_matrix(geo::from_rpy(angles(one))).transpose() - test::matrix(one.at("C"))).norm(),
              kExact);
}

TEST_F(DropVectors, LevelForwardAndBack) {
  for (const json& one : all_.at("align_forward_inverse")) {
    const Vector3d omega = vector3(one.at("w"));
    const Vector3d v = vector3(one.at("v"));
    const Vector3d v_dot = vector3(one.at("vdot"));
    const double g = one.at("g");
    const Matrix3d c = geo::to_matrix(geo::from_rpy(angles(one)));
    const Vector3d f = v_dot + geo::cross(omega, v) - c.transpose() * Vector3d(0.0, 0.0, g);
    EXPECT_LT((f - vector3(one.at("f_b"))).norm(), kExact);
    const MotionLevel printed = level_printed(vector3(one.at("f_b")), omega.z(), v.x(), g);
    EXPECT_NEAR(printed.roll_rad, one.at("eq5_roll_rad").get<double>(), kExact);
    EXPECT_NEAR(printed.pitch_rad, one.at("eq5_pitch_rad").get<double>(), kExact);
    const MotionLevel robust = level_in_motion(vector3(one.at("f_b")), v_dot, omega, v);
    EXPECT_NEAR(robust.roll_rad, one.at("full_roll_rad").get<double>(), kExact);
    EXPECT_NEAR(robust.pitch_rad, one.at("full_pitch_rad").get<double>(), kExact);
  }
}

TEST_F(DropVectors, PrintedFormAndItsDomain) {
  for (const json& one : all_.at("align_eq5_direct")) {
    const MotionLevel got = level_printed({one.at("fx"), one.at("fy"), -9.7}, one.at("wz"), one.at("vx"),
                                          one.at("g").get<double>());
    EXPECT_EQ(got.fault, LevelFault::none);
    EXPECT_NEAR(got.roll_rad, one.at("roll_rad").get<double>(), kExact);
    EXPECT_NEAR(got.pitch_rad, one.at("pitch_rad").get<double>(), kExact);
  }
  for (const json& one : all_.at("align_domain")) {
    const MotionLevel got =
        level_printed({one.at("fx"), one.at("fy"), -9.7}, one.at("wz"), one.at("vx"), 9.80665);
    EXPECT_NE(got.fault, LevelFault::none) << one.at("expect");
    EXPECT_TRUE(std::isnan(got.roll_rad) && std::isnan(got.pitch_rad));
  }
}

TEST_F(DropVectors, SensorErrors) {
  const json& models = all_.at("IMU_models");
  for (const char* name : {"eq6", "eq7"}) {
    const json& one = models.at(name);
    const bool gyro = one.contains("w_true");
    const sim::AxisError error{one.at("bias"), one.at("eps"), one.at("gam_y"), one.at("gam_z")};
    const double out =
        sim::axis_output(vector3(one.at(gyro ? "w_true" : "f_true")), 0, error, one.at("noise"));
    EXPECT_NEAR(out, one.at(gyro ? "w_out_x" : "f_out_x").get<double>(), kExact);
  }
  const json& log = models.at("eq8");
  EXPECT_NEAR(sim::propulsor_speed(log.at("R"), log.at("Kv"), log.at("eps_v"), log.at("noise")),
              log.at("v").get<double>(), kExact);
}

/// A steady run whose readings never repeat to the bit, as those of a real instrument.
StabilityInput steady(int sample) {
  StabilityInput in;
  in.dt_s = 0.01;
  in.roll_rad = in.pitch_rad = 0.0;
  in.depth_error_m = 0.5;
  in.speed_m_s = 17.0;
  in.force_B_m_s2 = {sample % 2 == 0 ? 1e-3 : -1e-3, 0.0, -in.g_m_s2};
  return in;
}

TEST_F(DropVectors, ConditionsToTheSample) {
  const json& conditions = all_.at("conditions");
  StabilityConfig config;
  config.low_pass_s = 0.0;  // a single sample is meant to show
  for (std::size_t which = 0; which < conditions.at("cases").size(); ++which) {
    const json& one = conditions.at("cases")[which];
    StabilityGate gate(config);
    int first_ok = -1;
    int full = -1;
    double sum = 0.0;
    for (int i = 0; i < 700 && full < 0; ++i) {
      StabilityInput in = steady(i);
      in.pitch_rad = 1e-5 * i;
      if (which == 1 && i == 150) in.roll_rad = 16.0 * kRadPerDeg;
      if (which == 2 && i == 250) in.force_B_m_s2.x() = 1.2;
      const auto phase = gate.add(in);
      if (first_ok < 0 && phase == StabilityGate::Phase::averaging) first_ok = i;
      if (first_ok >= 0 && i > first_ok) sum += in.pitch_rad;
      if (phase == StabilityGate::Phase::full) full = i;
    }
    EXPECT_EQ(first_ok, one.at("first_ok_sample").get<int>()) << one.at("desc");
    EXPECT_EQ(full, one.at("last_avg_sample").get<int>()) << one.at("desc");
    // The window is the samples first_avg .. last_avg, all of them and no other.
    const int n = full - one.at("first_avg_sample").get<int>() + 1;
    EXPECT_EQ(n, 100);
    EXPECT_NEAR(gate.window().pitch_rad, sum / n, 1e-15) << one.at("desc");
  }
}

TEST_F(DropVectors, InvariantFilterStep) {
  const json& one = all_.at("inekf_step");
  using F = TiltFilter;
  constexpr int n = 7;
  F::Matrix p = F::Matrix::Zero();
  F::Vector noise = F::Vector::Zero();
  for (int i = 0; i < n; ++i) {
    p(i, i) = one.at("P0_diag")[static_cast<std::size_t>(i)];
    noise(i) = one.at("Q_diag")[static_cast<std::size_t>(i)];
  }
  const auto near = [](const F::Matrix& covariance, const json& diagonal) {
    for (int i = 0; i < n; ++i)
      EXPECT_NEAR(covariance(i, i), diagonal[static_cast<std::size_t>(i)].get<double>(), kExact) << i;
  };
  F filter;
  filter.start(geo::from_matrix(test::matrix(one.at("C_b_n"))), vector3(one.at("v_n")), one.at("z"), p);
  filter.predict(one.at("dt"), vector3(one.at("w_nb")), vector3(one.at("f_b")), {0.0, 0.0, one.at("g")},
                 noise, F::Vector::Ones());
  EXPECT_LT((filter.v_N_m_s() - vector3(one.at("v_pred"))).norm(), kExact);
  EXPECT_NEAR(filter.depth_m(), one.at("z_pred").get<double>(), kExact);
  EXPECT_LT((geo::to_matrix(filter.q_NB()) - test::matrix(one.at("C_pred"))).norm(), kExact);
  near(filter.covariance(), one.at("P_pred_diag"));

  const json& y = one.at("y");
  const auto sigma = [&one](std::size_t i) { return std::sqrt(one.at("R_diag")[i].get<double>()); };
  const F::Row rows[] = {filter.speed_row(y[0], sigma(0)), filter.side_row(y[1], sigma(1)),
                         filter.heave_row(y[2], sigma(2)), filter.depth_row(y[3], sigma(3))};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(rows[i].innovation, one.at("innovation")[i].get<double>(), kExact);
  const F::Result result = filter.update(rows, 4, 100.0);
  for (int i = 0; i < n; ++i)
    EXPECT_NEAR(result.x(i), one.at("dx")[static_cast<std::size_t>(i)].get<double>(), kExact);
  EXPECT_LT((geo::to_matrix(filter.q_NB()) - test::matrix(one.at("C_upd"))).norm(), kExact);
  EXPECT_LT((filter.v_N_m_s() - vector3(one.at("v_upd"))).norm(), kExact);
  EXPECT_NEAR(filter.depth_m(), one.at("z_upd").get<double>(), kExact);
  near(filter.covariance(), one.at("P_upd_diag"));
}

}  // namespace
}  // namespace fathom::estimation
