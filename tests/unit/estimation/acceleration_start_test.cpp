#include "estimation/alignment/acceleration_start.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Accelerates by tilting, in all directions, and turns about its vertical axis as it likes: where it goes
/// says nothing of where its nose points.
struct Hopper {
  static constexpr double kStep_s = 0.01;
  static constexpr TimeNs kBegin_ns = 1'700'000'000 * kNsPerSecond;
  static constexpr std::size_t kWaves = 3;

  struct Wave {
    Vector3d amplitude_N_m_s2 = Vector3d::Zero();
    double rate_rad_s = 1.0;
    double phase_rad = 0.0;
  };
  struct Faults {
    Vector3d gyro_bias_B_rad_s = Vector3d::Zero();
    Vector3d accel_bias_B_m_s2 = Vector3d::Zero();
    Vector3d lever_B_m = Vector3d::Zero();
    double gyro_noise_rad_sqrt_s = 0.0;
    double accel_noise_m_s_sqrt_s = 0.0;
    Vector3d velocity_sigma_m_s = Vector3d::Zero();
    Vector3d newest_N_m_s = Vector3d::Zero();  ///< added to the velocity measured last
    double jump_s = std::numeric_limits<double>::infinity();
    Vector3d jump_N_m_s = Vector3d::Zero();  ///< added to every velocity after that
  };

  std::array<Wave, kWaves> waves;
  Vector3d wind_N_m_s = Vector3d::Zero();
  double yaw_rad = 0.0;
  double swing_rad = 0.0;
  double swing_rate_rad_s = 0.5;

  static Hopper drawn(std::uint64_t seed, double acceleration_m_s2) {
    sim::Random random(seed, "hopper");
    Hopper out;
    for (Wave& wave : out.waves) {
      wave.amplitude_N_m_s2 =
          acceleration_m_s2 * Vector3d(random.normal(), random.normal(), 0.3 * random.normal());
      wave.rate_rad_s = random.uniform(0.7, 2.0);
      wave.phase_rad = random.uniform(0.0, 2.0 * M_PI);
    }
    out.wind_N_m_s = Vector3d(random.normal(4.0), random.normal(4.0), random.normal(0.5));
    out.yaw_rad = random.uniform(-M_PI, M_PI);
    out.swing_rad = random.uniform(0.0, 1.0);
    return out;
  }

  [[nodiscard]] Vector3d acceleration_N_m_s2(double t_s) const {
    Vector3d out = Vector3d::Zero();
    for (const Wave& wave : waves)
      out += wave.amplitude_N_m_s2 * std::sin(wave.rate_rad_s * t_s + wave.phase_rad);
    return out;
  }
  [[nodiscard]] Vector3d velocity_N_m_s(double t_s) const {
    Vector3d out = wind_N_m_s;
    for (const Wave& wave : waves)
      out -= wave.amplitude_N_m_s2 / wave.rate_rad_s * std::cos(wave.rate_rad_s * t_s + wave.phase_rad);
    return out;
  }
  [[nodiscard]] Vector3d position_N_m(double t_s) const {
    Vector3d out = t_s * wind_N_m_s;
    for (const Wave& wave : waves)
      out -= wave.amplitude_N_m_s2 / (wave.rate_rad_s * wave.rate_rad_s) *
             std::sin(wave.rate_rad_s * t_s + wave.phase_rad);
    return out;
  }
  [[nodiscard]] Vector3d felt_N_m_s2(double t_s) const {
    return acceleration_N_m_s2(t_s) - Vector3d(0.0, 0.0, kStandardGravity_m_s2);
  }
  /// Thrust is along its own up axis, and the nose where the yaw says.
  [[nodiscard]] Matrix3d C_NB(double t_s) const {
    const double yaw = yaw_rad + swing_rad * std::sin(swing_rate_rad_s * t_s);
    const Vector3d down = -felt_N_m_s2(t_s).normalized();
    const Vector3d right = geo::cross(down, Vector3d(std::cos(yaw), std::sin(yaw), 0.0)).normalized();
    Matrix3d out;
    out << geo::cross(right, down), right, down;
    return out;
  }
  [[nodiscard]] Vector3d rate_B_rad_s(double t_s, double h_s = 1e-4) const {
    return geo::log(geo::from_matrix(C_NB(t_s - h_s).transpose() * C_NB(t_s + h_s))) / (2.0 * h_s);
  }

