// A start that neither GPS nor acoustics place: where the vehicle was seen last, or where it was told to be.
#include <cmath>

#include <gtest/gtest.h>

#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::SurveyRun;

/// Instants without a sample of the inertial unit, and until which GPS and compass are heard at all.
struct Heard {
  double silent_from_s = 1e9;
  double silent_s = 0.0;
  double gps_until_s = 1e9;
  double compass_from_s = 0.0;
};

/// An engine that is told of one run, and how it ends.
class Told {
 public:
  Told(const SurveyRun& run, const EngineConfig& config, const Heard& heard)
      : run_(run), engine_(config), heard_(heard) {}

  void go_on(double until_s) {
    for (; next_ < run_.samples.size(); ++next_) {
      const test::Sample& sample = run_.samples[next_];
      const double t = to_seconds(test::header(sample).received_ns - SurveyRun::kEpochNs);
      if (t > until_s) return;
      const bool silent = t > heard_.silent_from_s && t < heard_.silent_from_s + heard_.silent_s;
      if (silent && std::holds_alternative<ImuSample>(sample)) continue;
      if (t > heard_.gps_until_s && std::holds_alternative<GpsSample>(sample)) continue;
      if (t < heard_.compass_from_s && std::holds_alternative<HeadingSample>(sample)) continue;
      test::feed(engine_, sample);
      if (std::holds_alternative<ImuSample>(sample))
        truth_ = run_.truth[static_cast<std::size_t>(std::lround(100.0 * (t - 0.002)))];
      if (!known(started_s_) && navigates()) {
        started_s_ = t;
        start_ = engine_.nav_state();
      }
    }
  }
  void await_another_start() { started_s_ = kUnknown; }
  void order_true_position(double sigma_m) {
    Command command;
    command.kind = CommandKind::set_position;
    command.latitude_rad = truth_.latitude_rad;
    command.longitude_rad = truth_.longitude_rad;
    command.sigma_m = sigma_m;
    ASSERT_EQ(test::order_now(engine_, command), "");
  }

  [[nodiscard]] FusionEngine& engine() { return engine_; }
  [[nodiscard]] bool navigates() const { return known(engine_.nav_state().latitude_rad); }
  [[nodiscard]] double started_s() const { return started_s_; }
  /// As it started.
  [[nodiscard]] double start_sigma_m() const { return std::sqrt(start_.position_covariance_N_m2[0]); }
  [[nodiscard]] Vector3d error_N_m() const {
    const NavState& nav = engine_.nav_state();
    return geo::difference_N({truth_.latitude_rad, truth_.longitude_rad, truth_.altitude_m},
                             {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  }
  [[nodiscard]] Vector3d sigma_N_m() const {
    const auto& p = engine_.nav_state().position_covariance_N_m2;
    return {std::sqrt(p[0]), std::sqrt(p[4]), std::sqrt(p[8])};
  }
  [[nodiscard]] double yaw_error_rad() const {
    return geo::wrap_pi(engine_.nav_state().rpy_rad[2] - truth_.rpy_rad[2]);
  }

 private:
  const SurveyRun& run_;
  FusionEngine engine_;
  Heard heard_;
  std::size_t next_ = 0;
  Truth truth_;
  double started_s_ = kUnknown;
  NavState start_;
};

/// The quay that it was configured for lies 600 m from where it is.
EngineConfig begins_at_the_quay() {
  EngineConfig c = SurveyRun::config();
  c.alignment.position_given = true;
  c.alignment.given_latitude_rad = 0.6353 + 600.0 / 6.37e6;
  c.alignment.given_longitude_rad = 2.2235;
  c.alignment.given_altitude_m = SurveyRun::kSurfaceAltitude_m;
  return c;
}

/// Dives at 50 s, hears nothing of its inertial unit from 80 s on.
void expect_goes_on(const EngineConfig& config, double silent_s, std::uint64_t seed) {
  SCOPED_TRACE(::testing::Message() << silent_s << " s, seed " << seed);
  const SurveyRun run({.duration_s = 170.0, .dive_s = 50.0, .seed = seed, .usbl = false});
  Told told(run, config, {.silent_from_s = 80.0, .silent_s = silent_s});
  told.go_on(79.0);
  ASSERT_TRUE(told.navigates());
  EXPECT_LT(told.error_N_m().head<2>().norm(), 5.0);
  told.go_on(80.0 + silent_s + 0.5);
  ASSERT_FALSE(told.navigates());
  told.await_another_start();
  told.go_on(170.0);
  ASSERT_TRUE(told.navigates());
  EXPECT_LT(told.started_s(), 80.0 + silent_s + 15.0);
  const Vector3d error = told.error_N_m();
  const Vector3d sigma = told.sigma_N_m();
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(error(i)), 3.5 * sigma(i)) << i;
  // It goes 1.8 m/s, and no further than that in that time.
  EXPECT_LT(sigma.head<2>().maxCoeff(), 3.0 * (silent_s + 15.0));
  EXPECT_GT(sigma.head<2>().minCoeff(), 1.0 * silent_s);
  EXPECT_LT(sigma.z(), 3.0) << "the surface is as well known as it was";
  EXPECT_LT(std::abs(told.yaw_error_rad()), 4.0 * told.engine().nav_state().rpy_sigma_rad[2]);
  EXPECT_LT(told.engine().nav_state().rpy_sigma_rad[2], 0.05);
}

TEST(LastPlace, AVehicleThatWasOutOfSightStartsWhereItWasSeenLast) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_goes_on(begins_at_the_quay(), 20.0, seed);
    expect_goes_on(SurveyRun::config(), 60.0, seed);
  }
}

