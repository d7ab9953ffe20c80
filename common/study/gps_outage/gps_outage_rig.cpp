#include "study/gps_outage/gps_outage_rig.hpp"

#include <array>
#include <cmath>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"
#include "study/instruments.hpp"

namespace fathom::study {
namespace {

constexpr double kLatitude_rad = 40.1 * kRadPerDeg;
constexpr double kLongitude_rad = -83.1 * kRadPerDeg;
constexpr double kHeight_m = 1000.0;
constexpr double kSpeed_m_s = 50.0;
constexpr double kHeading_rad = 60.0 * kRadPerDeg;
constexpr double kAttack_rad = 0.05;
constexpr std::array<double, 3> kWind_N_m_s{4.0, -3.0, 0.0};

// Point samples of an instrument that vibrates: what it adds to one sample is white from sample to sample.
constexpr double kGyroBias_rad_s = 7.2 * kDegPerHour_rad_s;
constexpr double kGyroInRun_rad_s = 2.0 * kDegPerHour_rad_s;
constexpr double kGyroNoise_rad_s = 50.0 * kDegPerHour_rad_s;
constexpr double kGyroScale = 5e-3;
constexpr double kMisalignment_rad = 2e-3;
constexpr double kAccelBias_m_s2 = 21.0 * kMilliG_m_s2;
constexpr double kAccelInRun_m_s2 = 1.5 * kMilliG_m_s2;
constexpr double kAccelNoise_m_s2 = 20.0 * kMilliG_m_s2;
constexpr double kAccelScale = 3e-3;
constexpr double kInRun_s = 600.0;
constexpr double kCounts = 32768.0;
constexpr double kAccelRange_m_s2 = 2000.0 * kMilliG_m_s2;
constexpr double kGyroRange_rad_s = 100.0 * kRadPerDeg;

constexpr double kGpsDrift_m = 1.8;
constexpr double kGpsDriftDown_m = 3.0;
constexpr double kGpsDrift_s = 120.0;
constexpr double kGpsNoise_m = 0.4;
constexpr double kGpsNoiseDown_m = 0.7;
constexpr double kGpsVelocity_m_s = 0.05;
constexpr double kGpsVelocityDown_m_s = 0.1;
constexpr std::array<double, 3> kGpsLever_B_m{0.5, 0.0, -0.8};

constexpr std::array<double, 3> kStartPosition_m{2.0, 2.0, 4.0};
constexpr std::array<double, 3> kStartVelocity_m_s{0.2, 0.2, 0.3};
constexpr std::array<double, 3> kStartAttitude_rad{1.0 * kRadPerDeg, 1.0 * kRadPerDeg, 3.0 * kRadPerDeg};

/// Course less heading of an aircraft in a wind of a fifth of its speed.
constexpr double kCrab_rad = 11.5 * kRadPerDeg;

constexpr double kClimb_s = 250.0;
constexpr double kBank_s = 500.0;
constexpr double kDutchRoll_s = 550.0;
/// GPS goes when the Dutch roll has grown and the aircraft rolls fastest: what is then held on to is worst.
constexpr double kInDutchRoll_s = 555.0;

constexpr std::array<FlightCase, kFlightCases> kCases{{
    {.name = "climb_10s", .outage_at_s = kClimb_s, .scored_after_s = 10.0},
    {.name = "bank_10s", .outage_at_s = kBank_s, .scored_after_s = 10.0},
    {.name = "dutch_10s", .outage_at_s = kInDutchRoll_s, .scored_after_s = 10.0},
    {.name = "climb_20s", .outage_at_s = kClimb_s, .scored_after_s = 20.0},
    {.name = "bank_20s", .outage_at_s = kBank_s, .scored_after_s = 20.0},
    {.name = "dutch_20s", .outage_at_s = kInDutchRoll_s, .scored_after_s = 20.0},
    {.name = "aided"},
    {.name = "late_0.1s", .outage_at_s = kBank_s, .scored_after_s = 10.0, .gps_late_s = 0.1},
    {.name = "random", .random = true},
}};

double per_root_second(double of_a_sample) {
  return of_a_sample / std::sqrt(kFlightImu_hz);
}

}  // namespace

std::span<const FlightCase, kFlightCases> flight_cases() {
  return kCases;
}

sim::Scenario flight_scenario() {
  sim::Scenario s;
  s.name = "gps_outage";
  s.duration_s = kFlight_s;
  s.environment.surface_altitude_m = 0.0;
  s.environment.water_depth_m = 0.0;
  s.environment.wind_N_m_s = {kWind_N_m_s[0], kWind_N_m_s[1]};
  s.environment.turbulence_m_s = 0.4;
  s.environment.turbulence_tau_s = 1.5;
  s.start.latitude_rad = kLatitude_rad;
  s.start.longitude_rad = kLongitude_rad;
  s.start.depth_m = -kHeight_m;
  s.start.speed_m_s = kSpeed_m_s;
  s.start.rpy_rad = {0.0, kAttack_rad, kHeading_rad};
  s.vehicle.kind = sim::VehicleConfig::Kind::aircraft;
  s.vehicle.aircraft.dutch_roll_period_s = 3.0;

  const auto order = [&](double at_s) -> sim::MissionStep& {
    sim::MissionStep& step = s.mission.emplace_back();
    step.at_s = at_s;
    return step;
  };
  sim::MissionStep& first = order(0.0);
  first.speed_m_s = kSpeed_m_s;
  first.heading_rad = kHeading_rad;
  first.depth_m = -kHeight_m;
  first.bank_rad = 0.0;
  first.dutch_roll_rad = 0.0;
  // A square, then a circle with a climb between them.
  double heading = kHeading_rad;
  const auto turn_at = [&](double at_s) -> sim::MissionStep& {
    heading = geo::wrap_pi(heading + 90.0 * kRadPerDeg);
    sim::MissionStep& step = order(at_s);
    step.heading_rad = heading;
    step.bank_rad = 0.0;
    return step;
  };
  for (double t = 30.0; t < 240.0; t += 45.0) (void)turn_at(t);
  order(kClimb_s).depth_m = -kHeight_m - 300.0;
  (void)turn_at(305.0);
  order(330.0).bank_rad = 25.0 * kRadPerDeg;
  (void)turn_at(410.0);
  (void)turn_at(450.0);
  order(kBank_s).bank_rad = 45.0 * kRadPerDeg;
  (void)turn_at(525.0);
  order(kDutchRoll_s).dutch_roll_rad = 35.0 * kRadPerDeg;
  order(580.0).dutch_roll_rad = 0.0;
  for (double t = 600.0; t < 760.0; t += 45.0) (void)turn_at(t);
  order(770.0).bank_rad = -25.0 * kRadPerDeg;
  (void)turn_at(850.0);

  sim::ImuConfig& imu = s.sensors.of<ImuSample>();
  imu.enabled = true;
  imu.rate_hz = kFlightImu_hz;
  imu.increments = false;
  imu.gyro.bias_sigma = kGyroBias_rad_s;
  imu.gyro.instability_sigma = kGyroInRun_rad_s;
  imu.gyro.vibration_sigma = kGyroNoise_rad_s;
  imu.gyro.scale_sigma = kGyroScale;
  imu.gyro.range = kGyroRange_rad_s;
  imu.accelerometer.bias_sigma = kAccelBias_m_s2;
  imu.accelerometer.instability_sigma = kAccelInRun_m_s2;
  imu.accelerometer.vibration_sigma = kAccelNoise_m_s2;
  imu.accelerometer.scale_sigma = kAccelScale;
  imu.accelerometer.range = kAccelRange_m_s2;
  for (sim::TriadConfig* triad :
       {static_cast<sim::TriadConfig*>(&imu.gyro), static_cast<sim::TriadConfig*>(&imu.accelerometer)}) {
    triad->instability_tau_s = kInRun_s;
    triad->misalignment_sigma_rad = kMisalignment_rad;
    triad->quantum = triad->range / kCounts;
  }

  sim::GpsConfig& gps = s.sensors.of<GpsSample>();
  gps.enabled = true;
  gps.rate_hz = 2.0;
  gps.phase_s = 0.5;
  gps.lever_B_m = kGpsLever_B_m;
  gps.position_sigma_m = kGpsNoise_m;
  gps.altitude_sigma_m = kGpsNoiseDown_m;
  gps.correlated_sigma_m = kGpsDrift_m;
  gps.correlated_altitude_sigma_m = kGpsDriftDown_m;
  gps.correlated_tau_s = kGpsDrift_s;
  gps.velocity_sigma_m_s = kGpsVelocity_m_s;
  gps.velocity_down_sigma_m_s = kGpsVelocityDown_m_s;
  return s;
}

std::vector<sim::Window> draw_outages(std::uint64_t seed) {
  sim::Random random(seed, "outages");
  std::vector<sim::Window> out;
  for (double t = random.uniform(150.0, 200.0); t < kFlight_s - 65.0;) {
    const double length = random.uniform(5.0, 60.0);
    out.push_back({t, t + length});
    t += length + random.uniform(40.0, 60.0);
  }
  return out;
}

estimation::InitialState draw_flight_start(std::uint64_t seed) {
  sim::Random random(seed, "start");
  const auto draw = [&](const std::array<double, 3>& sigma) {
    const double x = random.normal(sigma[0]);
    const double y = random.normal(sigma[1]);
    const double z = random.normal(sigma[2]);
    return Eigen::Vector3d(x, y, z);
  };
  estimation::InitialState start;
  const Eigen::Vector3d rpy(0.0, kAttack_rad, kHeading_rad);
  const Eigen::Matrix3d c = geo::to_matrix(geo::from_rpy(rpy));
  const Eigen::Vector3d v_N_m_s = c * Eigen::Vector3d(kSpeed_m_s, 0.0, 0.0) + geo::vec(kWind_N_m_s);
  // The estimators begin with the first inertial sample.
  const geo::Geodetic place = geo::moved_by({kLatitude_rad, kLongitude_rad, kHeight_m},
                                            v_N_m_s / kFlightImu_hz + draw(kStartPosition_m));
  start.latitude_rad = place.latitude_rad;
  start.longitude_rad = place.longitude_rad;
  start.altitude_m = place.altitude_m;
  start.velocity_N_m_s = geo::arr(v_N_m_s + draw(kStartVelocity_m_s));
  start.rpy_rad = geo::arr(rpy + draw(kStartAttitude_rad));
  start.position_sigma_N_m = kStartPosition_m;
  start.velocity_sigma_N_m_s = kStartVelocity_m_s;
  start.attitude_sigma_rad = kStartAttitude_rad;
  return start;
}

estimation::EngineConfig flight_config(FlightFilter filter, double gps_latency_s) {
  estimation::EngineConfig c;
  c.configuration = filter == FlightFilter::ekf15   ? "gps_ins15"
                    : filter == FlightFilter::ekf24 ? "gps_ins24"
                                                    : "gps_ins36";
  (void)estimation::named_state_groups(c.configuration, c.groups);
  // The published filters consider nothing beyond their states.
  if (filter == FlightFilter::ekf15 || filter == FlightFilter::ekf24) c.left_out = estimation::LeftOut::noise;
  estimation::ImuConfig& imu = c.imu;
  imu.rate_convention = estimation::RateConvention::point;
  imu.nominal_rate_hz = kFlightImu_hz;
  imu.angle_random_walk_rad_sqrt_s = per_root_second(kGyroNoise_rad_s);
  imu.velocity_random_walk_m_s_sqrt_s = per_root_second(kAccelNoise_m_s2);
  imu.gyro_bias_sigma_rad_s = kGyroBias_rad_s;
  imu.gyro_bias_instability_rad_s = kGyroInRun_rad_s;
  imu.gyro_bias_time_constant_s = kInRun_s;
  imu.accel_bias_sigma_m_s2 = kAccelBias_m_s2;
  imu.accel_bias_instability_m_s2 = kAccelInRun_m_s2;
  imu.accel_bias_time_constant_s = kInRun_s;
  imu.gyro_scale_sigma = kGyroScale;
  imu.accel_scale_sigma = kAccelScale;
  imu.gyro_misalignment_sigma_rad = kMisalignment_rad;
  imu.accel_misalignment_sigma_rad = kMisalignment_rad;
  c.states.gps_bias_sigma_m = kGpsDrift_m;
  c.states.gps_bias_time_constant_s = kGpsDrift_s;
  c.alignment.mode = estimation::StartMode::given;
  c.forecast_limits = {{"horizontal_100m", 100.0}};

  auto gps = estimation::default_sensor(SourceKind::gps, "gps");
  gps.lever_B_m = kGpsLever_B_m;
  gps.latency_s = gps_latency_s;
  // Where the slow error is no state it is noise.
  const bool state = c.groups.gps_position_bias;
  const double level = state ? kGpsNoise_m : std::hypot(kGpsNoise_m, kGpsDrift_m);
  gps.sigma = {level, level, state ? kGpsNoiseDown_m : std::hypot(kGpsNoiseDown_m, kGpsDriftDown_m)};
  gps.velocity_sigma_m_s = {kGpsVelocity_m_s, kGpsVelocity_m_s, kGpsVelocityDown_m_s};
  gps.use_sample_sigma = false;
  c.sensors = {gps};
  return c;
}

estimation::EngineConfig begun_in_flight(estimation::EngineConfig config) {
  config.alignment.mode = estimation::StartMode::in_motion;
  config.alignment.in_motion_heading_sigma_rad = kCrab_rad;
  return config;
}

fixed_gain::Navigator::Config flight_config(fixed_gain::OutageMode mode) {
  fixed_gain::Navigator::Config c;
  c.outage = mode;
  c.position_sigma_m = std::hypot(kGpsNoise_m, kGpsDrift_m);
  c.velocity_sigma_m_s = kGpsVelocity_m_s;
  // As published it knows of no lever. No instrument error is a state of it: all of them are noise.
  c.angle_walk_rad_sqrt_s = kGyroBias_rad_s + per_root_second(kGyroNoise_rad_s);
  c.velocity_walk_m_s_sqrt_s = kAccelBias_m_s2 + per_root_second(kAccelNoise_m_s2);
  return c;
}

}  // namespace fathom::study