  /// What it measures for so long, GPS five times a second.
  [[nodiscard]] VelocityTrack measured(double length_s, const Faults& faults, std::uint64_t seed = 1) const {
    sim::Random random(seed, "instruments");
    const auto drawn = [&random](double sigma) {
      return Vector3d(random.normal(sigma), random.normal(sigma), random.normal(sigma));
    };
    VelocityTrack track;
    const int steps = static_cast<int>(std::lround(length_s / kStep_s));
    for (int k = 0; k <= steps; ++k) {
      const double t_s = k * kStep_s;
      std::optional<NewVelocity> velocity;
      if (k % 20 == 0) {
        velocity = NewVelocity{kBegin_ns + from_seconds(t_s), velocity_N_m_s(t_s), faults.velocity_sigma_m_s};
        velocity->v_N_m_s += C_NB(t_s) * geo::cross(rate_B_rad_s(t_s), faults.lever_B_m);
        velocity->v_N_m_s += faults.velocity_sigma_m_s.cwiseProduct(drawn(1.0));
        if (k == steps) velocity->v_N_m_s += faults.newest_N_m_s;
        if (t_s > faults.jump_s) velocity->v_N_m_s += faults.jump_N_m_s;
      }
      const double middle_s = t_s + 0.5 * kStep_s;
      const Vector3d rate = rate_B_rad_s(middle_s) + faults.gyro_bias_B_rad_s +
                            drawn(faults.gyro_noise_rad_sqrt_s / std::sqrt(kStep_s));
      const Vector3d force = C_NB(middle_s).transpose() * felt_N_m_s2(middle_s) + faults.accel_bias_B_m_s2 +
                             drawn(faults.accel_noise_m_s_sqrt_s / std::sqrt(kStep_s));
      track.add(velocity, kBegin_ns + from_seconds(t_s + kStep_s), kStep_s, rate, force);
    }
    return track;
  }
  /// The track ends an interval after its last velocity. Truth from found, about N.
  [[nodiscard]] Vector3d turned_rad(double length_s, const MovingStart& found) const {
    return geo::log(geo::from_matrix(C_NB(length_s + kStep_s)) * geo::conjugate(found.q_NB));
  }

  static AccelerationStartInputs inputs() {
    return {.gravity_N_m_s2 = Vector3d(0.0, 0.0, kStandardGravity_m_s2),
            .lever_B_m = Vector3d::Zero(),
            .velocity_random_walk_m_s_sqrt_s = 0.05,
            .angle_random_walk_rad_sqrt_s = 5e-4,
            .accel_bias_sigma_m_s2 = 0.3,
            .accel_shape_sigma_m_s2 = 0.0,
            .unexplained_force_sigma_m_s2 = 0.0,
            .gyro_bias_sigma_rad_s = 0.01,
            .turn_error_sigma = 0.0,
            .latency_sigma_s = 0.0};
  }
  static Faults noise() {
    Faults out;
    out.gyro_noise_rad_sqrt_s = inputs().angle_random_walk_rad_sqrt_s;
    out.accel_noise_m_s_sqrt_s = inputs().velocity_random_walk_m_s_sqrt_s;
    out.velocity_sigma_m_s = Vector3d(0.05, 0.05, 0.1);
    return out;
  }
  static constexpr double kLength_s = 6.0;
};

TEST(AccelerationStart, FindsTheAttitudeWhereverTheNosePoints) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Hopper hopper = Hopper::drawn(seed, 2.0);
    const auto found = start_by_accelerations(hopper.measured(Hopper::kLength_s, {}), Hopper::inputs());
    ASSERT_TRUE(found) << seed;
    EXPECT_LT(hopper.turned_rad(Hopper::kLength_s, found->start).norm(), 0.2 * kRadPerDeg) << seed;
    EXPECT_LT((found->start.v_N_m_s - hopper.velocity_N_m_s(Hopper::kLength_s + Hopper::kStep_s)).norm(),
              0.02);
  }
}

TEST(AccelerationStart, ALeverArmIsTakenIntoAccount) {
  const Hopper hopper = Hopper::drawn(3, 2.0);
  Hopper::Faults faults;
  faults.lever_B_m = Vector3d(0.5, -0.4, -1.0);
  AccelerationStartInputs in = Hopper::inputs();
  const auto without = start_by_accelerations(hopper.measured(Hopper::kLength_s, faults), in);
  in.lever_B_m = faults.lever_B_m;
  const auto with = start_by_accelerations(hopper.measured(Hopper::kLength_s, faults), in);
  ASSERT_TRUE(with);
  EXPECT_LT(hopper.turned_rad(Hopper::kLength_s, with->start).norm(), 0.2 * kRadPerDeg);
  ASSERT_TRUE(without);
  EXPECT_GT(hopper.turned_rad(Hopper::kLength_s, without->start).norm(), 1.0 * kRadPerDeg);
}

