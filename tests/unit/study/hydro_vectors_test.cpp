#include <fstream>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/hydro/runge_kutta.hpp"
#include "study/baselines/embedded_dynamics.hpp"
#include "study/baselines/ukf.hpp"
#include "support/paths.hpp"
#include "support/vectors.hpp"
#include "support/vehicles/hydro_vehicle.hpp"

namespace fathom::study::hydro {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using estimation::hydro::HydroCoefficients;
using estimation::hydro::runge_kutta;
using estimation::hydro::Vector6;
using nlohmann::json;
using test::matrix;
using test::vector3;

Eigen::VectorXd vector(const json& j) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(j.size()));
  for (std::size_t i = 0; i < j.size(); ++i) v(static_cast<Eigen::Index>(i)) = j.at(i).get<double>();
  return v;
}

class HydroVectors : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream in(test::vectors_dir() + "/alignment_and_hydro.json");
    ASSERT_TRUE(in) << "no numerical vectors in " << test::vectors_dir();
    vectors_ = json::parse(in);
  }
  /// The vehicle of the vectors, from their own parameters.
  [[nodiscard]] HydroCoefficients vehicle() const {
    return test::vehicle_of_vectors(vectors_.at("remus_params"));
  }
  static Controls controls(const json& j, const HydroCoefficients& c) {
    return {c.propulsor_rpm, j.at("dr").get<double>(), j.at("ds").get<double>()};
  }

  json vectors_;
};

TEST_F(HydroVectors, MassMatrix) {
  const VehicleModel model(vehicle());
  EXPECT_LT((model.mass() - matrix(vectors_.at("mass_matrix"))).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((model.mass_inverse() - matrix(vectors_.at("mass_matrix_inv"))).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_F(HydroVectors, StateDerivative) {
  const VehicleModel model(vehicle());
  for (const json& one : vectors_.at("state_derivative")) {
    const Vector6 nu = vector(one.at("nu"));
    const Vector3d gamma = vector3(one.at("gb"));
    const Controls drive = controls(one, model.coefficients());
    EXPECT_LT((model.load(nu, gamma, drive) - vector(one.at("tau"))).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT((model.derivative(nu, gamma, drive) - vector(one.at("nudot"))).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST_F(HydroVectors, RungeKuttaStep) {
  const VehicleModel model(vehicle());
  const json& one = vectors_.at("rk4_step");
  const Vector6 after = model.step(vector(one.at("nu")), vector3(one.at("gb")),
                                   controls(one, model.coefficients()), one.at("dt").get<double>());
  EXPECT_LT((after - vector(one.at("nu1"))).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_F(HydroVectors, InsErrorMatrices) {
  const json& one = vectors_.at("ins_error_matrices");
  const InsErrorMatrices m = ins_error_matrices(
      one.at("lat_deg").get<double>() * kRadPerDeg, one.at("h").get<double>(), vector3(one.at("v_n")),
      vector3(one.at("f_n")), {one.at("R0").get<double>(), one.at("Omega").get<double>()});
  const std::pair<const char*, const Matrix3d*> all[] = {
      {"P_rho", &m.P_rho}, {"P_v", &m.P_v},     {"V_rho", &m.V_rho}, {"V_v", &m.V_v},
      {"V_phi", &m.V_phi}, {"W_rho", &m.W_rho}, {"W_v", &m.W_v},     {"W_phi", &m.W_phi}};
  for (const auto& [name, actual] : all) {
    const Matrix3d expected = matrix(one.at(name));
    // Entries of one matrix differ by ten orders of magnitude: each against its own size.
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR((*actual)(i, j), expected(i, j), 1e-10 * std::abs(expected(i, j))) << name << i << j;
  }
}

TEST_F(HydroVectors, UkfStep) {
  const json& one = vectors_.at("ukf_step");
  const VehicleModel model(vehicle());
  NavigatorView navigator;
  navigator.C_NB = matrix(one.at("C_b_n_INS"));
  navigator.f_N_m_s2 = vector3(one.at("f_n"));
  navigator.v_N_m_s = vector3(one.at("v_n"));
  navigator.latitude_rad = one.at("lat_deg").get<double>() * kRadPerDeg;
  navigator.altitude_m = one.at("h_used_for_wen").get<double>();
  const EmbeddedDynamics dynamics(model, navigator, controls(one, model.coefficients()),
                                  {one.at("R0_used_in_deltas").get<double>(), geo::kEarthRate_rad_s});
  const double dt = one.at("dt").get<double>();

  Ukf<kEmbeddedStates> filter;
  filter.x = vector(one.at("x0"));
  filter.P = vector(one.at("P0_diag")).asDiagonal();
  using State = EmbeddedDynamics::State;
  filter.predict(
      [&](const State& x) {
        return runge_kutta(x, dt, [&](const State& s) { return dynamics.derivative(s); });
      },
      Ukf<kEmbeddedStates>::Matrix(vector(one.at("Q_diag")).asDiagonal()));
  EXPECT_LT((filter.x - vector(one.at("x_pred"))).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((filter.P.diagonal() - vector(one.at("P_pred_diag"))).cwiseAbs().maxCoeff(), 1e-8);

  const Vector3d measured = vector3(one.at("y"));
  const auto update = filter.update<3>([](const State& x) { return Vector3d(x.head<3>()); }, measured,
                                       Matrix3d(vector(one.at("R_diag")).asDiagonal()));
  ASSERT_TRUE(update.used);
  EXPECT_LT((update.predicted - vector(one.at("y_pred"))).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((update.covariance - matrix(one.at("Pyy"))).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((update.gain - matrix(one.at("K"))).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((filter.x - vector(one.at("x_upd"))).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((filter.P.diagonal() - vector(one.at("P_upd_diag"))).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((filter.P.row(0).transpose() - vector(one.at("P_upd_row0"))).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace fathom::study::hydro
