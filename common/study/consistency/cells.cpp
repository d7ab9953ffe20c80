#include "study/consistency/cells.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "sim/random.hpp"
#include "study/consistency/motions.hpp"
#include "study/instruments.hpp"

namespace fathom::study {
namespace {

using estimation::EngineConfig;
using estimation::HeadingSource;
using estimation::StartMode;

constexpr double kDive_s = 180.0;

constexpr GpsFigures kMarineGps{};
/// An aircraft crabs.
constexpr double kAirborneCourse_rad = 15.0 * kRadPerDeg;

// What a state that is given is known to.
constexpr std::array<double, 3> kGivenPosition_m{2.0, 2.0, 4.0};
constexpr std::array<double, 3> kGivenVelocity_m_s{0.2, 0.2, 0.2};
constexpr std::array<double, 3> kGivenAttitude_rad{1.0 * kRadPerDeg, 1.0 * kRadPerDeg, 3.0 * kRadPerDeg};

Cell submersible(std::string_view name, Manoeuvres (*motion)(std::uint64_t), CellStart start,
                 const ImuGrade& grade, double latitude_deg) {
  return {.name = name,
          .motion = motion,
          .start = start,
          .inertial = &grade,
          .latitude_deg = latitude_deg,
          .height_m = kSurfaceHeight_m - 0.2,
          .duration_s = 900.0,
          .under_water = true,
          .outage_from_s = kDive_s,
          .forecast_at_s = 600.0,
          .gps = kMarineGps};
}

Cell boat(std::string_view name, const ImuGrade& grade, double latitude_deg) {
  Cell cell = submersible(name, motions::boat_in_swell, CellStart::under_way, grade, latitude_deg);
  cell.duration_s = 480.0;
  cell.outage_from_s = cell.forecast_at_s = 420.0;
  return cell;
}

Cell aircraft(std::string_view name, Manoeuvres (*motion)(std::uint64_t), CellStart start,
              const ImuGrade& grade, double latitude_deg, double height_m = 800.0) {
  return {.name = name,
          .motion = motion,
          .start = start,
          .inertial = &grade,
          .latitude_deg = latitude_deg,
          .height_m = height_m,
          .duration_s = 480.0,
          .outage_from_s = 420.0,
          .forecast_at_s = 420.0,
          .gps = kAirborneGps};
}

Cell car(std::string_view name, Manoeuvres (*motion)(std::uint64_t), CellStart start, const ImuGrade& grade,
         double latitude_deg) {
  Cell cell = aircraft(name, motion, start, grade, latitude_deg, 300.0);
  return cell;
}

Cell on_wheels(Cell cell) {
  cell.on_wheels = true;
  return cell;
}

const std::array<Cell, 29>& cells() {
  using namespace motions;
  static const std::array<Cell, 29> all{
      submersible("auv_straight_tactical", survey_straight, CellStart::at_rest, kTacticalGrade, 36.0),
      submersible("auv_straight_industrial", survey_straight, CellStart::at_rest, kIndustrialGrade, 0.5),
      submersible("auv_lawn_navigation", survey_lawn, CellStart::given, kNavigation, 55.0),
      submersible("auv_lawn_tactical", survey_lawn, CellStart::at_rest, kTacticalGrade, 36.0),
      submersible("auv_lawn_tactical_arctic", survey_lawn, CellStart::at_rest, kTacticalGrade, 78.0),
      submersible("auv_lawn_industrial", survey_lawn, CellStart::at_rest, kIndustrialGrade, -35.0),
      submersible("auv_yoyo_tactical", survey_yoyo, CellStart::at_rest, kTacticalGrade, 20.0),
      submersible("auv_yoyo_industrial", survey_yoyo, CellStart::at_rest, kIndustrialGrade, -60.0),
      submersible("auv_under_way_tactical", survey_under_way, CellStart::under_way, kTacticalGrade, 36.0),
      submersible("auv_under_way_industrial", survey_under_way, CellStart::under_way, kIndustrialGrade, 50.0),
      boat("boat_swell_tactical", kTacticalGrade, 58.0),
      boat("boat_swell_consumer", kConsumerGrade, -10.0),
      aircraft("plane_straight_tactical", flight_straight, CellStart::in_motion, kTacticalGrade, 48.0),
      aircraft("plane_straight_consumer", flight_straight, CellStart::in_motion, kConsumerGrade, -20.0),
      aircraft("plane_circuit_navigation", flight_circuit, CellStart::given, kNavigation, 70.0, 8000.0),
      aircraft("plane_circuit_tactical", flight_circuit, CellStart::in_motion, kTacticalGrade, 40.0, 3000.0),
      aircraft("plane_circuit_industrial", flight_circuit, CellStart::in_motion, kIndustrialGrade, -45.0),
      aircraft("plane_circuit_consumer", flight_circuit, CellStart::in_motion, kConsumerGrade, 5.0),
      aircraft("plane_banks_industrial", flight_banks, CellStart::given, kIndustrialGrade, 40.0),
      aircraft("plane_banks_consumer", flight_banks, CellStart::in_motion, kConsumerGrade, 52.0),
      aircraft("plane_aerobatic_industrial", flight_aerobatic, CellStart::in_motion, kIndustrialGrade, 47.0),
      aircraft("plane_runway_tactical", flight_from_runway, CellStart::at_rest, kTacticalGrade, 35.0, 100.0),
      car("car_town_consumer", drive_town, CellStart::in_motion, kConsumerGrade, 30.0),
      car("car_highway_navigation", drive_highway, CellStart::gyrocompass, kNavigation, 55.0),
      car("car_highway_tactical", drive_highway, CellStart::at_rest, kTacticalGrade, 50.0),
      car("car_mountain_industrial", drive_mountain, CellStart::in_motion, kIndustrialGrade, 46.0),
      on_wheels(car("wheels_town_consumer", roll_through_town, CellStart::in_motion, kConsumerGrade, 30.0)),
      on_wheels(car("wheels_highway_tactical", roll_on_highway, CellStart::at_rest, kTacticalGrade, 50.0)),
      on_wheels(car("wheels_mountain_industrial", roll_in_mountains, CellStart::in_motion, kIndustrialGrade,
                    46.0))};
  return all;
}

estimation::SensorConfig told_gps(const Cell& cell) {
  auto gps = estimation::default_sensor(SourceKind::gps, "gps");
  gps.lever_B_m = cell.gps.lever_B_m;
  const double level = cell.gps.noise_m;
  gps.sigma = {level, level, 2.0 * level};
  gps.velocity_sigma_m_s = {cell.gps.velocity_m_s, cell.gps.velocity_m_s, 2.0 * cell.gps.velocity_m_s};
  gps.use_sample_sigma = false;
  return gps;
}

estimation::SensorConfig told_dvl(const DvlFigures& figures) {
  auto dvl = estimation::default_sensor(SourceKind::dvl, "dvl");
  dvl.lever_B_m = figures.lever_B_m;
  dvl.sigma = {figures.noise_m_s, figures.noise_m_s, figures.noise_m_s};
  dvl.proportional_sigma = figures.per_speed;
  return dvl;
}

/// As deploy/config/solve/mems_car.json has it. Springs swing in step with the force that makes them swing: a
/// scale of the accelerometers that is not estimated passes for a velocity.
void tell_wheels(EngineConfig& config) {
  config.groups.accel_scale = config.groups.mount_angles = config.groups.mount_lever = true;
  config.states.mount_angle_sigma_rad = motions::kWheelsAskew_rad;
  config.states.mount_lever_sigma_m = motions::kAxleKnown_m;
  estimation::NonHolonomicConfig& wheels = config.constraints.non_holonomic;
  wheels.enabled = true;
  wheels.lever_B_m = {-motions::kAheadOfAxle_m, 0.0, 0.0};
  wheels.lateral_sigma_m_s = wheels.vertical_sigma_m_s = motions::kWheels_m_s;
  wheels.slip_time_s = motions::kWheelsLast_s;
}

void tell_start(const Cell& cell, estimation::AlignmentConfig& alignment) {
  switch (cell.start) {
    case CellStart::at_rest:
      alignment.mode = StartMode::at_rest;
      alignment.heading_source = HeadingSource::compass;
      break;
    case CellStart::gyrocompass:
      alignment.mode = StartMode::at_rest;
      alignment.heading_source = HeadingSource::gyrocompass;
      break;
    case CellStart::in_motion:
      alignment.mode = StartMode::in_motion;
      break;
    case CellStart::under_way:
      alignment.mode = StartMode::automatic;
      alignment.heading_source = HeadingSource::compass;
      alignment.in_motion_speed_m_s = 20.0;
      break;
    case CellStart::given:
      alignment.mode = StartMode::given;
      break;
  }
  alignment.averaging_s = 30.0;
  alignment.compass_sigma_rad = std::hypot(kCompass.bias_rad, kCompass.noise_rad);
  // An aircraft crabs.
  if (!cell.under_water) alignment.in_motion_heading_sigma_rad = kAirborneCourse_rad;
}

}  // namespace

std::span<const Cell> consistency_cells() {
  return cells();
}

EngineConfig consistency_config(const Cell& cell, std::string_view configuration) {
  EngineConfig c;
  c.configuration = configuration;
  (void)estimation::named_state_groups(c.configuration, c.groups);
  tell(c.imu, *cell.inertial, ImuModelling::everything);
  c.imu.nominal_rate_hz = cell.imu_rate_hz;
  tell_start(cell, c.alignment);
  c.forecast_limits.clear();
  if (cell.on_wheels) tell_wheels(c);

  estimation::StateModelConfig& states = c.states;
  states.gps_bias_sigma_m = cell.gps.drift_m;
  states.gps_bias_time_constant_s = cell.gps.drift_s;
  states.dvl_scale_sigma = cell.dvl.scale;
  states.dvl_bias_sigma_m_s = cell.dvl.bias_m_s;
  states.dvl_misalignment_sigma_rad = cell.dvl.misalignment_rad;
  states.heading_bias_sigma_rad = kCompass.bias_rad;
  states.heading_bias_time_constant_s = 0.0;
  states.depth_bias_sigma_m = kDepthGauge.bias_m;
  states.surface_altitude_m = kSurfaceHeight_m;
  states.surface_altitude_sigma_m = 5.0;

  c.sensors = {told_gps(cell)};
  const bool compass = cell.under_water || cell.start == CellStart::at_rest;
  if (compass) {
    auto heading = estimation::default_sensor(SourceKind::heading, "heading");
    heading.sigma = {kCompass.noise_rad, kCompass.noise_rad, kCompass.noise_rad};
    c.sensors.push_back(heading);
  }
  if (cell.under_water) {
    c.sensors.push_back(told_dvl(cell.dvl));
    auto depth = estimation::default_sensor(SourceKind::depth, "depth");
    depth.sigma = {kDepthGauge.noise_m, kDepthGauge.noise_m, kDepthGauge.noise_m};
    c.sensors.push_back(depth);
  }
  return c;
}

std::optional<estimation::InitialState> draw_given_start(const Cell& cell, const Pose& truth,
                                                         std::uint64_t seed) {
  if (cell.start != CellStart::given) return std::nullopt;
  sim::Random random(seed, "given start");
  const auto draw = [&](const std::array<double, 3>& sigma) {
    const double x = random.normal(sigma[0]);
    const double y = random.normal(sigma[1]);
    const double z = random.normal(sigma[2]);
    return Eigen::Vector3d(x, y, z);
  };
  const Eigen::Vector3d position = draw(kGivenPosition_m);
  const Eigen::Vector3d velocity = truth.velocity_N_m_s + draw(kGivenVelocity_m_s);
  const Eigen::Vector3d turn = draw(kGivenAttitude_rad);
  const ecef::Geodetic place = ecef::moved(truth.place, position);
  const Eigen::Matrix3d axes =
      Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * truth.axes_NB;
  estimation::InitialState start;
  start.latitude_rad = place.latitude_rad;
  start.longitude_rad = place.longitude_rad;
  start.altitude_m = place.height_m;
  start.velocity_N_m_s = {velocity.x(), velocity.y(), velocity.z()};
  start.rpy_rad = {std::atan2(axes(2, 1), axes(2, 2)), std::asin(-axes(2, 0)),
                   std::atan2(axes(1, 0), axes(0, 0))};
  start.position_sigma_N_m = kGivenPosition_m;
  start.velocity_sigma_N_m_s = kGivenVelocity_m_s;
  start.attitude_sigma_rad = kGivenAttitude_rad;
  return start;
}

}  // namespace fathom::study
