// Biases of the inertial unit that are larger than is said of them (GATE-11).
#include "estimation/doubt/bias_prior.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "geo/so3.hpp"
#include "samples/alignment/help.hpp"
#include "support/vehicles/spoilt_survey.hpp"
#include "unit/estimation/linear_loop.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::Normal;
using test::SurveyRun;

constexpr double kDegPerHour = kRadPerDeg / 3600.0;
constexpr std::size_t kGyroY = 1;

/// What a filter and what is said of the biases come to in a minute of velocities.
struct Minute {
  explicit Minute(double said_rad_s) : loop(filter(said_rad_s)), prior(StateIndex{StateGroups{}}) {}

  LinearLoop loop;
  BiasPrior prior;
  FilterState estimated;
  double gyro_y_rad_s = 0.0;  ///< the true bias

  static ErrorFilter filter(double said_rad_s) {
    const StateIndex index{StateGroups{}};
    std::array<double, kMaxStates> sigma{};
    for (std::size_t i = 0; i < kNavStates; ++i) sigma[i] = i < 3 ? 2.0 : i < 6 ? 0.1 : 1e-3;
    for (std::size_t i = 0; i < 3; ++i) {
      sigma[static_cast<std::size_t>(index.of(Group::accel_bias)) + i] = 1e-3;
      sigma[static_cast<std::size_t>(index.of(Group::gyro_bias)) + i] = kDegPerHour;
    }
    sigma[static_cast<std::size_t>(index.of(Group::gyro_bias)) + kGyroY] = said_rad_s;
    ErrorFilter out(index);
    out.reset(sigma);
    return out;
  }
  [[nodiscard]] static int state() { return StateIndex{StateGroups{}}.of(Group::gyro_bias) + kGyroY; }

  /// Until `stop(*this)` after a second.
  template <class Stop>
  void run(double bias_rad_s, std::uint64_t seed, const Stop& stop) {
    Normal normal(seed);
    const StateIndex index{StateGroups{}};
    const StateDrift drift;
    NavSolution nav;
    nav.position = {0.6, 0.2, 10.0};
    nav.q_NB = geo::from_rpy({0.0, 0.0, 0.8});
    ProcessNoise noise;
    noise.velocity = 1e-6 * Eigen::Matrix3d::Identity();
    noise.attitude = 1e-12 * Eigen::Matrix3d::Identity();
    gyro_y_rad_s = bias_rad_s;
    loop.error(state()) = bias_rad_s;
    prior.begin(estimated, loop.filter);
    for (int k = 1; k <= 600; ++k) {
      const NavTransition step(index, nav, Vector3d::Zero(), Vector3d(0.2, 0.0, -9.8), 0.1);
      loop.filter.propagate(step, noise);
      loop.propagate_error(step, index.size());
      prior.propagated(drift, 0.1, estimated, loop.filter);
      loop.see_velocity(0.02, normal);
      note_estimates();
      if (k % 10 == 0 && stop(*this)) return;
    }
  }
  void note_estimates() {
    const int first = std::min(StateIndex{StateGroups{}}.of(Group::gyro_bias),
                               StateIndex{StateGroups{}}.of(Group::accel_bias));
    for (int i = first; i < loop.filter.size(); ++i)
      estimated.x[static_cast<std::size_t>(i)] = (i == state() ? gyro_y_rad_s : 0.0) - loop.error(i);
  }
};

TEST(BiasPrior, TakesBackWhatWasConcludedFromWhatWasSaid) {
  constexpr double kBias_rad_s = 40.0 * kDegPerHour;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Minute told(kDegPerHour);
    std::optional<BiasPrior::Wrong> wrong;
    double at = 0.0;
    told.run(kBias_rad_s, seed, [&](const Minute& now) {
      at += 1.0;
      wrong = now.prior.wrong(now.estimated, now.loop.filter);
      return wrong.has_value();
    });
    ASSERT_TRUE(wrong.has_value()) << seed;
    EXPECT_EQ(wrong->state, Minute::state());
    EXPECT_LT(at, 40.0);
    EXPECT_NEAR(std::sqrt(wrong->variance) / kBias_rad_s, 1.0, 0.5) << seed;
    std::array<double, kMaxStates> column{};
    std::array<double, kMaxStates> moved{};
    for (int i = 0; i < told.loop.filter.size(); ++i) {
      const auto state = static_cast<std::size_t>(i);
      column[state] = told.loop.filter(i, wrong->state);
      moved[state] = wrong->share * wrong->beyond * column[state];
    }
    told.loop.filter.shift(column, wrong->share * wrong->beyond, wrong->share);
    told.loop.remove(moved);
    // What it would have come to, had the larger variance been said from the start.
    Minute open(std::sqrt(wrong->variance));
    double open_at = 0.0;
    open.run(kBias_rad_s, seed, [&](const Minute&) { return (open_at += 1.0) == at; });
    for (int i = 0; i < told.loop.filter.size(); ++i) {
      const double sigma = std::sqrt(open.loop.filter(i, i));
      EXPECT_NEAR(std::sqrt(told.loop.filter(i, i)), sigma, 1e-6 * sigma) << i;
      EXPECT_NEAR(told.loop.error(i), open.loop.error(i), 1e-6 * sigma) << i;
    }
  }
}

