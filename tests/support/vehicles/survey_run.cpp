#include "survey_run.hpp"

#include <algorithm>

namespace fathom::test {

void feed(estimation::FusionEngine& engine, const Sample& sample) {
  std::visit([&](const auto& s) { engine.add(s); }, sample);
}

SurveyRun::SurveyRun(const Options& options) {
  Normal normal(options.seed);
  const double dive = options.dive_s;
  const double wave = options.wave_rad;
  const auto ramp = [](double t, double from, double length) {
    const double s = std::clamp((t - from) / length, 0.0, 1.0);
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
  };
  AnalyticVehicle::Motion motion;
  motion.speed_m_s = [=](double t) { return 1.8 * ramp(t, 20.0, 6.0); };
  motion.rpy_rad = [=](double t) {
    const double afloat = 1.0 - ramp(t, dive, 5.0);
    const double pitch = -0.2 * (ramp(t, dive, 3.0) - ramp(t, dive + 12.0, 3.0)) +
                         0.2 * (ramp(t, options.surface_s - 15.0, 3.0) - ramp(t, options.surface_s, 3.0));
    return Eigen::Vector3d(
        wave * afloat * std::sin(1.6 * t) + 0.1 * ramp(t, 70.0, 4.0) * std::sin(0.2 * t),
        0.6 * wave * afloat * std::sin(1.3 * t + 0.4) + pitch,
        1.1 + 1.4 * ramp(t, 28.0, 8.0) - 2.8 * ramp(t, dive + 20.0, 15.0) + 2.0 * ramp(t, dive + 50.0, 12.0));
  };
  AnalyticVehicle vehicle(motion, {0.6353, 2.2235, kSurfaceAltitude_m}, 0.01);
  const Eigen::Vector3d gyro_bias = normal.vector(options.gyro_bias_rad_s);
  const Eigen::Vector3d accel_bias = normal.vector(options.accel_bias_m_s2);
  const double dvl_scale = normal(0.002);
  const Eigen::Vector3d dvl_turn = normal.vector(0.005);
  const double compass_bias = normal(0.012);

  const auto steps = static_cast<int>(options.duration_s * 100.0);
  std::uint64_t sequence[7] = {};
  for (int k = 0; k <= steps; ++k) {
    Eigen::Vector3d dtheta;
    Eigen::Vector3d dv;
    if (k > 0) vehicle.step(dtheta, dv);
    const double t = vehicle.time_s();
    const TimeNs now = kEpochNs + static_cast<TimeNs>(k) * 10'000'000;
    const auto head = [&](const char* name, int stream, TimeNs stamp, double delay_s) {
      SampleHeader h;
      h.vehicle = "auv";
      h.sensor = name;
      h.stamp_ns = stamp;
      h.received_ns = stamp + from_seconds(delay_s);
      h.sequence = ++sequence[stream];
      return h;
    };
    Truth one;
    one.header = head("truth", 6, now, 0.0);
    one.latitude_rad = vehicle.position().latitude_rad;
    one.longitude_rad = vehicle.position().longitude_rad;
    one.altitude_m = vehicle.position().altitude_m;
    one.velocity_N_m_s = geo::arr(vehicle.v_N_m_s());
    one.rpy_rad = geo::arr(vehicle.rpy_rad());
    truth.push_back(one);

    ImuSample imu;
    imu.header = head("imu", 0, now, 0.002);
    const double sigma = std::sqrt(0.01);
    const Eigen::Vector3d gyro_noise = normal.vector(2.9e-5 * sigma);
    const Eigen::Vector3d accel_noise = normal.vector(5e-4 * sigma);
    if (k == 0) {
      dtheta = 0.01 * vehicle.rate_ib_B_rad_s();
      dv = 0.01 * vehicle.force_B_m_s2();
    }
    dtheta += 0.01 * gyro_bias + gyro_noise;
    dv += 0.01 * accel_bias + accel_noise;
    imu.delta_angle_B_rad = geo::arr(dtheta);
    imu.delta_velocity_B_m_s = geo::arr(dv);
    imu.delta_time_s = 0.01;
    imu.angular_rate_B_rad_s = geo::arr(dtheta / 0.01);
    imu.specific_force_B_m_s2 = geo::arr(dv / 0.01);
    samples.emplace_back(imu);

    const Eigen::Matrix3d c = vehicle.C_NB();
    const double depth = kSurfaceAltitude_m - vehicle.position().altitude_m;
    const bool gps_on = t < options.dive_s || t > options.surface_s + 3.0;
    if (k % 50 == 7 && gps_on) {
      GpsSample gps;
      gps.header = head("gps0", 1, now, options.gps_delay_s);
      gps.fix = GpsFix::fix_3d;
      const geo::Geodetic at = geo::moved_by(vehicle.position(), c * gps_lever() + normal.vector(1.0));
      gps.latitude_rad = at.latitude_rad;
      gps.longitude_rad = at.longitude_rad;
      gps.altitude_m = at.altitude_m;
      gps.velocity_N_m_s = geo::arr(
          vehicle.v_N_m_s() + c * geo::cross(vehicle.rate_nb_B_rad_s(), gps_lever()) + normal.vector(0.05));
      samples.emplace_back(gps);
    }
    if (k % 20 == 3) {
      DvlSample dvl;
      dvl.header = head("dvl0", 2, now, options.dvl_delay_s);
      const Eigen::Vector3d v =
          c.transpose() * vehicle.v_N_m_s() + geo::cross(vehicle.rate_nb_B_rad_s(), dvl_lever());
      dvl.velocity_D_m_s = geo::arr((1.0 + dvl_scale) * (v - geo::cross(dvl_turn, v)) + normal.vector(0.01));
      samples.emplace_back(dvl);
    }
    if (k % 10 == 5) {
      DepthSample sample;
      sample.header = head("depth0", 3, now, 0.05);
      sample.depth_m = depth + normal(0.03);
      samples.emplace_back(sample);
      HeadingSample heading;
      heading.header = head("compass0", 4, now, 0.05);
      heading.heading_rad = geo::wrap_two_pi(vehicle.rpy_rad().z() + compass_bias + normal(0.005));
      samples.emplace_back(heading);
    }
    if (options.usbl && k % 500 == 250 && t > options.dive_s) {
      UsblSample usbl;
      usbl.header = head("usbl0", 5, now, 2.0);
      const geo::Geodetic at = geo::moved_by(vehicle.position(), normal.vector(2.0));
      usbl.latitude_rad = at.latitude_rad;
      usbl.longitude_rad = at.longitude_rad;
      usbl.depth_m = depth + normal(2.0);
      usbl.sigma_m = 2.0;
      if (options.usbl_slow_m > 0.0) {
        Normal slow(options.seed + 1'000);
        const geo::Geodetic off =
            geo::moved_by(vehicle.position(), slow.vector(options.usbl_slow_m) + normal.vector(0.2));
        usbl.latitude_rad = off.latitude_rad;
        usbl.longitude_rad = off.longitude_rad;
        usbl.sigma_m = options.usbl_slow_m;
      }
      samples.emplace_back(usbl);
    }
  }
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return header(a).received_ns < header(b).received_ns;
  });
}

estimation::EngineConfig SurveyRun::config() {
  estimation::EngineConfig c;
  auto gps = estimation::default_sensor(SourceKind::gps, "gps0");
  gps.lever_B_m = geo::arr(gps_lever());
  gps.sigma = {1.0, 1.0, 1.0};
  gps.velocity_sigma_m_s = {0.05, 0.05, 0.05};
  auto dvl = estimation::default_sensor(SourceKind::dvl, "dvl0");
  dvl.lever_B_m = geo::arr(dvl_lever());
  auto depth = estimation::default_sensor(SourceKind::depth, "depth0");
  depth.sigma = {0.03, 0.03, 0.03};
  auto compass = estimation::default_sensor(SourceKind::heading, "compass0");
  compass.sigma = {0.01, 0.01, 0.01};
  auto usbl = estimation::default_sensor(SourceKind::usbl, "usbl0");
  c.sensors = {gps, dvl, depth, compass, usbl};
  c.states.gps_bias_sigma_m = 0.3;
  return c;
}

}  // namespace fathom::test
