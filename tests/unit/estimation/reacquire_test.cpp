#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

/// Velocity east after 15 s at rest with a DVL alone, when navigation was started with 1 m/s east and sure of
/// it.
double wrong_velocity_left(GateMode mode, double probability) {
  const SurveyRun run({.duration_s = 15.0, .wave_rad = 0.0});
  EngineConfig config = SurveyRun::config();
  config.groups = StateGroups{};
  SensorConfig dvl = config.sensors[1];
  dvl.gate_mode = mode;
  dvl.gate_probability = probability;
  dvl.robust = RobustKind::none;
  dvl.reacquire_s = 5.0;
  config.sensors = {dvl};
  config.alignment.mode = StartMode::given;
  FusionEngine engine(config);
  const Truth& truth = run.truth.front();
  InitialState start;
  start.latitude_rad = truth.latitude_rad;
  start.longitude_rad = truth.longitude_rad;
  start.altitude_m = truth.altitude_m;
  start.rpy_rad = truth.rpy_rad;
  start.velocity_N_m_s = {0.0, 1.0, 0.0};
  start.velocity_sigma_N_m_s = {0.01, 0.01, 0.01};
  start.attitude_sigma_rad = {1e-4, 1e-4, 1e-3};
  engine.start_from(start);
  for (const auto& sample : run.samples) test::feed(engine, sample);
  return engine.nav_state().velocity_N_m_s[1];
}

TEST(Reacquire, OneRowThatIsRefusedForeverIsBelievedThoughTheOthersPass) {
  EXPECT_NEAR(wrong_velocity_left(GateMode::per_component, 0.999), 0.0, 0.05);
}

TEST(Reacquire, NoGateIsTooTight) {
  EXPECT_NEAR(wrong_velocity_left(GateMode::whole, 0.5), 0.0, 0.05);
  EXPECT_NEAR(wrong_velocity_left(GateMode::per_component, 0.5), 0.0, 0.05);
}

