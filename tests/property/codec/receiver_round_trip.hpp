#pragma once

// What the round-trip tests of satellite receivers share.

#include <cmath>
#include <numbers>

#include "round_trip.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::test {

class ReceiverRoundTrip : public RoundTrip {
 protected:
  static constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  static constexpr double kSingle = 6e-8;  // of a number of single precision, relative

  GpsSample draw_fix(GpsFix fix, int satellites) {
    GpsSample s;
    s.fix = fix;
    s.satellites = static_cast<decltype(s.satellites)>(satellites);
    if (fix == GpsFix::none) return s;
    s.latitude_rad = draw(-1.57, 1.57);
    s.longitude_rad = draw(-3.14, 3.14);
    s.altitude_m = draw(-100.0, 9'000.0);
    s.altitude_msl_m = s.altitude_m - draw(-100.0, 80.0);
    s.position_sigma_N_m = {draw(0.01, 30.0), draw(0.01, 30.0), draw(0.01, 60.0)};
    if (chance(0.8)) {
      s.velocity_N_m_s = draw3(60.0);
      s.velocity_sigma_N_m_s = {draw(0.01, 3.0), draw(0.01, 3.0), draw(0.01, 3.0)};
      s.course_rad = draw(0.0, kTurn_rad);
    }
    return s;
  }

  /// Of two antennas; one in five is unknown.
  HeadingSample draw_heading(int run) {
    HeadingSample s;
    if (run % 5 != 0) s.heading_rad = draw(0.0, kTurn_rad);
    if (known(s.heading_rad) && chance(0.7)) s.sigma_rad = draw(0.0005, 3.0);
    return s;
  }
  /// The same heading, now and then of magnetic north with its variation.
  HeadingSample of_either_north(HeadingSample s) {
    if (!chance(0.3)) return s;
    s.north = North::magnetic;
    s.variation_rad = draw(-0.4, 0.4);
    s.heading_rad -= s.variation_rad;
    return s;
  }
  static void expect_same_heading(const HeadingSample& sent, const HeadingSample& got, double within_rad,
                                  double sigma_within) {
    EXPECT_EQ(got.north, North::true_north);
    ASSERT_EQ(known(got.heading_rad), known(sent.heading_rad));
    ASSERT_EQ(known(got.sigma_rad), known(sent.sigma_rad));
    if (!known(sent.heading_rad)) return;
    EXPECT_GE(got.heading_rad, 0.0);
    EXPECT_LT(got.heading_rad, kTurn_rad);
    EXPECT_NEAR(std::remainder(got.heading_rad - sent.heading_rad, kTurn_rad), 0.0, within_rad);
    if (known(sent.sigma_rad)) {
      EXPECT_NEAR(got.sigma_rad, sent.sigma_rad, sigma_within);
    }
  }
};

}  // namespace fathom::test
