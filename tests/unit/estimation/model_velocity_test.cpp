#include <map>
#include <string>

#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "estimation/hydro/water_velocity.hpp"
#include "support/vehicles/small_vehicle.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using hydro::Controls;
using hydro::Vector6;
using test::SurveyRun;

TEST(WaterVelocity, FollowsTheWholeVehicleFromItsTurning) {
  // Six degrees of freedom with rudder and stern planes; the three of the virtual log are told the rates of
  // turn.
  const hydro::VehicleModel vehicle(test::small_vehicle());
  const hydro::VelocityModel model(test::small_vehicle());
  Vector6 nu = Vector6::Zero();
  nu[0] = 1.5;
  hydro::WaterVelocity water;
  water.begin(nu.head<3>());
  water.set_rpm(1200.0);
  const double dt = 0.01;
  Vector3d omega = Vector3d::Zero();
  double swing = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const double t = i * dt;
    const Controls controls{1200.0, 0.1 * std::sin(0.3 * t), 0.05 * std::sin(0.5 * t)};
    water.set_fins(controls.rudder_rad, controls.stern_rad);
    const Vector3d gamma = Vector3d(0.05 * std::sin(0.2 * t), 0.02, 1.0).normalized();
    const Vector6 after = vehicle.step(nu, gamma, controls, dt);
    // A gyro tells the mean over the interval.
    omega = 0.5 * (nu.tail<3>() + after.tail<3>());
    nu = after;
    water.advance(model, omega, gamma, dt);
    swing = std::max(swing, std::abs(nu[1]));
    ASSERT_LT((water.V_B_m_s() - nu.head<3>()).norm(), 2e-3) << t;
  }
  EXPECT_GT(swing, 0.02);
}

TEST(WaterVelocity, ALongStepIsTakenInParts) {
  const hydro::VelocityModel model(test::small_vehicle());
  hydro::WaterVelocity whole;
  hydro::WaterVelocity parts;
  for (hydro::WaterVelocity* one : {&whole, &parts}) {
    one->begin({0.5, 0.2, -0.1});
    one->set_rpm(1200.0);
  }
  whole.advance(model, Vector3d::Zero(), Vector3d::UnitZ(), 5.0);
  for (int i = 0; i < 500; ++i) parts.advance(model, Vector3d::Zero(), Vector3d::UnitZ(), 0.01);
  EXPECT_LT((whole.V_B_m_s() - parts.V_B_m_s()).norm(), 1e-3);
}

TEST(WaterVelocity, DoubtIsTheMeanOfWhatWasCompared) {
  const hydro::VelocityModel model(test::small_vehicle());
  hydro::WaterVelocity water;
  const auto second = [&](double normalised) {
    water.advance(model, Vector3d::Zero(), Vector3d::UnitZ(), 1.0);
    water.compare(normalised, 60.0);
  };
  EXPECT_EQ(water.model_nis(), 1.0);
  for (int i = 0; i < 20; ++i) second(4.0);
  EXPECT_NEAR(water.compared_s(), 20.0, 1e-9);
  EXPECT_NEAR(water.model_nis(), 4.0, 1e-9);
  for (int i = 0; i < 600; ++i) second(0.1);
  EXPECT_EQ(water.model_nis(), 1.0);  // never better than configured
}

/// The survey of survey_run.hpp with shaft speed and fins, and a DVL that falls silent.
struct ModelRun {
  static constexpr double kLost_s = 95.0;