TEST(AccelerationStart, BiasesAndVelocitiesTurnTheAttitudeAsTheCovarianceSays) {
  const Hopper hopper = Hopper::drawn(5, 2.0);
  Hopper::Faults none;
  none.velocity_sigma_m_s = Vector3d::Constant(1e-3);  // what is said of it, and next to nothing
  const auto found_with = [&](const Hopper::Faults& faults) {
    AccelerationStartInputs in = Hopper::inputs();
    in.angle_random_walk_rad_sqrt_s = 1e-5;
    in.velocity_random_walk_m_s_sqrt_s = 1e-3;
    const auto out = start_by_accelerations(hopper.measured(Hopper::kLength_s, faults), in);
    EXPECT_TRUE(out);
    return out.value_or(AccelerationStart{}).start;
  };
  const MovingStart plain = found_with(none);
  const auto turned = [&plain](const MovingStart& found, double by) {
    return Vector3d(geo::log(plain.q_NB * geo::conjugate(found.q_NB)) / by);
  };
  for (int axis = 0; axis < 3; ++axis) {
    Hopper::Faults accel = none;
    accel.accel_bias_B_m_s2 = 0.01 * Vector3d::Unit(axis);
    Hopper::Faults gyro = none;
    gyro.gyro_bias_B_rad_s = 0.01 * Vector3d::Unit(axis);
    Hopper::Faults velocity = none;
    velocity.newest_N_m_s = 1e-3 * Vector3d::Unit(axis);
    EXPECT_LT((turned(found_with(accel), 0.01) - plain.by_accel_bias.col(axis)).norm(),
              0.03 * plain.by_accel_bias.norm() + 2e-4)
        << axis;
    EXPECT_LT((turned(found_with(gyro), 0.01) - plain.by_gyro_bias.col(axis)).norm(),
              0.03 * plain.by_gyro_bias.norm() + 2e-3)
        << axis;
    // A velocity that is too large by e: the truth is less than found by e, and turned by P_pv / P_vv of
    // that.
    const Vector3d expected = -plain.P_vp.row(axis).transpose() / plain.P_vv(axis, axis);
    EXPECT_LT((turned(found_with(velocity), 1e-3) - expected).norm(), 0.05 * expected.norm() + 1e-3) << axis;
  }
}

TEST(AccelerationStart, WhatItIsWrongByIsInTheCovariance) {
  double heading = 0.0;
  double rotation = 0.0;
  int found = 0;
  constexpr int kDraws = 200;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const Hopper hopper = Hopper::drawn(seed, 1.5);
    sim::Random random(seed, "biases");
    const AccelerationStartInputs in = Hopper::inputs();
    Hopper::Faults faults = Hopper::noise();
    for (int axis = 0; axis < 3; ++axis) {
      faults.gyro_bias_B_rad_s(axis) = random.normal(in.gyro_bias_sigma_rad_s);
      faults.accel_bias_B_m_s2(axis) = random.normal(in.accel_bias_sigma_m_s2);
    }
    const auto one = start_by_accelerations(hopper.measured(Hopper::kLength_s, faults, seed), in);
    if (!one || !(one->sigma_N_rad.maxCoeff() < 0.2)) continue;
    ++found;
    const MovingStart& start = one->start;
    const Matrix3d whole =
        start.P_pp +
        std::pow(in.accel_bias_sigma_m_s2, 2) * start.by_accel_bias * start.by_accel_bias.transpose() +
        std::pow(in.gyro_bias_sigma_rad_s, 2) * start.by_gyro_bias * start.by_gyro_bias.transpose();
    const Vector3d turned = hopper.turned_rad(Hopper::kLength_s, start);
    heading += std::pow(turned.z() / one->sigma_N_rad.z(), 2);
    rotation += turned.dot(whole.ldlt().solve(turned));
  }
  EXPECT_GT(found, kDraws * 3 / 4);
  // Of 150 and more: the mean of chi-squared over its degrees has a sigma of 0.12 and 0.07.
  EXPECT_GT(heading / found, 0.6);
  EXPECT_LT(heading / found, 1.4);
  EXPECT_GT(rotation / found, 3.0 * 0.7);
  EXPECT_LT(rotation / found, 3.0 * 1.3);
}

