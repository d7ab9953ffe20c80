#include "study/baselines/ukf.hpp"

#include <gtest/gtest.h>

#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::study {
namespace {

using Eigen::Vector3d;

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

bool is_positive_definite(const Eigen::Matrix2d& symmetric) {
  return symmetric(0, 0) > 0.0 && symmetric(0, 0) * symmetric(1, 1) > symmetric(0, 1) * symmetric(1, 0);
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
    EXPECT_TRUE(is_positive_definite(ukf.P));
    ukf.update<1>([](const Eigen::Vector2d& s) { return Eigen::Matrix<double, 1, 1>(s.x()); },
                  Eigen::Matrix<double, 1, 1>(0.1), Eigen::Matrix<double, 1, 1>(1e-4));
    EXPECT_TRUE(is_positive_definite(ukf.P));
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
}  // namespace fathom::study
