#include "study/rotating_arm/rotating_arm_rig.hpp"

#include <array>
#include <cmath>

#include "sim/random.hpp"
#include "study/instruments.hpp"

namespace fathom::study {
namespace {

// Along x and y the noise is 0.3 cm/s at 0.5 m/s and 0.8 cm/s at 3 m/s.
constexpr DvlNoise kDvl{.beam_m_s = 0.0020, .beam_per_speed = 0.00177};
constexpr double kDvlScale = 0.004;
constexpr double kDvlBias_m_s = 0.004;
constexpr double kDvlMisalignment_rad = 0.5 * kRadPerDeg;
constexpr std::array<double, 3> kDvlLever_B_m{0.3, 0.1, 0.2};
// Magnetic compass in a steel hall: A + B sin psi + D sin 2 psi.
constexpr double kCompassA_rad = 1.0 * kRadPerDeg;
constexpr double kCompassB_rad = 8.0 * kRadPerDeg;
constexpr double kCompassD_rad = 3.0 * kRadPerDeg;
constexpr double kCompassNoise_rad = 0.3 * kRadPerDeg;
constexpr double kCompassAccuracy_rad = 0.5 * kRadPerDeg;  // as its data sheet has it
// What a filter assumes whose states hold the curve: while the curve is still being learned, its slope enters
// the rows with errors that would feign knowledge of the heading (STUDY-3).
constexpr double kCompassFilter_rad = 2.0 * kRadPerDeg;
constexpr double kDepthNoise_m = 0.01;
constexpr double kDepthBias_m = 0.05;

constexpr double kSurface_m = 60.0;
constexpr double kDepth_m = 1.0;
constexpr double kHeading_rad = 20.0 * kRadPerDeg;
constexpr double kHeadingSigma_rad = 0.5 * kRadPerDeg;
constexpr double kPositionSigma_m = 0.01;
constexpr double kLatitude_rad = 45.76 * kRadPerDeg;
constexpr double kLongitude_rad = 126.68 * kRadPerDeg;

constexpr std::array<ArmCase, kArmCases> kCases{{
    {.name = "speed_0.5", .speed_m_s = 0.5},
    {.name = "speed_1.0", .speed_m_s = 1.0},
    {.name = "speed_1.5"},
    {.name = "speed_2.0", .speed_m_s = 2.0},
    {.name = "speed_2.5", .speed_m_s = 2.5},
    {.name = "speed_3.0", .speed_m_s = 3.0},
    {.name = "dvl_1hz", .dvl_hz = 1.0},
    {.name = "dvl_0.5hz", .dvl_hz = 0.5},
    {.name = "dvl_0.2hz", .dvl_hz = 0.2},
    {.name = "imu_20hz", .imu_every = 5},
    {.name = "imu_10hz", .imu_every = 10},
    {.name = "imu_4hz", .imu_every = 25},
    {.name = "outliers_3pct", .outlier_probability = 0.03},
    {.name = "dropout_60s", .dropout_s = 60.0},
}};

}  // namespace

std::span<const ArmCase, kArmCases> arm_cases() {
  return kCases;
}

sim::Scenario arm_scenario(const ArmCase& one, Instruments instruments) {
  const double real = instruments == Instruments::real ? 1.0 : 0.0;
  sim::Scenario s;
  s.name = "rotating_arm";
  s.duration_s = kArmDuration_s;
  s.environment.surface_altitude_m = kSurface_m;
  s.environment.water_depth_m = 7.0;
  s.start.latitude_rad = kLatitude_rad;
  s.start.longitude_rad = kLongitude_rad;
  s.start.depth_m = kDepth_m;
  s.start.rpy_rad = {0.0, 0.0, kHeading_rad};
  s.vehicle.kind = sim::VehicleConfig::Kind::rotating_arm;
  s.mission.resize(2);
  s.mission[0].speed_m_s = 0.0;
  s.mission[1].at_s = kArmRest_s;
  s.mission[1].speed_m_s = one.speed_m_s;

  s.sensors.of<ImuSample>() = simulated(kTactical, real);

  // Aiding falls on inertial samples: what is between them is another study's question.
  sim::DvlConfig& dvl = s.sensors.of<DvlSample>();
  dvl = simulated(kDvl, real);
  dvl.rate_hz = one.dvl_hz;
  dvl.phase_s = 1.0 / one.dvl_hz;
  dvl.lever_B_m = kDvlLever_B_m;
  dvl.scale_sigma = real * kDvlScale;
  dvl.bias_sigma_m_s = real * kDvlBias_m_s;
  dvl.misalignment_sigma_rad = real * kDvlMisalignment_rad;
  dvl.outlier_probability = real * one.outlier_probability;
  if (one.dropout_s > 0.0) dvl.dropouts.push_back({300.0, 300.0 + one.dropout_s});

  sim::HeadingConfig& heading = s.sensors.of<HeadingSample>();
  heading.enabled = true;
  heading.rate_hz = 5.0;
  heading.phase_s = 0.2;
  heading.sigma_rad = real * kCompassNoise_rad;
  heading.deviation_rad = {real * kCompassA_rad, real * kCompassB_rad, 0.0, real * kCompassD_rad, 0.0};

  sim::DepthConfig& depth = s.sensors.of<DepthSample>();
  depth.enabled = true;
  depth.rate_hz = 5.0;
  depth.phase_s = 0.2;
  depth.sigma_m = real * kDepthNoise_m;
  depth.bias_sigma_m = real * kDepthBias_m;
  return s;
}

ArmStart::ArmStart()
    : position{kLatitude_rad, kLongitude_rad, kSurface_m - kDepth_m}, heading_rad(kHeading_rad) {}

ArmStart draw_start(std::uint64_t seed) {
  sim::Random random(seed, "start");
  ArmStart start;
  const double north = random.normal(kPositionSigma_m);
  const double east = random.normal(kPositionSigma_m);
  const double down = random.normal(kPositionSigma_m);
  start.position = geo::moved_by(start.position, {north, east, down});
  start.heading_rad += random.normal(kHeadingSigma_rad);
  return start;
}

estimation::EngineConfig arm_config(const ArmCase& one, ArmFilter filter, const ArmStart& start) {
  using estimation::EngineConfig;
  const bool published = filter == ArmFilter::hybrid25;
  EngineConfig c;
  const bool states25 = published || filter == ArmFilter::hybrid25_equal;
  c.configuration = filter == ArmFilter::imu_only ? "gps_ins15" : states25 ? "hybrid25" : "full";
  (void)estimation::named_state_groups(c.configuration, c.groups);
  // The published filter considers nothing beyond its states.
  if (states25) c.left_out = estimation::LeftOut::noise;
  if (filter == ArmFilter::full || filter == ArmFilter::bound) {
    // A basin has neither current nor GPS; the Doppler log's own offset is in its data sheet.
    c.groups.current = c.groups.gps_position_bias = c.groups.usbl_bias = false;
    c.groups.dvl_bias = true;
  }

  estimation::ImuConfig& imu = c.imu;
  imu.nominal_rate_hz = 100.0 / one.imu_every;
  imu.max_gap_s = 1.0;
  tell(imu, kTactical, published ? ImuModelling::biases : ImuModelling::everything);

  estimation::StateModelConfig& states = c.states;
  states.dvl_scale_sigma = kDvlScale;
  states.dvl_bias_sigma_m_s = kDvlBias_m_s;
  states.dvl_misalignment_sigma_rad = kDvlMisalignment_rad;
  states.depth_bias_sigma_m = kDepthBias_m;
  states.surface_altitude_m = kSurface_m;
  states.surface_altitude_sigma_m = kDepthBias_m;
  states.surface_altitude_walk_m_sqrt_s = 0.0;
  states.heading_bias_sigma_rad = 2.0 * kRadPerDeg;
  states.heading_bias_time_constant_s = 0.0;
  states.heading_deviation_sigma_rad = 5.0 * kRadPerDeg;

  estimation::AlignmentConfig& alignment = c.alignment;
  alignment.mode = estimation::StartMode::at_rest;
  alignment.heading_source = estimation::HeadingSource::given;
  alignment.given_heading_rad = start.heading_rad;
  alignment.given_heading_sigma_rad = kHeadingSigma_rad;
  alignment.rest_velocity_sigma_m_s = 1e-3;
  alignment.tilt_sigma_floor_rad = 5e-5;
  alignment.position_given = true;
  alignment.given_latitude_rad = start.position.latitude_rad;
  alignment.given_longitude_rad = start.position.longitude_rad;
  alignment.given_altitude_m = start.position.altitude_m;
  alignment.position_sigma_m = kPositionSigma_m;
  c.zero_velocity_sigma_m_s = 1e-3;
  if (filter == ArmFilter::imu_only) return c;

  auto dvl = told(kDvl, kDvlLever_B_m);
  auto depth = estimation::default_sensor(SourceKind::depth, "depth");
  depth.sigma = {kDepthNoise_m, kDepthNoise_m, kDepthNoise_m};
  auto compass = estimation::default_sensor(SourceKind::heading, "heading");
  double compass_sigma = kCompassFilter_rad;
  if (published) compass_sigma = kCompassAccuracy_rad;
  if (filter == ArmFilter::bound) compass_sigma = kCompassNoise_rad;
  compass.sigma = {compass_sigma, compass_sigma, compass_sigma};
  // The printed measurement of the Doppler log is that of the velocity of the IMU.
  if (published) dvl.lever_B_m = {0.0, 0.0, 0.0};
  // Beyond 3 sigma a ping is doubted; nearer, every one has its full weight, as the noise is Gaussian.
  dvl.robust = estimation::RobustKind::huber;
  dvl.robust_parameter = 3.0;
  c.sensors = {dvl, depth, compass};
  for (auto& sensor : c.sensors) {
    sensor.frozen_change = 0.0;  // on a circle at constant speed readings may well repeat
    if (published || filter == ArmFilter::bound) believe_everything(sensor);
  }
  return c;
}

}  // namespace fathom::study