  /// `thrust` times the truth is what the model believes; `late_s` holds shaft speed and fins back.
  static NavState run(const SurveyRun& survey, double thrust, double late_s, bool with_model,
                      std::vector<Verdict>* verdicts = nullptr, NavDetail* detail = nullptr,
                      double log_scale = 0.0) {
    EngineConfig config = SurveyRun::config();
    config.sensors.push_back(default_sensor(SourceKind::propulsion, "shaft"));
    config.sensors.back().scale_m_s_per_rpm = log_scale;
    config.sensors.push_back(default_sensor(SourceKind::fins, "fins"));
    if (with_model) {
      config.groups.model_scale = config.groups.model_bias = true;
      config.vehicle_model.enabled = true;
      // The survey's vehicle runs along its own axis: one that does not slip in a turn.
      auto& coefficients = config.vehicle_model.coefficients;
      coefficients = test::small_vehicle();
      coefficients.Y_ur = coefficients.mass();
      coefficients.Z_uq = -coefficients.mass();
      coefficients.X_prop *= thrust;
      config.vehicle_model.min_depth_m = 0.0;
    }
    FusionEngine engine(config);
    std::vector<std::pair<TimeNs, TimeNs>> held;  // arrival, stamp
    std::uint64_t sequence = 0;
    Verdict verdict;
    const auto say = [&](TimeNs stamp) {
      PropulsionSample shaft;
      shaft.header.sensor = "shaft";
      shaft.header.stamp_ns = stamp;
      shaft.header.sequence = ++sequence;
      // The survey's speed of 1.8 m/s as the small vehicle makes it: 2 m/s at 1200 rpm.
      const double t = to_seconds(stamp - SurveyRun::kEpochNs);
      shaft.rpm = t > 21.0 ? 1080.0 : 0.0;
      engine.add(shaft);
      FinsSample fins;
      fins.header = shaft.header;
      fins.header.sensor = "fins";
      fins.rudder_rad = fins.stern_rad = 0.0;
      engine.add(fins);
    };
    for (const test::Sample& sample : survey.samples) {
      const SampleHeader& header = test::header(sample);
      const double t = to_seconds(header.stamp_ns - SurveyRun::kEpochNs);
      const bool lost = std::holds_alternative<DvlSample>(sample) && t > kLost_s;
      if (!lost) test::feed(engine, sample);
      if (std::holds_alternative<ImuSample>(sample)) {
        // Nothing in the last two seconds: late or not, all has arrived in the end.
        const bool told = header.stamp_ns < survey.truth.back().header.stamp_ns - from_seconds(2.0);
        if (told && header.stamp_ns / 10'000'000 % 20 == 7)
          held.emplace_back(header.stamp_ns + from_seconds(late_s), header.stamp_ns);
        while (!held.empty() && held.front().first <= header.stamp_ns) {
          say(held.front().second);
          held.erase(held.begin());
        }
      }
      while (engine.next_verdict(verdict))
        if (verdicts != nullptr && is_news(verdict)) verdicts->push_back(verdict);
    }
    if (detail != nullptr) engine.fill(*detail);
    return engine.nav_state();
  }
};

TEST(ModelVelocity, LateShaftSpeedChangesNoBit) {
  const SurveyRun survey({.duration_s = 70.0, .usbl = false});
  NavDetail expected;
  NavDetail late;
  const NavState a = ModelRun::run(survey, 1.0, 0.0, true, nullptr, &expected);
  const NavState b = ModelRun::run(survey, 1.0, 1.3, true, nullptr, &late);
  EXPECT_EQ(a.latitude_rad, b.latitude_rad);
  EXPECT_EQ(a.longitude_rad, b.longitude_rad);
  ASSERT_EQ(expected.count, late.count);
  for (std::uint32_t i = 0; i < late.count; ++i)
    EXPECT_EQ(expected.states[i].value, late.states[i].value) << i;
}

TEST(ModelVelocity, HoldsTheVelocityWhenTheDvlIsLost) {
  const SurveyRun survey({.duration_s = 180.0, .usbl = false});
  std::vector<Verdict> verdicts;
  const NavState with = ModelRun::run(survey, 1.0, 0.0, true, &verdicts);
  const NavState without = ModelRun::run(survey, 1.0, 0.0, false);
  const Truth& truth = survey.truth.back();
  const auto error = [&](const NavState& nav) {
    return geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                             {nav.latitude_rad, nav.longitude_rad, nav.altitude_m})
        .head<2>()
        .norm();
  };
  EXPECT_LT(error(with), 0.6 * error(without));
  std::size_t used = 0;
  for (const Verdict& one : verdicts)
    if (one.model == Name("model_velocity") && one.kind == VerdictKind::used) ++used;
  EXPECT_GT(used, 500u);
}