TEST(BiasPrior, IsNotDoubtedForWhatItsSigmaAllows) {
  int doubted = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Normal normal(1000 + seed);
    Minute told(kDegPerHour);
    told.run(normal(kDegPerHour), seed, [&](const Minute& now) {
      doubted += now.prior.wrong(now.estimated, now.loop.filter) ? 1 : 0;
      return false;
    });
  }
  EXPECT_EQ(doubted, 0);
}

// An instant is no bias, however much it says, and whether little or much is known by then.
TEST(BiasPrior, NoSingleMeasurementDecides) {
  for (const int known_after_s : {2, 60}) {
    Minute told(kDegPerHour);
    int at = 0;
    told.run(0.0, 3, [&](const Minute&) { return ++at == known_after_s; });
    ASSERT_FALSE(told.prior.wrong(told.estimated, told.loop.filter));
    Observation seen;
    seen.rows = 1;
    seen.h[0][static_cast<std::size_t>(Minute::state())] = 1.0;
    seen.sigma[0] = 0.1 * kDegPerHour;
    seen.list_columns(told.loop.filter.size());
    LinearLoop::Noise far = LinearLoop::Noise::Zero();
    far(0) = 30.0 * kDegPerHour;
    told.loop.take_in(seen, far);
    told.note_estimates();
    ASSERT_GT(told.estimated.x[static_cast<std::size_t>(Minute::state())], 20.0 * kDegPerHour);
    EXPECT_FALSE(told.prior.wrong(told.estimated, told.loop.filter)) << known_after_s;
    told.prior.propagated(StateDrift(), 1.0, told.estimated, told.loop.filter);
    EXPECT_FALSE(told.prior.wrong(told.estimated, told.loop.filter)) << known_after_s;
  }
}

/// A survey whose inertial unit has these biases beside those that are configured.
test::SpoiltSurvey biased(const SurveyRun& run, const Vector3d& gyro_rad_s, const Vector3d& accel_m_s2,
                          const EngineConfig& config = SurveyRun::config()) {
  const auto spoil = [&](test::Sample& sample, double) {
    auto* imu = std::get_if<ImuSample>(&sample);
    if (imu == nullptr) return;
    const auto add = [&](std::array<double, 3>& rate, std::array<double, 3>& increment,
                         const Vector3d& bias) {
      rate = geo::arr(geo::vec(rate) + bias);
      increment = geo::arr(geo::vec(increment) + imu->delta_time_s * bias);
    };
    add(imu->angular_rate_B_rad_s, imu->delta_angle_B_rad, gyro_rad_s);
    add(imu->specific_force_B_m_s2, imu->delta_velocity_B_m_s, accel_m_s2);
  };
  return test::survey(run, 60.0, spoil, config);
}

// What is left out passes for a bias and for noise there: taken back, it led published filters astray.
TEST(BiasPrior, IsTakenAsSaidWhereWhatIsLeftOutIsTakenForNone) {
  const SurveyRun run({.duration_s = 140.0, .usbl = false});
  EngineConfig config = SurveyRun::config();
  config.left_out = LeftOut::noise;
  EXPECT_EQ(
      biased(run, {0.0, 200.0 * kDegPerHour, 0.0}, Vector3d::Zero(), config).advice.find("bias of gyro"),
      std::string::npos);
}

TEST(BiasPrior, KeepsNavigationHonestBesideABiasedUnit) {
  const SurveyRun run({.duration_s = 140.0, .usbl = false});
  const test::SpoiltSurvey as_said = biased(run, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_EQ(as_said.advice, "");
  const test::SpoiltSurvey gyro = biased(run, {0.0, 200.0 * kDegPerHour, 0.0}, Vector3d::Zero());
  EXPECT_NE(gyro.advice.find("The bias of gyro y is "), std::string::npos) << gyro.advice;
  EXPECT_LT(gyro.worst_h_sigmas, 3.7);
  EXPECT_LT(gyro.worst_yaw_sigmas, 4.0);
  const test::SpoiltSurvey accel = biased(run, Vector3d::Zero(), {0.0, 0.2, 0.0});
  EXPECT_NE(accel.advice.find("The bias of accelerometer y is "), std::string::npos) << accel.advice;
  EXPECT_LT(accel.worst_h_sigmas, 3.7);
}

}  // namespace
}  // namespace fathom::estimation
