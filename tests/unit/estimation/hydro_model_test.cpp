#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimation/hydro/vehicle_model.hpp"
#include "estimation/ukf.hpp"
#include "support/analytic_vehicle.hpp"
#include "support/small_vehicle.hpp"

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

TEST(Ukf, LinearSystemIsAKalmanFilter) {
  Eigen::Matrix3d f;
  f << 1.0, 0.1, 0.0, -0.05, 0.98, 0.1, 0.0, 0.02, 0.9;
  const Eigen::Matrix3d q = Eigen::Vector3d(0.01, 0.02, 0.005).asDiagonal();
  Eigen::Matrix<double, 2, 3> h;
  h << 1.0, 0.0, 0.5, 0.0, 1.0, -0.2;
  const Eigen::Matrix2d r = Eigen::Vector2d(0.04, 0.09).asDiagonal();
  for (const UkfTuning tuning :
       {UkfTuning{0.5, 2.0, 0.0}, UkfTuning{1.0, 2.0, 0.0}, UkfTuning{0.1, 2.0, 0.0}}) {
    Ukf<3> ukf(tuning);
    ukf.x << 1.0, -2.0, 0.5;
    ukf.P = Eigen::Vector3d(1.0, 2.0, 0.5).asDiagonal();
    Vector3d x = ukf.x;
    Eigen::Matrix3d p = ukf.P;
    test::Normal normal(5);
    for (int i = 0; i < 30; ++i) {
      ukf.predict([&](const Vector3d& s) { return Vector3d(f * s); }, q);
      x = f * x;
      p = f * p * f.transpose() + q;
      const Eigen::Vector2d y(normal(1.0), normal(1.0));
      Ukf<3> linear = ukf;
      ukf.update<2>([&](const Vector3d& s) { return Eigen::Vector2d(h * s); }, y, r);
      EXPECT_TRUE(linear.update_linear<2>(h, y, r).used);
      EXPECT_LT((ukf.x - linear.x).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((ukf.P - linear.P).cwiseAbs().maxCoeff(), 1e-9);
      const Eigen::Matrix<double, 3, 2> k = p * h.transpose() * (h * p * h.transpose() + r).inverse();
      x += k * (y - h * x);
      p = (Eigen::Matrix3d::Identity() - k * h) * p;
      EXPECT_LT((ukf.x - x).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((ukf.P - p).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(Ukf, NegativeCentreWeightLeavesCovarianceDefinite) {
  // A strong even nonlinearity throws the mean far from the image of the centre, whose weight is negative.
  Ukf<2> ukf(UkfTuning{0.3, 0.0, 0.0});
  ukf.x << 0.0, 0.0;
  ukf.P = Eigen::Vector2d(1.0, 1.0).asDiagonal();
  const Eigen::Matrix2d q = 1e-12 * Eigen::Matrix2d::Identity();
  for (int i = 0; i < 20; ++i) {
    ukf.predict([](const Eigen::Vector2d& s) { return Eigen::Vector2d(5.0 * s.x() * s.x(), 0.9 * s.y()); },
                q);
    EXPECT_EQ(ukf.P, Eigen::Matrix2d(ukf.P.transpose()));
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(ukf.P).eigenvalues().minCoeff(), 0.0);
    ukf.update<1>([](const Eigen::Vector2d& s) { return Eigen::Matrix<double, 1, 1>(s.x()); },
                  Eigen::Matrix<double, 1, 1>(0.1), Eigen::Matrix<double, 1, 1>(1e-4));
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(ukf.P).eigenvalues().minCoeff(), 0.0);
  }
}

TEST(Ukf, DoubtfulMeasurementChangesNothing) {
  Ukf<2> ukf;
  ukf.P = Eigen::Matrix2d::Identity();
  const auto before = ukf.P;
  const auto update =
      ukf.update<1>([](const Eigen::Vector2d& s) { return Eigen::Matrix<double, 1, 1>(s.x()); },
                    Eigen::Matrix<double, 1, 1>(100.0), Eigen::Matrix<double, 1, 1>(1.0), 9.0);
  EXPECT_FALSE(update.used);
  EXPECT_EQ(ukf.P, before);
  EXPECT_EQ(ukf.x, Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace fathom::estimation::hydro
