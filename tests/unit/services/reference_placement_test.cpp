#include "cli/solve/reference_placement.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace fathom::cli {
namespace {

NavState moving(double speed_m_s, double heading_rad) {
  NavState state;
  state.velocity_N_m_s = {speed_m_s * std::cos(heading_rad), speed_m_s * std::sin(heading_rad), 0.0};
  state.rpy_rad = {0.0, 0.0, heading_rad};
  state.position_covariance_N_m2 = {0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.04};
  return state;
}

/// A clock that is 30 ms early and a point 0.4 m ahead and 0.2 m to the left, with white errors of 0.1 m.
ReferencePlacement drive(bool changes_speed, bool turns, double north_m = 0.0) {
  sim::Random random(1, "placement");
  ReferencePlacement out;
  for (int i = 0; i < 4000; ++i) {
    const double speed_m_s = changes_speed ? 8.0 + 6.0 * std::sin(0.01 * i) : 8.0;
    const double heading_rad = turns ? 0.003 * i : 1.0;
    const NavState state = moving(speed_m_s, heading_rad);
    const double c = std::cos(heading_rad);
    const double s = std::sin(heading_rad);
    dataset::NavError error;
    error.position_N_m[0] =
        north_m + -0.03 * state.velocity_N_m_s[0] + 0.4 * c + 0.2 * s + 0.1 * random.normal();
    error.position_N_m[1] = -0.03 * state.velocity_N_m_s[1] + 0.4 * s - 0.2 * c + 0.1 * random.normal();
    out.add(state, error);
  }
  return out;
}

TEST(ReferencePlacement, FindsClockAndPointAndWhatIsLeft) {
  const Placement found = drive(true, true).figures();
  EXPECT_NEAR(found.reference_late_s, -0.03, 0.002);
  EXPECT_NEAR(found.offset_B_m[0], 0.4, 0.02);
  EXPECT_NEAR(found.offset_B_m[1], -0.2, 0.02);
  EXPECT_NEAR(found.rms_m, 0.1 * std::sqrt(2.0), 0.005);
  EXPECT_NEAR(found.nees_horizontal, 2.0, 0.1);
}

TEST(ReferencePlacement, LeavesAConstantErrorWhereItIs) {
  const Placement found = drive(true, true, 3.0).figures();
  EXPECT_NEAR(found.offset_B_m[0], 0.4, 0.02);
  EXPECT_NEAR(found.rms_m, 3.0, 0.05);
  // On one heading it cannot be told from a point elsewhere.
  EXPECT_FALSE(known(drive(true, false, 3.0).figures().reference_late_s));
}

TEST(ReferencePlacement, DoesNotTellClockFromPointAtOneSpeed) {
  EXPECT_FALSE(known(drive(false, true).figures().reference_late_s));
  EXPECT_FALSE(known(drive(false, false).figures().reference_late_s));
}

}  // namespace
}  // namespace fathom::cli