TEST(ModelVelocity, AModelThatWasWrongIsNotBelievedAlone) {
  const SurveyRun survey({.duration_s = 130.0, .usbl = false});
  std::vector<Verdict> verdicts;
  const NavState wrong = ModelRun::run(survey, 36.0, 0.0, true, &verdicts);
  const NavState without = ModelRun::run(survey, 36.0, 0.0, false);
  std::size_t used = 0;
  std::size_t rejected = 0;
  for (const Verdict& one : verdicts) {
    if (one.source != SourceKind::propulsion) continue;
    if (to_seconds(one.header.stamp_ns - SurveyRun::kEpochNs) < ModelRun::kLost_s + 4.0) continue;
    (one.kind == VerdictKind::used ? used : rejected) += 1;
  }
  EXPECT_EQ(used, 0u);
  EXPECT_GT(rejected, 100u);
  // What was not believed did no harm.
  const auto apart = geo::difference_N({without.latitude_rad, without.longitude_rad, without.altitude_m},
                                       {wrong.latitude_rad, wrong.longitude_rad, wrong.altitude_m});
  EXPECT_LT(apart.norm(), 0.5);
}

TEST(ModelVelocity, AModelThatIsWrongLeavesTheShaftToTheSpeedLog) {
  const SurveyRun survey({.duration_s = 130.0, .usbl = false});
  constexpr double kScale = 1.8 / 1080.0;
  const NavState log = ModelRun::run(survey, 1.0, 0.0, false, nullptr, nullptr, kScale);
  // Six times too fast its gate refuses it, twelve times it is doubted altogether.
  for (const double thrust : {36.0, 144.0}) {
    std::vector<Verdict> verdicts;
    const NavState wrong = ModelRun::run(survey, thrust, 0.0, true, &verdicts, nullptr, kScale);
    std::map<std::pair<std::string, VerdictKind>, int> shaft;
    std::map<VerdictKind, int> fins;
    for (const Verdict& one : verdicts) {
      if (to_seconds(one.header.stamp_ns - SurveyRun::kEpochNs) < ModelRun::kLost_s + 4.0) continue;
      if (one.source == SourceKind::propulsion) ++shaft[{one.model.str(), one.kind}];
      if (one.source == SourceKind::fins) ++fins[one.kind];
    }
    EXPECT_GT((shaft[{"speed_log", VerdictKind::used}]), 100) << thrust;
    EXPECT_EQ((shaft[{"model_velocity", VerdictKind::used}]), 0) << thrust;
    if (thrust > 100.0) {
      // The fins serve the model alone, and their verdict tells of it.
      EXPECT_GT(fins[VerdictKind::rejected], 100);
      EXPECT_EQ(fins[VerdictKind::used], 0);
    }
    const auto apart = geo::difference_N({log.latitude_rad, log.longitude_rad, log.altitude_m},
                                         {wrong.latitude_rad, wrong.longitude_rad, wrong.altitude_m});
    EXPECT_LT(apart.norm(), 0.5) << thrust;
  }
}

TEST(ModelVelocity, ConfigurationNamesWhatIsMissing) {
  EngineConfig config;
  config.vehicle_model.enabled = true;
  EXPECT_NE(config.validate().find("vehicle_model.coefficients.X_uu"), std::string::npos)
      << config.validate();
  config.vehicle_model.coefficients = test::small_vehicle();
  EXPECT_NE(config.validate().find("groups.model_bias"), std::string::npos) << config.validate();
  config.groups.model_bias = true;
  EXPECT_EQ(config.validate(), "");
}

}  // namespace
}  // namespace fathom::estimation