TEST(AccelerationStart, WhatTellsNothingStartsNothing) {
  const auto sigma_of = [](const Hopper& hopper, const Hopper::Faults& faults) {
    const auto found = start_by_accelerations(hopper.measured(Hopper::kLength_s, faults), Hopper::inputs());
    return found ? found->sigma_N_rad.z() : std::numeric_limits<double>::infinity();
  };
  Hopper hovering = Hopper::drawn(1, 0.0);
  EXPECT_GT(sigma_of(hovering, Hopper::noise()), 0.5);
  // A receiver that jumps is no acceleration that was felt.
  Hopper::Faults jumps = Hopper::noise();
  jumps.jump_s = 3.0;
  jumps.jump_N_m_s = Vector3d(5.0, 0.0, 0.0);
  EXPECT_GT(sigma_of(hovering, jumps), 0.5);
  EXPECT_GT(sigma_of(Hopper::drawn(2, 2.0), jumps), 0.2);
  Hopper::Faults broken = Hopper::noise();
  broken.accel_bias_B_m_s2 = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(
      start_by_accelerations(Hopper::drawn(2, 2.0).measured(Hopper::kLength_s, broken), Hopper::inputs()));
  // Five velocities are too few.
  EXPECT_FALSE(start_by_accelerations(Hopper::drawn(2, 2.0).measured(2.2, {}), Hopper::inputs()));
}

TEST(VelocityTrack, KeepsTheLastVelocitiesHalfASecondApartAndBeginsAnewAfterSilence) {
  const Hopper hopper = Hopper::drawn(1, 2.0);
  // Five times a second: every third is half a second or more from the one before.
  EXPECT_EQ(hopper.measured(6.0, {}).size(), 11U);
  VelocityTrack track = hopper.measured(30.0, {});
  EXPECT_EQ(track.size(), VelocityTrack::kMarks);
  EXPECT_NEAR(track.mark(3).span.duration_s, 0.6, 1e-9);
  TimeNs now_ns = Hopper::kBegin_ns + from_seconds(30.01);
  for (int k = 0; k < 350; ++k) {
    now_ns += from_seconds(0.01);
    track.add(std::nullopt, now_ns, 0.01, Vector3d::Zero(), Vector3d::Zero());
  }
  EXPECT_TRUE(track.add(NewVelocity{now_ns, Vector3d::Zero(), Vector3d::Zero()}, now_ns + from_seconds(0.01),
                        0.01, Vector3d::Zero(), Vector3d::Zero()));
  EXPECT_EQ(track.size(), 1U);
}

/// A multicopter that is switched on in flight, with GPS and nothing that tells its heading.
class HopperFlight {
 public:
  explicit HopperFlight(std::uint64_t seed) : hopper_(Hopper::drawn(seed, 1.5)), random_(seed, "flight") {
    for (int axis = 0; axis < 3; ++axis) {
      gyro_bias_B_rad_s_(axis) = random_.normal(config().imu.gyro_bias_sigma_rad_s);
      accel_bias_B_m_s2_(axis) = random_.normal(config().imu.accel_bias_sigma_m_s2);
    }
  }

  static EngineConfig config() {
    EngineConfig out;
    out.imu.nominal_rate_hz = 1.0 / Hopper::kStep_s;
    out.imu.velocity_random_walk_m_s_sqrt_s = 0.05;
    out.imu.angle_random_walk_rad_sqrt_s = 5e-4;
    out.imu.gyro_bias_sigma_rad_s = 0.005;
    out.imu.accel_bias_sigma_m_s2 = 0.2;
    out.alignment.in_motion_heading_sigma_rad = M_PI_2;  // the course is no heading
    out.sensors.push_back(default_sensor(SourceKind::gps, "gps"));
    return out;
  }
  /// One inertial sample, and a fix five times a second.
  void step(FusionEngine& engine) {
    if (step_ % 20 == 0) engine.add(fix());
    engine.add(felt());
    ++step_;
  }
  [[nodiscard]] double t_s() const { return step_ * Hopper::kStep_s; }
  [[nodiscard]] double heading_error_rad(const NavState& state) const {
    const double truth = geo::to_rpy(geo::from_matrix(hopper_.C_NB(t_s() - Hopper::kStep_s))).z();
    return std::remainder(state.rpy_rad[2] - truth, 2.0 * M_PI);
  }

