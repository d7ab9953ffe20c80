// Noise of the inertial unit that is larger than is said of it (GATE-12).
#include "estimation/doubt/motion_noise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geo/so3.hpp"
#include "support/vehicles/spoilt_survey.hpp"
#include "unit/estimation/linear_loop.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::Normal;

constexpr std::size_t kAccelerometers = MotionNoise::kAccelerometers;
constexpr std::size_t kGyros = MotionNoise::kGyros;

/// A filter that sees velocities, and a motion that may be noisier than it is told.
struct Drive {
  explicit Drive(std::uint64_t seed) : loop(filter()), motion(index().size()), normal(seed) {}

  static constexpr double kStep_s = 0.1;
  static constexpr double kSaidVelocity_m_s = 5e-4;  ///< per sqrt(s)
  static constexpr double kSaidAttitude_rad = 3e-5;

  LinearLoop loop;
  MotionNoise motion;
  Normal normal;
  int measured_every = 2;
  double velocity_sigma_m_s = 0.01;
  double most = 30.0;
  double nees = 0.0;  ///< mean of velocity and tilt, by their number, in the last run
  double largest = 1.0;

  static StateIndex index() { return StateIndex{StateGroups{}}; }
  static ErrorFilter filter() {
    std::array<double, kMaxStates> sigma{};
    for (std::size_t i = 0; i < kNavStates; ++i) sigma[i] = i < 3 ? 2.0 : i < 6 ? 0.1 : 1e-3;
    ErrorFilter out(index());
    out.reset(sigma);
    return out;
  }

  /// The true noise is so many times what is said.
  void run(double duration_s, double accelerometers, double gyros) {
    NavSolution nav;
    nav.position = {0.6, 0.2, 10.0};
    nav.q_NB = geo::from_rpy({0.0, 0.0, 0.8});
    const std::array<double, 2> said{kSaidVelocity_m_s * kSaidVelocity_m_s,
                                     kSaidAttitude_rad * kSaidAttitude_rad};
    const NavTransition step(index(), nav, Vector3d::Zero(), Vector3d(0.2, 0.0, -9.8), kStep_s);
    nees = largest = 0.0;
    const int steps = static_cast<int>(duration_s / kStep_s);
    for (int k = 1; k <= steps; ++k) {
      ProcessNoise noise;
      noise.velocity = said[kAccelerometers] * Eigen::Matrix3d::Identity();
      noise.attitude = said[kGyros] * Eigen::Matrix3d::Identity();
      motion.widen(said, noise);
      loop.filter.propagate(step, noise);
      loop.propagate_error(step, index().size());
      for (Eigen::Index i = 0; i < 3; ++i) {
        loop.error(3 + i) += normal(accelerometers * kSaidVelocity_m_s * std::sqrt(kStep_s));
        loop.error(6 + i) += normal(gyros * kSaidAttitude_rad * std::sqrt(kStep_s));
      }
      motion.propagated(step, noise, said, most);
      if (k % measured_every == 0) measure();
      largest = std::max({largest, motion.factor(kAccelerometers), motion.factor(kGyros)});
      for (Eigen::Index i = 3; i < 8; ++i)
        nees += loop.error(i) * loop.error(i) / loop.filter(static_cast<int>(i), static_cast<int>(i)) /
                (5.0 * steps);
    }
  }
  void measure(double off_m_s = 0.0) {
    loop.see_velocity(velocity_sigma_m_s, off_m_s, normal,
                      [&](const Observation& observation, const InnovationStatistics& statistics) {
                        motion.updated(observation, statistics, loop.filter);
                      });
  }
};

TEST(MotionNoise, IsWhatIsSaidWhereItIs) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Drive drive(seed);
    drive.run(1'200.0, 1.0, 1.0);
    EXPECT_EQ(drive.largest, 1.0) << seed;
    EXPECT_NEAR(drive.nees, 1.0, 0.25) << seed;
  }
}

TEST(MotionNoise, IsFoundAndTheFilterIsHonestWithIt) {
  struct Case {
    double accelerometers, gyros;  ///< what they truly are
    std::size_t kind;
    double least, most, most_of_other;
  };
  for (const Case& one :
       {Case{1.0, 5.0, kGyros, 2.5, 9.0, 3.0}, Case{10.0, 1.0, kAccelerometers, 4.0, 15.0, 5.0}}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(testing::Message() << "kind " << one.kind << ", seed " << seed);
      Drive drive(seed);
      drive.run(600.0, one.accelerometers, one.gyros);
      EXPECT_GT(drive.motion.factor(one.kind), one.least);
      EXPECT_LT(drive.motion.factor(one.kind), one.most);
      EXPECT_LT(drive.motion.factor(1 - one.kind), one.most_of_other);
      drive.run(600.0, one.accelerometers, one.gyros);
      EXPECT_LT(drive.nees, 1.6);
      EXPECT_GT(drive.nees, 0.5);
    }
  }
}

TEST(MotionNoise, WithoutThatTheFilterWouldBeFarTooSure) {
  Drive drive(1);
  drive.most = 1.0;
  drive.run(600.0, 1.0, 5.0);
  EXPECT_EQ(drive.largest, 1.0);
  EXPECT_GT(drive.nees, 3.0);
}

TEST(MotionNoise, EndsWhenTheMotionIsQuietAgain) {
  Drive drive(3);
  drive.run(600.0, 1.0, 5.0);
  ASSERT_GT(drive.motion.factor(kGyros), 2.5);
  drive.run(1'800.0, 1.0, 1.0);
  EXPECT_LT(drive.motion.factor(kGyros), 2.0);
  EXPECT_LT(drive.motion.factor(kAccelerometers), 2.0);
}

TEST(MotionNoise, AWildMeasurementNowAndThenIsNone) {
  Drive drive(5);
  for (int k = 0; k < 10; ++k) {
    drive.run(60.0, 1.0, 1.0);
    drive.measure(0.1);  // ten sigmas
  }
  EXPECT_EQ(drive.motion.factor(kGyros), 1.0);
  EXPECT_EQ(drive.motion.factor(kAccelerometers), 1.0);
}

TEST(MotionNoise, IsBounded) {
  Drive drive(4);
  drive.most = 3.0;
  drive.run(900.0, 1.0, 8.0);
  EXPECT_EQ(drive.motion.factor(kGyros), 3.0);
}

// GPS knows a velocity far worse than a DVL: that of seconds tells accelerometers from gyros all the same.
TEST(MotionNoise, OfTheAccelerometersIsNotTakenForThatOfTheGyrosByVelocitiesOfGps) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Drive drive(seed);
    drive.measured_every = 5;
    drive.velocity_sigma_m_s = 0.05;
    drive.run(900.0, 25.0, 1.0);
    EXPECT_LT(drive.motion.factor(kGyros), 3.0) << seed;
    EXPECT_GT(drive.motion.factor(kAccelerometers), 3.0) << seed;
  }
}

}  // namespace
}  // namespace fathom::estimation