TEST(Reacquire, OneAxisOfAFixThatIsRefusedForeverIsBelievedThoughTheOthersPass) {
  // Somebody ordered the vehicle 200 m east and was sure of it.
  for (const GateMode mode : {GateMode::whole, GateMode::per_component}) {
    const SurveyRun run({.duration_s = 70.0, .dive_s = 1e9});
    EngineConfig config = SurveyRun::config();
    config.sensors[0].gate_mode = mode;
    FusionEngine engine(config);
    bool ordered = false;
    for (const test::Sample& sample : run.samples) {
      test::feed(engine, sample);
      if (ordered || test::header(sample).stamp_ns < SurveyRun::kEpochNs + 30 * kNsPerSecond) continue;
      Command command;
      command.kind = CommandKind::set_position;
      command.latitude_rad = engine.nav_state().latitude_rad;
      command.longitude_rad =
          engine.nav_state().longitude_rad + 200.0 / (6.38e6 * std::cos(command.latitude_rad));
      command.sigma_m = 1.0;
      ordered = test::order_twice(engine, command).empty();
    }
    ASSERT_TRUE(ordered);
    const Truth& truth = run.truth.back();
    const NavState& nav = engine.nav_state();
    const Eigen::Vector3d error =
        geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                          {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    EXPECT_LT(error.head<2>().norm(), 5.0) << static_cast<int>(mode);
  }
}

TEST(Reacquire, NobodyNavigatesByAFixOfWhichOnlyTheHeightIsUsed) {
  const SurveyRun run({.duration_s = 34.0, .dive_s = 1e9});
  EngineConfig config = SurveyRun::config();
  config.sensors[0].gate_mode = GateMode::per_component;
  FusionEngine engine(config);
  bool ordered = false;
  double outage_s = 0.0;
  for (const test::Sample& sample : run.samples) {
    test::feed(engine, sample);
    outage_s = std::max(outage_s, engine.nav_state().gps_outage_s);
    if (ordered || test::header(sample).stamp_ns < SurveyRun::kEpochNs + 30 * kNsPerSecond) continue;
    EXPECT_LT(outage_s, 1.0);
    Command command;
    command.kind = CommandKind::set_position;
    command.latitude_rad = engine.nav_state().latitude_rad + 200.0 / 6.37e6;
    command.longitude_rad =
        engine.nav_state().longitude_rad + 200.0 / (6.38e6 * std::cos(command.latitude_rad));
    command.sigma_m = 1.0;
    ordered = test::order_twice(engine, command).empty();
  }
  ASSERT_TRUE(ordered);
  EXPECT_GT(outage_s, 3.0);
}

/// 460 s under water, then 20 s of fixes that all lie 700 m to the side and go along with the vehicle, then
/// true ones.
class LyingFixes {
 public:
  static constexpr double kDive_s = 60.0;
  static constexpr double kCluster_s = kDive_s + 460.0;
  static constexpr double kTrue_s = kCluster_s + 20.0;
  static constexpr double kEnd_s = kTrue_s + 45.0;
  static constexpr double kAway_m = 700.0;

  enum class Fixes { all, only_before };
  struct Result {
    double worst_m = 0.0;            ///< from the first wrong fix on
    double at_cluster_m = 0.0;       ///< when that came
    double recovered_after_s = 1e9;  ///< from the first true fix until the error stays below 10 m
    double largest_step_m = 0.0;     ///< published
    std::uint32_t resets = 0;
    double sum_of_steps_m = 0.0;
  };

  explicit LyingFixes(bool with_dvl) : with_dvl_(with_dvl), run_(options()) {}

  [[nodiscard]] Result navigate(Fixes fixes) const {
    EngineConfig config = SurveyRun::config();
    config.sensors[0].sigma = {1.0, 1.0, 2.0};
    FusionEngine engine(config);
    Result out;
    std::size_t row = 0;
    std::uint32_t resets = 0;
    for (const test::Sample& sample : run_.samples) {
      if (std::holds_alternative<DvlSample>(sample) && !with_dvl_ && seconds(sample) > kDive_s) continue;
      if (const auto* gps = std::get_if<GpsSample>(&sample)) {
        const double t = seconds(sample);
        if (t > kDive_s && (fixes == Fixes::only_before || t < kCluster_s)) continue;
        GpsSample told = *gps;
        if (t >= kCluster_s && t < kTrue_s)
          told.longitude_rad += kAway_m / (6.38e6 * std::cos(told.latitude_rad));
        engine.add(told);
        continue;
      }
      test::feed(engine, sample);
      if (!std::holds_alternative<ImuSample>(sample)) continue;
      const Truth& truth = run_.truth[row++];
      const double t = seconds(sample);
      if (t < kCluster_s) continue;
      const NavState& nav = engine.nav_state();
      const Eigen::Vector3d error =
          geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                            {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
      const double size = error.head<2>().norm();
      if (out.worst_m == 0.0) {
        out.at_cluster_m = size;
        resets = nav.reset_counter;
      }
      out.worst_m = std::max(out.worst_m, size);
      if (size > 10.0) out.recovered_after_s = 1e9;
      if (size <= 10.0 && out.recovered_after_s > 1e8) out.recovered_after_s = std::max(0.0, t - kTrue_s);
      if (nav.reset_counter != resets + out.resets) {
        out.resets = nav.reset_counter - resets;
        const double step = std::hypot(nav.last_reset_delta_N_m[0], nav.last_reset_delta_N_m[1]);
        out.largest_step_m = std::max(out.largest_step_m, step);
        out.sum_of_steps_m += step;
      }
    }
    return out;
  }

 private:
  static SurveyRun::Options options() {
    SurveyRun::Options o;
    o.duration_s = kEnd_s;
    o.dive_s = 1e9;  // it stays at the surface: what GPS says is up to navigate()
    o.wave_rad = 0.0;
    o.usbl = false;
    return o;
  }
  static double seconds(const test::Sample& sample) {
    return to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
  }

  bool with_dvl_;
  SurveyRun run_;
};

void expect_not_captured(bool with_dvl) {
  const LyingFixes scenario(with_dvl);
  const LyingFixes::Result drift = scenario.navigate(LyingFixes::Fixes::only_before);
  const LyingFixes::Result got = scenario.navigate(LyingFixes::Fixes::all);
  EXPECT_LE(got.worst_m, 1.1 * drift.worst_m);
  EXPECT_LE(got.recovered_after_s, 30.0);
  EXPECT_NEAR(got.at_cluster_m, drift.at_cluster_m, 1e-6);
  EXPECT_LE(got.largest_step_m, 101.0);
  // What was corrected was published.
  if (got.at_cluster_m > 60.0) {
    EXPECT_GT(got.resets, 0U);
    EXPECT_GT(got.sum_of_steps_m, 0.8 * got.at_cluster_m);
  }
}

TEST(Reacquire, ACoherentClusterDoesNotCaptureAnInertialNavigatorAndTrueFixesAreBelieved) {
  expect_not_captured(false);
}

TEST(Reacquire, ACoherentClusterDoesNotCaptureADeadReckoningNavigatorAndTrueFixesAreBelieved) {
  expect_not_captured(true);
}

}  // namespace
}  // namespace fathom::estimation