 private:
  template <class Sample>
  [[nodiscard]] Sample stamped(const char* sensor) const {
    Sample out;
    out.header.sensor = sensor;
    out.header.stamp_ns = out.header.received_ns = Hopper::kBegin_ns + from_seconds(t_s());
    return out;
  }
  GpsSample fix() {
    auto out = stamped<GpsSample>("gps");
    out.fix = GpsFix::fix_3d;
    const SensorConfig sensor = default_sensor(SourceKind::gps, "gps");
    Vector3d position = hopper_.position_N_m(t_s());
    Vector3d velocity = hopper_.velocity_N_m_s(t_s());
    for (std::size_t i = 0; i < 3; ++i) {
      position(static_cast<int>(i)) += random_.normal(sensor.sigma[i]);
      velocity(static_cast<int>(i)) += random_.normal(sensor.velocity_sigma_m_s[i]);
    }
    const geo::Geodetic place = geo::moved_by({36.4 * kRadPerDeg, 127.4 * kRadPerDeg, 50.0}, position);
    out.latitude_rad = place.latitude_rad;
    out.longitude_rad = place.longitude_rad;
    out.altitude_m = place.altitude_m;
    out.velocity_N_m_s = geo::arr(velocity);
    return out;
  }
  ImuSample felt() {
    auto out = stamped<ImuSample>("imu");
    const double middle_s = t_s() - 0.5 * Hopper::kStep_s;
    Vector3d rate = hopper_.rate_B_rad_s(middle_s) + gyro_bias_B_rad_s_;
    Vector3d force = hopper_.C_NB(middle_s).transpose() * hopper_.felt_N_m_s2(middle_s) + accel_bias_B_m_s2_;
    const ImuConfig imu = config().imu;
    for (int axis = 0; axis < 3; ++axis) {
      rate(axis) += random_.normal(imu.angle_random_walk_rad_sqrt_s / std::sqrt(Hopper::kStep_s));
      force(axis) += random_.normal(imu.velocity_random_walk_m_s_sqrt_s / std::sqrt(Hopper::kStep_s));
    }
    out.angular_rate_B_rad_s = geo::arr(rate);
    out.specific_force_B_m_s2 = geo::arr(force);
    return out;
  }

  Hopper hopper_;
  sim::Random random_;
  Vector3d gyro_bias_B_rad_s_ = Vector3d::Zero();
  Vector3d accel_bias_B_m_s2_ = Vector3d::Zero();
  int step_ = 0;
};

TEST(AccelerationStart, AMulticopterWithoutACompassAlignsInFlightAndIsHonest) {
  constexpr std::array kInstants_s{0.0, 10.0, 30.0};  // after its first navigation state
  std::array<double, kInstants_s.size()> squares{};
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    HopperFlight flight(seed);
    FusionEngine engine(HopperFlight::config());
    std::size_t next = 0;
    double began_s = 0.0;
    while (next < kInstants_s.size() && flight.t_s() < 90.0) {
      flight.step(engine);
      const NavState& state = engine.nav_state();
      if (!known(state.latitude_rad)) continue;
      if (next == 0) began_s = flight.t_s();
      if (flight.t_s() - began_s < kInstants_s[next]) continue;
      squares[next] += std::pow(flight.heading_error_rad(state) / state.rpy_sigma_rad[2], 2) / kSeeds;
      ++next;
    }
    EXPECT_EQ(next, kInstants_s.size()) << seed;
    EXPECT_LT(began_s, 20.0) << seed;
    EXPECT_LT(std::abs(flight.heading_error_rad(engine.nav_state())), 10.0 * kRadPerDeg) << seed;
  }
  // The mean of twelve squares of standard normal figures is below 2.7 with a probability of 99.9 %.
  for (const double mean : squares) EXPECT_LT(mean, 2.7);
}

TEST(AccelerationStart, AnEngineThatWasSavedBeforeItsStartStartsAsIfItHadNot) {
  HopperFlight flight(2);
  FusionEngine engine(HopperFlight::config());
  while (flight.t_s() < 2.0) flight.step(engine);
  ASSERT_FALSE(known(engine.nav_state().latitude_rad));
  std::vector<std::byte> image;
  ASSERT_TRUE(engine.save(image));
  FusionEngine another(HopperFlight::config());
  ASSERT_EQ(another.restore(image), "");
  HopperFlight same = flight;
  while (flight.t_s() < 20.0) {
    flight.step(engine);
    same.step(another);
    ASSERT_EQ(known(engine.nav_state().latitude_rad), known(another.nav_state().latitude_rad))
        << flight.t_s();
    if (!known(engine.nav_state().latitude_rad)) continue;
    EXPECT_EQ(engine.nav_state().q_NB, another.nav_state().q_NB);
    return;
  }
  FAIL() << "it did not start";
}

}  // namespace
}  // namespace fathom::estimation
