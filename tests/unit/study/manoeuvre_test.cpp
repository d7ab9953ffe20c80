// Open-loop manoeuvres of the REMUS 100 model: what its documentation states is recomputed here.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/hydro/vehicle_model.hpp"
#include "study/hydro/vehicles.hpp"
#include "unit/study/remus_motion.hpp"

namespace fathom::study {
namespace {

using estimation::hydro::Vector6;
using estimation::hydro::VehicleModel;

using Motion = RemusMotion;

Motion run(double rudder_deg, double stern_deg, double duration_s) {
  return RemusMotion::run(rudder_deg, stern_deg, duration_s);
}

void record(const std::string& name, double value) {
  testing::Test::RecordProperty(name, std::to_string(value));
}

TEST(RemusManoeuvres, StraightAhead) {
  // The published thrust balances the published drag at 1.54 m/s, and its torque the weight at 5.3 deg of
  // heel.
  const VehicleModel model(hydro::remus100());
  Vector6 nu = Vector6::Zero();
  nu[0] = 1.54;
  const double heel_rad = -5.3 * kRadPerDeg;
  const Vector6 load = model.load(nu, {0.0, std::sin(heel_rad), std::cos(heel_rad)}, {1500.0, 0.0, 0.0});
  EXPECT_NEAR(load[0], 0.0, 0.03);
  EXPECT_NEAR(load[3], 0.0, 0.005);
}

TEST(RemusManoeuvres, TurningCircle) {
  for (const double rudder : {-4.0, 4.0, -8.0, 8.0, -13.6, 13.6}) {
    const Motion before = run(rudder, 0.0, 40.0);
    const Motion after = run(rudder, 0.0, 50.0);
    const double rate_rad_s = (after.turned_rad - before.turned_rad) / 10.0;
    const double speed = after.nu.head<2>().norm();
    // A fin turned to port (negative) turns to starboard.
    EXPECT_LT(rate_rad_s * rudder, 0.0) << rudder;
    EXPECT_NEAR(std::abs(rate_rad_s) / kRadPerDeg, 7.2, 1.5) << rudder;
    const std::string name = "rudder_" + std::to_string(rudder).substr(0, 5);
    record(name + "_rate_deg_s", rate_rad_s / kRadPerDeg);
    record(name + "_speed_m_s", speed);
    record(name + "_radius_m", speed / std::abs(rate_rad_s));
    record(name + "_drift_deg", std::atan2(-after.nu[1], after.nu[0]) / kRadPerDeg);
    record(name + "_roll_deg", after.rpy_deg(0));
    record(name + "_pitch_deg", after.rpy_deg(1));
  }
}

// With these coefficients the hull is unstable in pitch and yaw: N_uv and M_uw turn it away from the flow
// more than the fins hold it. Fins that are merely held do not hold the vehicle.
TEST(RemusManoeuvres, HeldFinsDoNotHoldTheVehicle) {
  const auto c = hydro::remus100();
  EXPECT_LT(c.Y_uv * c.N_ur - c.N_uv * (c.Y_ur - c.mass()), 0.0);
  EXPECT_LT(c.Z_uw * c.M_uq - c.M_uw * (c.Z_uq + c.mass()), 0.0);
  EXPECT_LT(run(0.0, 0.0, 10.0).rpy_deg(1), -15.0);
}

TEST(RemusManoeuvres, DepthStep) {
  for (const double stern : {-4.0, 0.0, 4.0}) {
    const std::string name = "stern_" + std::to_string(stern).substr(0, 4);
    for (const double t : {2.0, 5.0, 10.0}) {
      const Motion m = run(0.0, stern, t);
      record(name + "_" + std::to_string(static_cast<int>(t)) + "s_pitch_deg", m.rpy_deg(1));
      record(name + "_" + std::to_string(static_cast<int>(t)) + "s_depth_m", m.position_N_m.z());
    }
    if (stern == 0.0) continue;
    // Positive stern planes pitch the nose down (M_uuds < 0), against what it does with planes amidships.
    EXPECT_LT((run(0.0, stern, 2.0).rpy_deg(1) - run(0.0, 0.0, 2.0).rpy_deg(1)) * stern, -10.0);
  }
}

}  // namespace
}  // namespace fathom::study