TEST(LastPlace, AHeadingThatWasGivenIsThatOfTheFirstStart) {
  EngineConfig config = begins_at_the_quay();
  config.alignment.heading_source = HeadingSource::given;
  config.alignment.given_heading_rad = 1.1;
  config.alignment.given_heading_sigma_rad = 0.02;
  expect_goes_on(config, 20.0, 1);
}

TEST(LastPlace, AVehicleThatBeganFromAGivenStateBeginsAnewByItself) {
  const SurveyRun run({.duration_s = 170.0, .dive_s = 50.0, .usbl = false});
  EngineConfig config = SurveyRun::config();
  config.alignment.mode = StartMode::given;
  Told told(run, config, {.silent_from_s = 80.0, .silent_s = 20.0});
  InitialState state;
  state.latitude_rad = run.truth[0].latitude_rad;
  state.longitude_rad = run.truth[0].longitude_rad;
  state.altitude_m = run.truth[0].altitude_m;
  state.velocity_N_m_s = run.truth[0].velocity_N_m_s;
  state.rpy_rad = run.truth[0].rpy_rad;
  told.engine().start_from(state);
  told.go_on(79.0);
  ASSERT_TRUE(told.navigates());
  told.go_on(101.0);
  ASSERT_FALSE(told.navigates());
  told.go_on(170.0);
  ASSERT_TRUE(told.navigates());
  EXPECT_LT(told.error_N_m().head<2>().norm(), 3.5 * told.sigma_N_m().head<2>().norm());
}

TEST(LastPlace, AVehicleThatLostGpsBeforeItWasAlignedStartsByItsLastFix) {
  const SurveyRun run({.duration_s = 40.0, .usbl = false});
  Told told(run, begins_at_the_quay(), {.gps_until_s = 9.0, .compass_from_s = 17.0});
  told.go_on(16.9);
  ASSERT_FALSE(told.navigates());
  told.go_on(40.0);
  ASSERT_TRUE(told.navigates());
  EXPECT_GT(told.started_s(), 17.0);
  EXPECT_LT(told.error_N_m().head<2>().norm(), 3.5 * told.sigma_N_m().head<2>().norm());
  EXPECT_LT(told.sigma_N_m().head<2>().norm(), 20.0);
}

TEST(LastPlace, AnOrderGrowsOldUntilTheStart) {
  const SurveyRun run({.duration_s = 19.0});
  const auto sigma_m = [&](double compass_from_s) {
    Told told(run, SurveyRun::config(), {.gps_until_s = 0.0, .compass_from_s = compass_from_s});
    told.go_on(2.0);
    told.order_true_position(2.0);
    told.go_on(19.0);
    EXPECT_GT(told.started_s(), compass_from_s);
    return told.start_sigma_m();
  };
  EXPECT_NEAR(sigma_m(0.0), std::hypot(2.0, 0.7 * 6.0), 0.5);
  EXPECT_NEAR(sigma_m(16.0), std::hypot(2.0, 0.7 * 14.0), 0.5);
}

TEST(LastPlace, AnOrderUnderWaterBeginsAtTheDepthThatIsMeasured) {
  const SurveyRun run({.duration_s = 130.0, .dive_s = 40.0, .usbl = false});
  EngineConfig config = SurveyRun::config();
  config.states.surface_altitude_m = SurveyRun::kSurfaceAltitude_m;
  config.states.surface_altitude_sigma_m = 0.5;
  Told told(run, config, {.gps_until_s = 0.0, .compass_from_s = 80.0});
  told.go_on(79.0);
  ASSERT_FALSE(told.navigates());
  told.order_true_position(2.0);
  told.go_on(130.0);
  ASSERT_TRUE(told.navigates());
  const Vector3d error = told.error_N_m();
  const Vector3d sigma = told.sigma_N_m();
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(error(i)), 3.5 * sigma(i)) << i;
  EXPECT_LT(sigma.z(), 1.0);
}

TEST(LastPlace, TheLeverIsThatOfTheReceiverThatWasHeard) {
  const SurveyRun run({.duration_s = 14.0});
  EngineConfig config = SurveyRun::config();
  SensorConfig spare = default_sensor(SourceKind::gps, "spare");
  spare.lever_B_m = {40.0, 0.0, 0.0};
  config.sensors.insert(config.sensors.begin(), spare);
  Told told(run, config, {});
  told.go_on(14.0);
  ASSERT_TRUE(told.navigates());
  EXPECT_LT(told.error_N_m().head<2>().norm(), 4.0);
}

}  // namespace
}  // namespace fathom::estimation
