#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "commission/fit/signed_axes.hpp"
#include "sim/random.hpp"
#include "support/sanitized.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {
namespace {

using commission::Finding;
using commission::FindingKind;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d turned(const Vector3d& rotation_rad) {
  return geo::to_matrix(geo::exp(rotation_rad));
}

// One of the 24 ways a box can be screwed down, and up to 5 degrees about each axis.
Matrix3d drawn_mounting(sim::Random& random) {
  std::vector<Matrix3d> proper;
  for (const Matrix3d& P : commission::signed_axes())
    if (P.determinant() > 0.0) proper.push_back(P);
  const Matrix3d P = proper[static_cast<std::size_t>(random.uniform(0.0, 23.999))];
  return P *
         turned(Vector3d(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)) *
                kRadPerDeg);
}

Vector3d drawn(sim::Random& random, double half) {
  return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

// What was found against the truth: within the figure that is asked, or within three and a half of its own
// sigmas.
void expect_near(const commission::Findings& findings, const char* sensor, const std::string& what,
                 double truth, double asked, std::uint64_t seed) {
  const Finding* finding = find(findings, sensor, what);
  ASSERT_NE(finding, nullptr) << sensor << " " << what;
  if (!finding->known) return;
  const double apart = std::abs(finding->value - truth);
  EXPECT_LT(apart, std::max(asked, 4.0 * finding->sigma))
      << "seed " << seed << " " << finding->text << " truth " << truth;
  EXPECT_LT(apart, 4.5 * finding->sigma + 0.2 * asked)
      << "claimed too much: seed " << seed << " " << finding->text << " truth " << truth;
}

TEST(CommissionBlind, FindsMountingLeversLatenciesAndNoiseThatWereDrawn) {
  FATHOM_MANY_RUNS();
  int axes = 0;
  int within = 0;
  double worst_deg = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    sim::Random random(seed, "blind");
    const Matrix3d C_BI = drawn_mounting(random);
    const Matrix3d C_BD = drawn_mounting(random);
    sim::Scenario scenario = commissioning_vehicle();
    const Vector3d gps_lever = drawn(random, 0.3) + Vector3d(0.0, 0.0, -0.5);
    const Vector3d dvl_lever = drawn(random, 0.5);
    scenario.sensors.of<GpsSample>().lever_B_m = geo::arr(gps_lever);
    scenario.sensors.of<DvlSample>().lever_B_m = geo::arr(dvl_lever);
    auto& imu = scenario.sensors.of<ImuSample>();
    imu.gyro.random_walk = random.uniform(0.05, 0.2) * kRadPerDeg / 60.0;
    imu.accelerometer.random_walk = random.uniform(0.02, 0.06) / 60.0;
    dataset::Dataset data = drive(scenario, seed);
    through(data, C_BI.transpose(), C_BI.transpose());
    dvl_through(data, C_BD.transpose());
    const double gps_late = random.uniform(-0.2, 0.2);
    const double dvl_late = random.uniform(-0.2, 0.4);
    stamp_late<GpsSample>(data, gps_late);
    stamp_late<DvlSample>(data, dvl_late);

    commission::Assumed nothing;
    const auto found = commission::commission(data, nothing);
    // The nearest of the 24 is what the unit is mounted by; body axes are then those of its box.
    const Matrix3d Q = commission::nearest_signed_axes(C_BI);
    if (Q.isIdentity(1e-9)) {
      EXPECT_FALSE(found.patch.C_BI.has_value()) << "seed " << seed;
    } else {
      ASSERT_TRUE(found.patch.C_BI.has_value()) << "seed " << seed << "\n" << wrongs(found.findings);
      EXPECT_TRUE(found.patch.C_BI->isApprox(Q, 1e-9)) << "seed " << seed << "\n"
                                                       << *found.patch.C_BI << "\nwas drawn\n"
                                                       << Q;
    }
    const Matrix3d C_boxB = Q * C_BI.transpose();  // body of the truth into that of the box
    const Matrix3d C_boxD = C_boxB * C_BD;
    // A turn about the way it goes hardly changes what a DVL reads: that angle the log tells least.
    ASSERT_TRUE(found.patch.C_BD.has_value()) << "seed " << seed;
    const Vector3d ahead_D = C_BD.transpose().col(0);
    const Vector3d off_D = geo::log(geo::from_matrix(C_boxD.transpose() * *found.patch.C_BD)) / kRadPerDeg;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(ahead_D[axis]) > 0.5) continue;
      EXPECT_LT(std::abs(off_D[axis]), 0.5) << "seed " << seed << " axis " << axis;
      worst_deg = std::max(worst_deg, std::abs(off_D[axis]));
      ++axes;
      if (std::abs(off_D[axis]) < 0.2) ++within;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::string lever = std::string("lever_") + static_cast<char>('x' + axis);
      expect_near(found.findings, "dvl", lever, (C_boxB * dvl_lever)[axis], 0.05, seed);
      expect_near(found.findings, "gps", lever, (C_boxB * gps_lever)[axis], 0.05, seed);
    }
    expect_near(found.findings, "dvl", "latency", dvl_late, 0.005, seed);
    expect_near(found.findings, "gps", "latency", gps_late, 0.005, seed);
    const Finding* gyro = find(found.findings, "imu", "gyro_noise");
    const Finding* force = find(found.findings, "imu", "accelerometer_noise");
    ASSERT_NE(gyro, nullptr);
    ASSERT_NE(force, nullptr);
    EXPECT_NEAR(gyro->value / (imu.gyro.random_walk * 60.0 / kRadPerDeg), 1.0, 0.2) << "seed " << seed;
    EXPECT_NEAR(force->value / (imu.accelerometer.random_walk * 60.0), 1.0, 0.2) << "seed " << seed;
    for (const Finding& finding : found.findings) {
      EXPECT_FALSE(finding.kind == FindingKind::instability && finding.known)
          << "seed " << seed << " " << finding.text;
    }
  }
  EXPECT_GE(within * 10, axes * 9) << within << " of " << axes << " within 0.2 degrees, the worst "
                                   << worst_deg;
}

}  // namespace
}  // namespace fathom::test
