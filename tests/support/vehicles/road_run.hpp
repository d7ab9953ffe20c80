#pragma once

#include <algorithm>
#include <vector>

#include "support/vehicles/survey_run.hpp"

namespace fathom::test {

/// A car that is under way when the recording begins: straights of 12 s and bends of 8 s, nothing but an
/// inertial unit and GPS.
struct RoadRun {
  static constexpr TimeNs kEpochNs = SurveyRun::kEpochNs;
  static constexpr double kStep_s = 0.02;

  struct Options {
    double duration_s = 160.0;
    std::uint64_t seed = 1;
    double mount_pitch_rad = 0.0;   ///< of the wheels' axes in those of the unit
    double mount_yaw_rad = 0.0;     ///< likewise
    double settling_rad_s = 0.0;    ///< of the vertical gyro's bias at the start
    double settling_time_s = 25.0;  ///< in which it falls to 1/e
  };

  std::vector<Sample> samples;  ///< by received_ns
  std::vector<Truth> truth;     ///< one per inertial sample: attitude of the wheels' axes

  /// A turn begins every 20 s, to the right, the left, the left, the right.
  static double yaw_rad(double t) {
    constexpr std::array<double, 4> kTurns_rad{1.5, -1.2, -1.4, 1.0};
    double yaw = 0.7;
    for (int i = 0; i < 64; ++i) {
      const double s = std::clamp((t - 12.0 - 20.0 * i) / 8.0, 0.0, 1.0);
      if (s <= 0.0) break;
      yaw += kTurns_rad[static_cast<std::size_t>(i % 4)] * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    }
    return yaw;
  }
  /// Neither within a turn nor within a second of one.
  static bool straight(double t) {
    const double phase = std::fmod(t, 20.0);
    return phase > 1.0 && phase < 11.0;
  }

  explicit RoadRun(const Options& options) {
    Normal normal(options.seed);
    AnalyticVehicle::Motion motion;
    motion.speed_m_s = [](double t) { return 11.0 + 3.0 * std::sin(0.13 * t); };
    motion.rpy_rad = [](double t) { return Eigen::Vector3d(0.0, 0.02 * std::sin(0.1 * t), yaw_rad(t)); };
    AnalyticVehicle vehicle(motion, {0.7, -1.8, 1500.0}, kStep_s);
    const Eigen::Matrix3d C_UW =
        geo::to_matrix(geo::from_rpy({0.0, options.mount_pitch_rad, options.mount_yaw_rad}));
    const Eigen::Vector3d gyro_bias = normal.vector(1e-4);
    const Eigen::Vector3d accel_bias = normal.vector(0.02);
    std::uint64_t sequence = 0;
    const auto steps = static_cast<int>(options.duration_s / kStep_s);
    for (int k = 0; k <= steps; ++k) {
      Eigen::Vector3d dtheta = kStep_s * vehicle.rate_ib_B_rad_s();
      Eigen::Vector3d dv = kStep_s * vehicle.force_B_m_s2();
      if (k > 0) vehicle.step(dtheta, dv);
      const double t = vehicle.time_s();
      SampleHeader header;
      header.vehicle = "auv";
      header.stamp_ns = kEpochNs + k * from_seconds(kStep_s);
      header.received_ns = header.stamp_ns;
      header.sequence = ++sequence;
      Truth one;
      one.header = header;
      one.latitude_rad = vehicle.position().latitude_rad;
      one.longitude_rad = vehicle.position().longitude_rad;
      one.altitude_m = vehicle.position().altitude_m;
      one.velocity_N_m_s = geo::arr(vehicle.v_N_m_s());
      one.rpy_rad = geo::arr(vehicle.rpy_rad());
      truth.push_back(one);

      Eigen::Vector3d bias = gyro_bias;
      bias.z() += options.settling_rad_s * std::exp(-t / options.settling_time_s);
      dtheta = C_UW * dtheta + kStep_s * bias + normal.vector(1e-4 * std::sqrt(kStep_s));
      dv = C_UW * dv + kStep_s * accel_bias + normal.vector(5e-3 * std::sqrt(kStep_s));
      ImuSample imu;
      imu.header = header;
      imu.header.sensor = "imu";
      imu.delta_angle_B_rad = geo::arr(dtheta);
      imu.delta_velocity_B_m_s = geo::arr(dv);
      imu.delta_time_s = kStep_s;
      imu.angular_rate_B_rad_s = geo::arr(dtheta / kStep_s);
      imu.specific_force_B_m_s2 = geo::arr(dv / kStep_s);
      samples.emplace_back(imu);
      if (k % 25 != 0) continue;
      GpsSample gps;
      gps.header = header;
      gps.header.sensor = "gps0";
      gps.fix = GpsFix::fix_3d;
      const geo::Geodetic at = geo::moved_by(vehicle.position(), normal.vector(0.5));
      gps.latitude_rad = at.latitude_rad;
      gps.longitude_rad = at.longitude_rad;
      gps.altitude_m = at.altitude_m;
      gps.velocity_N_m_s = geo::arr(vehicle.v_N_m_s() + normal.vector(0.1));
      samples.emplace_back(gps);
    }
  }

  /// Tells the engine how the errors were drawn, but for the mount and the settling of the bias.
  static estimation::EngineConfig config() {
    estimation::EngineConfig config;
    config.configuration = "gps_ins15";
    config.groups = {};
    config.imu.nominal_rate_hz = 1.0 / kStep_s;
    config.imu.angle_random_walk_rad_sqrt_s = 1e-4;
    config.imu.velocity_random_walk_m_s_sqrt_s = 5e-3;
    config.imu.gyro_bias_sigma_rad_s = 1e-4;
    config.imu.gyro_bias_instability_rad_s = 1e-5;
    config.imu.accel_bias_sigma_m_s2 = 0.02;
    config.imu.accel_bias_instability_m_s2 = 1e-3;
    config.alignment.mode = estimation::StartMode::in_motion;
    estimation::SensorConfig gps = estimation::default_sensor(SourceKind::gps, "gps0");
    gps.sigma = {0.5, 0.5, 0.5};
    config.sensors = {gps};
    return config;
  }
};

}  // namespace fathom::test
