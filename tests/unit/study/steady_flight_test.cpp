// What cannot be told apart keeps its uncertainty (KF-5): straight flight does not separate tilt from
// accelerometer bias, however long it takes; swinging in pitch does.
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "study/consistency/instruments.hpp"
#include "study/consistency/truth_path.hpp"

namespace fathom::study {
namespace {

constexpr double kBias_m_s2 = 0.5;
constexpr double kBiasSigma_m_s2 = 0.3;

/// A flight with a bias of the forward accelerometer, levelled by it.
class SteadyFlight {
 public:
  explicit SteadyFlight(double pitch_swing_rad)
      : path_(flight(pitch_swing_rad), {0.3, 0.2, 1000.0}), engine_(told()) {
    grade_.angle_walk_rad_sqrt_s = told().imu.angle_random_walk_rad_sqrt_s;
    grade_.velocity_walk_m_s_sqrt_s = told().imu.velocity_random_walk_m_s_sqrt_s;
    grade_.in_run_s = 1000.0;
    imu_.emplace(grade_, 4);
  }

  void fly(double seconds) {
    for (const double end = path_.time_s() + seconds; path_.time_s() < end - 1e-6;) step();
  }
  [[nodiscard]] double pitch_error_rad() const {
    return engine_.nav_state().rpy_rad[1] - std::asin(-path_.pose().axes_NB(2, 0));
  }
  [[nodiscard]] double tilt_sigma_rad() const { return std::sqrt(engine_.navigation_covariance()(7, 7)); }

 private:
  const Manoeuvres& flight(double pitch_swing_rad) {
    flight_.speed_m_s = Profile(45.0);
    flight_.pitch_rad = Profile(0.05).swing(pitch_swing_rad, 3.9, 0.0);
    return flight_;
  }
  static estimation::EngineConfig told() {
    estimation::EngineConfig c;
    c.groups = {};
    c.left_out = estimation::LeftOut::noise;
    c.alignment.mode = estimation::StartMode::given;
    c.imu.angle_random_walk_rad_sqrt_s = 0.4 * kRadPerDeg / 60.0;
    c.imu.velocity_random_walk_m_s_sqrt_s = 0.1 / 60.0;
    c.imu.accel_bias_sigma_m_s2 = kBiasSigma_m_s2;
    c.imu.accel_bias_instability_m_s2 = c.imu.gyro_bias_instability_rad_s = 0.0;
    c.imu.gyro_scale_sigma = c.imu.accel_scale_sigma = 0.0;
    c.imu.gyro_misalignment_sigma_rad = c.imu.accel_misalignment_sigma_rad = 0.0;
    auto gps = estimation::default_sensor(SourceKind::gps, "gps");
    gps.sigma = {0.5, 0.5, 1.0};
    gps.velocity_sigma_m_s = {0.1, 0.1, 0.2};
    gps.use_sample_sigma = false;
    c.sensors = {gps};
    return c;
  }
  void step() {
    const PerfectIncrements truth = path_.advance(0.01);
    ImuSample sample = imu_->read(truth, 0.01);
    sample.delta_velocity_B_m_s[0] += 0.01 * kBias_m_s2;
    sample.specific_force_B_m_s2[0] += kBias_m_s2;
    const auto stamp = [&](auto& one, std::string_view sensor) {
      one.header.sensor = sensor;
      one.header.stamp_ns = from_seconds(1000.0 + path_.time_s());
      one.header.sequence = static_cast<std::uint64_t>(count_ + 1);
    };
    if (count_ == 0) start();
    if (count_ % 20 == 0) {
      GpsSample fix = gps_.read(path_.pose(), 0.2);
      stamp(fix, "gps");
      engine_.add(fix);
    }
    stamp(sample, "imu");
    engine_.add(sample);
    ++count_;
  }
  void start() {
    const Pose pose = path_.pose();
    estimation::InitialState state;
    state.latitude_rad = pose.place.latitude_rad;
    state.longitude_rad = pose.place.longitude_rad;
    state.altitude_m = pose.place.height_m;
    state.velocity_N_m_s = {pose.velocity_N_m_s.x(), pose.velocity_N_m_s.y(), pose.velocity_N_m_s.z()};
    state.rpy_rad = {0.0, std::asin(-pose.axes_NB(2, 0)) + kBias_m_s2 / 9.8, 0.0};
    state.attitude_sigma_rad = {5.0 * kRadPerDeg, 5.0 * kRadPerDeg, 0.1 * kRadPerDeg};
    engine_.start_from(state);
  }

  Manoeuvres flight_;
  TruthPath path_;
  ImuGrade grade_{};
  std::optional<InertialUnit> imu_;
  GpsReceiver gps_{{.noise_m = 0.5, .drift_m = 1e-6, .velocity_m_s = 0.1, .lever_B_m = {0.0, 0.0, 0.0}}, 7};
  estimation::FusionEngine engine_;
  int count_ = 0;
};

TEST(SteadyFlightTest, TeachesNothingOfTheTilt) {
  SteadyFlight straight(0.0);
  straight.fly(10.0);
  const double early = straight.tilt_sigma_rad();
  // As much as the bias is unknown.
  EXPECT_NEAR(early, kBiasSigma_m_s2 / 9.8, 0.15 * early);
  straight.fly(410.0);
  EXPECT_GT(straight.tilt_sigma_rad(), 0.95 * early);
  EXPECT_LT(std::abs(straight.pitch_error_rad()), 3.0 * straight.tilt_sigma_rad());
}

TEST(SteadyFlightTest, IsToldByASwingInPitch) {
  SteadyFlight swinging(0.5 * kRadPerDeg);
  swinging.fly(420.0);
  EXPECT_LT(swinging.tilt_sigma_rad(), 0.5 * kRadPerDeg);
  EXPECT_LT(std::abs(swinging.pitch_error_rad()), 3.0 * swinging.tilt_sigma_rad());
}

}  // namespace
}  // namespace fathom::study
