#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimation/hydro/vehicle_model.hpp"
#include "support/vehicles/analytic_vehicle.hpp"
#include "support/vehicles/small_vehicle.hpp"

namespace fathom::estimation::hydro {
namespace {

using Eigen::Vector3d;

HydroCoefficients round_vehicle() {
  return test::small_vehicle();
}

TEST(HydroModel, KineticEnergyIsSymmetricAndPositive) {
  const VehicleModel model(round_vehicle());
  EXPECT_LT((model.mass() - model.mass().transpose()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6>(model.mass()).eigenvalues().minCoeff(), 0.0);
  EXPECT_LT((model.mass() * model.mass_inverse() - Matrix6::Identity()).cwiseAbs().maxCoeff(), 1e-12);
  // The rigid body's share, from the velocities of its mass points: E = m/2 |V + omega x r_G|^2 + omega'I
  // omega/2, with I about the origin.
  HydroCoefficients dry = round_vehicle();
  dry.X_udot = dry.Y_vdot = dry.Z_wdot = dry.K_pdot = dry.M_qdot = dry.N_rdot = 0.0;
  dry.Y_rdot = dry.N_vdot = dry.Z_qdot = dry.M_wdot = dry.Y_pdot = dry.K_vdot = dry.K_rdot = dry.N_pdot = 0.0;
  const Matrix6 rigid = mass_matrix(dry);
  test::Normal normal(3);
  for (int i = 0; i < 20; ++i) {
    const Vector3d v = normal.vector(1.0);
    const Vector3d omega = normal.vector(0.3);
    Vector6 nu;
    nu << v, omega;
    const Vector3d r_G(dry.x_G, dry.y_G, dry.z_G);
    const double translation = dry.mass() * (0.5 * v.squaredNorm() + v.dot(omega.cross(r_G)));
    const double rotation = 0.5 * omega.dot(Vector3d(dry.I_xx, dry.I_yy, dry.I_zz).cwiseProduct(omega));
    EXPECT_NEAR(0.5 * nu.dot(rigid * nu), translation + rotation, 1e-10);
  }
}

TEST(HydroModel, TurningAxesDoNoWork) {
  // Without water, weight and drive the forces are those of turning axes alone: nu' load = 0 in a point mass
  // at the origin, and the energy of the free body stays.
  HydroCoefficients c = round_vehicle();
  for (const CoefficientEntry& one : coefficient_table())
    if (one.kind != CoefficientKind::body) c.*one.member = 0.0;
  c.buoyancy = c.weight;
  c.x_G = c.y_G = c.z_G = 0.0;
  const VehicleModel model(c);
  test::Normal normal(4);
  for (int i = 0; i < 20; ++i) {
    Vector6 nu;
    nu << normal.vector(1.5), normal.vector(0.5);
    EXPECT_NEAR(nu.dot(model.load(nu, Vector3d::UnitZ(), {})), 0.0, 1e-10);
  }
}

TEST(HydroModel, DragEndsAnyMotion) {
  HydroCoefficients c = round_vehicle();
  c.buoyancy = c.weight;
  c.x_G = c.y_G = 0.0;
  const VehicleModel model(c);
  Vector6 nu;
  nu << 1.2, -0.3, 0.2, 0.1, 0.05, -0.2;
  const double energy = 0.5 * nu.dot(model.mass() * nu);
  for (int i = 0; i < 4000; ++i) nu = model.step(nu, Vector3d::UnitZ(), {}, 0.05);
  EXPECT_LT(0.5 * nu.dot(model.mass() * nu), 0.01 * energy);
}

TEST(HydroModel, SpeedGrowsWithShaftSpeed) {
  HydroCoefficients c = round_vehicle();
  c.buoyancy = c.weight;
  c.x_G = c.y_G = 0.0;
  const VehicleModel model(c);
  for (const double rpm : {600.0, 1200.0}) {
    Vector6 nu = Vector6::Zero();
    for (int i = 0; i < 4000; ++i) nu = model.step(nu, Vector3d::UnitZ(), {rpm, 0.0, 0.0}, 0.05);
    EXPECT_NEAR(nu[0], 2.0 * rpm / 1200.0, 1e-3);  // X_prop = -X_uu (2 m/s)^2
  }
}

TEST(HydroModel, ValidationNamesWhatIsWrong) {
  EXPECT_EQ(round_vehicle().validate(), "");
  HydroCoefficients c = round_vehicle();
  c.Y_vv = 131.0;
  EXPECT_EQ(c.validate(), "Y_vv: 131: expected a negative number: drag takes energy from the motion");
  c = round_vehicle();
  c.weight = 0.0;
  EXPECT_EQ(c.validate(), "weight: 0: expected a positive number");
  c = round_vehicle();
  c.M_uw = std::nan("");
  EXPECT_NE(c.validate().find("M_uw"), std::string::npos);
  c = round_vehicle();
  c.X_udot = 80.0;  // a wrong sign that outweighs the mass
  EXPECT_NE(c.validate().find("mass matrix"), std::string::npos);
  EXPECT_NE(HydroCoefficients{}.validate(), "");
}

}  // namespace
}  // namespace fathom::estimation::hydro
