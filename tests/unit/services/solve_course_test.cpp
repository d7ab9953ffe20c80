#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "cli/solve/course.hpp"

namespace fathom::cli {
namespace {

class HeadingWatchTest : public ::testing::Test {
 protected:
  HeadingWatchTest() {
    estimation::SensorConfig receiver = estimation::default_sensor(SourceKind::gps, "gps0");
    receiver.velocity_sigma_m_s = {0.1, 0.1, 0.1};
    receiver.latency_s = 0.2;
    config.engine.sensors = {receiver};
  }
  static TimeNs at(double t_s) { return from_seconds(1000.0 + t_s); }
  /// A fix of each second of `courses_deg`, at 10 m/s.
  void drive(const std::vector<double>& courses_deg, double speed_m_s = 10.0) {
    for (const double course : courses_deg) {
      GpsSample& fix = gps.emplace_back();
      fix.header.stamp_ns = at(static_cast<double>(gps.size()) - 1.0);
      fix.fix = GpsFix::fix_3d;
      fix.velocity_N_m_s = {speed_m_s * std::cos(course * kRadPerDeg),
                            speed_m_s * std::sin(course * kRadPerDeg), 0.0};
    }
  }
  static NavState state(double t_s, double yaw_deg, double sigma_deg, bool aligned = true) {
    NavState out;
    out.header.stamp_ns = at(t_s);
    out.latitude_rad = 0.7;
    out.rpy_rad = {0.0, 0.0, yaw_deg * kRadPerDeg};
    out.rpy_sigma_rad = {0.01, 0.01, sigma_deg * kRadPerDeg};
    out.alignment = aligned ? AlignmentPhase::aligned : AlignmentPhase::fine;
    return out;
  }

  config::FusionConfig config;
  std::vector<GpsSample> gps;
};

TEST_F(HeadingWatchTest, ComparesOnStraightsAtTheInstantOfTheFix) {
  drive({0, 0, 0, 10, 20, 20.5, 21});
  HeadingWatch watch(config, gps);
  // Straight before and after are the fixes at 1 s and 5 s; the receiver is 0.2 s late.
  EXPECT_FALSE(watch.wants_detail(state(0.79, 0.0, 1.0)));
  EXPECT_TRUE(watch.wants_detail(state(0.8, 0.0, 1.0)));
  for (int i = 0; i <= 70; ++i) watch.add(state(0.1 * i, i < 30 ? 2.0 : 20.5, 0.5, i >= 30), NavDetail{});
  const HeadingFigures& figures = watch.figures();
  EXPECT_EQ(figures.course.count(), 2U);
  EXPECT_EQ(figures.course_aligned.count(), 1U);
  EXPECT_NEAR(figures.course.worst_own(), 4.0, 1e-9);
  EXPECT_EQ(figures.course.beyond_own(), 1U);
  // With 0.57 degrees of course noise the same 2 degrees are no lie.
  EXPECT_NEAR(figures.course.worst(), 2.0 / std::hypot(0.5, 0.01 / kRadPerDeg), 1e-9);
  EXPECT_EQ(figures.course.beyond(), 0U);
  EXPECT_NEAR(figures.course.mean_rad(), 1.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(figures.aligned_after_s, 3.0, 1e-6);
  EXPECT_FALSE(figures.through_medium);
}

TEST_F(HeadingWatchTest, AnAircraftThatCrabsIsComparedThroughTheAir) {
  estimation::SensorConfig air = estimation::default_sensor(SourceKind::airspeed, "air0");
  air.sideslip_sigma_rad = 2.0 * kRadPerDeg;
  config.engine.sensors.push_back(air);
  drive({0, 0, 0});
  HeadingWatch watch(config, gps);
  NavDetail detail;
  detail.count = 3;
  detail.states[0] = {Name("current_north_m_s"), 0.0, 0.3};
  detail.states[1] = {Name("current_east_m_s"), 10.0, 0.4};
  detail.states[2] = {Name("sideslip_rad"), 1.0 * kRadPerDeg, 1.0 * kRadPerDeg};
  // North over ground in a wind from the west: the nose is 45 degrees to the left of the course, less the
  // sideslip.
  watch.add(state(0.8, -46.0 + 3.0, 1.0), detail);
  const HeadingFigures& figures = watch.figures();
  ASSERT_EQ(figures.course.count(), 1U);
  EXPECT_TRUE(figures.through_medium);
  EXPECT_NEAR(figures.course.mean_rad(), 3.0 * kRadPerDeg, 1e-9);
  const double others = std::hypot(0.1, 0.4) / std::hypot(10.0, 10.0) / kRadPerDeg;
  EXPECT_NEAR(figures.course.worst(), 3.0 / std::sqrt(1.0 + 1.0 + 4.0 + others * others), 1e-9);
}

TEST_F(HeadingWatchTest, SlowFixesAndStatesThatComeLateSayNothing) {
  drive({0, 0, 0}, 4.0);
  HeadingWatch slow(config, gps);
  slow.add(state(0.8, 50.0, 1.0), NavDetail{});
  EXPECT_EQ(slow.figures().course.count(), 0U);
  gps.clear();
  drive({0, 0, 0});
  HeadingWatch late(config, gps);
  late.add(state(1.5, 50.0, 1.0), NavDetail{});
  EXPECT_EQ(late.figures().course.count(), 0U);
}

TEST_F(HeadingWatchTest, TheReferenceIsComparedTheShorterWayRound) {
  HeadingErrors errors;
  Truth truth;
  truth.rpy_rad = {0.0, 0.0, -179.0 * kRadPerDeg};
  add_heading(state(0.0, 179.0, 1.0), truth, errors);
  truth.rpy_rad[2] = kUnknown;
  add_heading(state(0.1, 0.0, 1.0), truth, errors);
  EXPECT_EQ(errors.count(), 1U);
  EXPECT_NEAR(errors.worst(), 2.0, 1e-9);
  EXPECT_NEAR(errors.rms_rad(), 2.0 * kRadPerDeg, 1e-12);
}

}  // namespace
}  // namespace fathom::cli
