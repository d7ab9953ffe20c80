#include "study/survey/survey_rig.hpp"

#include <array>
#include <cmath>

#include "sim/random.hpp"
#include "study/instruments.hpp"
#include "study/survey/survey_usbl.hpp"

namespace fathom::study {
namespace {

constexpr DvlNoise kDvl{.beam_m_s = 0.003, .beam_per_speed = 0.001};
constexpr double kDvlScale = 0.004;
constexpr double kDvlBias_m_s = 0.001;
constexpr double kDvlMisalignment_rad = 0.5 * kRadPerDeg;
constexpr std::array<double, 3> kDvlLever_B_m{0.5, 0.0, 0.2};
constexpr std::array<double, 3> kGpsLever_B_m{0.0, 0.0, -0.4};
constexpr double kGpsNoise_m = 0.5;
constexpr double kGpsDrift_m = 1.0;
constexpr double kGpsDrift_s = 300.0;
constexpr double kGpsVelocity_m_s = 0.03;
constexpr double kGpsRate_hz = 5.0;
// Where instruments of the same grade are less kind.
constexpr double kUnkindGpsVelocity_m_s = 0.1;
constexpr double kUnkindGpsRate_hz = 1.0;
constexpr double kUnkindAccelDrift_m_s2 = 0.3 * kMilliG_m_s2;
// Deviation of a magnetic compass in the vehicle, A and each of B to E, 1 sigma.
constexpr double kCompassA_rad = 1.0 * kRadPerDeg;
constexpr double kCompassCurve_rad = 2.0 * kRadPerDeg;
constexpr double kCompassNoise_rad = 0.3 * kRadPerDeg;
constexpr double kCompassAccuracy_rad = 1.0 * kRadPerDeg;  // as its data sheet has it
constexpr double kCompassFilter_rad = 2.0 * kRadPerDeg;    // while the curve is being learned: STUDY-3
constexpr double kDepthNoise_m = 0.02;
constexpr double kDepthBias_m = 0.03;
constexpr std::array<double, 2> kCurrent_N_m_s{0.12, -0.18};

constexpr double kSurface_m = 18.5;
constexpr double kUnderWay_s = 60.0;
constexpr double kRunDepth_m = 15.0;
constexpr double kCourse_rad = 50.0 * kRadPerDeg;
constexpr double kOrder_m_s = 2.2;  // 2.0 through the water, after the drag of hull and fins
constexpr double kLeg_s = 290.0;
constexpr double kCrossing_s = 30.0;

constexpr std::array<SurveyCase, 17> kCases{{
    {.name = "tactical_straight"},
    {.name = "tactical_straight_less_kind", .less_kind = true},
    {.name = "tactical_straight_same_course", .surface = SurfaceLeg::same_course},
    {.name = "tactical_straight_course_90_off", .surface = SurfaceLeg::course_90_off},
    {.name = "tactical_straight_uncalibrated", .uncalibrated = true},
    {.name = "tactical_straight_3_sigma", .uncalibrated = true, .fault_sigma = 3.0},
    {.name = "tactical_lawn", .lawn = true},
    {.name = "tactical_lawn_uncalibrated", .lawn = true, .uncalibrated = true},
    {.name = "navigation_straight", .navigation_grade = true},
    {.name = "navigation_straight_uncalibrated", .navigation_grade = true, .uncalibrated = true},
    {.name = "navigation_lawn", .navigation_grade = true, .lawn = true},
    {.name = "navigation_lawn_uncalibrated", .navigation_grade = true, .lawn = true, .uncalibrated = true},
    {.name = "usbl_late_2s", .lawn = true, .usbl = true},
    {.name = "outliers_3pct", .lawn = true, .outlier_probability = 0.03},
    {.name = "beams_3", .lawn = true, .beams = 3},
    {.name = "beams_2", .lawn = true, .beams = 2},
    {.name = "water_track", .lawn = true, .water_track = true},
}};

void order(sim::Scenario& s, double at_s, double heading_rad, double speed_m_s = kUnknown,
           double depth_m = kUnknown) {
  sim::MissionStep step;
  step.at_s = at_s;
  step.heading_rad = heading_rad;
  step.speed_m_s = speed_m_s;
  step.depth_m = depth_m;
  s.mission.push_back(step);
}

ImuGrade grade_of(const SurveyCase& one) {
  ImuGrade grade = one.navigation_grade ? kNavigation : kTactical;
  if (one.less_kind) grade.accel_in_run_m_s2 = kUnkindAccelDrift_m_s2;
  return grade;
}

double gps_velocity_m_s(const SurveyCase& one) {
  return one.less_kind ? kUnkindGpsVelocity_m_s : kGpsVelocity_m_s;
}

double surface_course_rad(SurfaceLeg leg) {
  return leg == SurfaceLeg::course_90_off ? kCourse_rad - 90.0 * kRadPerDeg : kCourse_rad;
}

/// At rest, then under way. Turns both ways at two speeds show the compass curve and tell the scale of the
/// DVL from its offset.
void order_surface(sim::Scenario& s, SurfaceLeg leg) {
  const double course_rad = surface_course_rad(leg);
  order(s, 0.0, course_rad, 0.0, 0.0);
  order(s, kUnderWay_s, course_rad, kOrder_m_s);
  if (leg != SurfaceLeg::turns) return;
  double t = kUnderWay_s + 12.0;
  for (int quarter = 1; quarter <= 16; ++quarter, t += 14.0) {
    const double turned = quarter <= 8 ? quarter : 16 - quarter;
    order(s, t, kCourse_rad + 0.25 * turned * 360.0 * kRadPerDeg,
          quarter == 7    ? 1.2
          : quarter == 11 ? kOrder_m_s
                          : kUnknown);
  }
}

void order_lawn(sim::Scenario& s) {
  double t = kSurveyDive_s;
  for (int leg = 0; t < kSurveyDuration_s; ++leg) {
    order(s, t, kCourse_rad + (leg % 2 == 0 ? 0.0 : 180.0 * kRadPerDeg));
    t += kLeg_s;
    order(s, t, kCourse_rad + 90.0 * kRadPerDeg);
    t += kCrossing_s;
  }
}

}  // namespace

std::span<const SurveyCase> survey_cases() {
  return kCases;
}

sim::Scenario survey_scenario(const SurveyCase& one, std::uint64_t seed) {
  sim::Scenario s;
  s.name = "survey";
  s.duration_s = kSurveyDuration_s;
  s.environment.surface_altitude_m = kSurface_m;
  s.environment.water_depth_m = 60.0;
  s.environment.current_N_m_s = kCurrent_N_m_s;
  s.environment.current_from_s = kUnderWay_s - 5.0;  // the quay is sheltered
  s.environment.turbulence_m_s = 0.01;
  s.environment.turbulence_tau_s = 2.0;
  s.start.latitude_rad = 36.4 * kRadPerDeg;
  s.start.longitude_rad = 127.4 * kRadPerDeg;
  s.start.depth_m = 0.12;
  s.start.rpy_rad = {0.0, 0.0, surface_course_rad(one.surface)};
  order_surface(s, one.surface);
  if (one.lawn) {
    order_lawn(s);
  } else {
    order(s, kSurveyDive_s, kCourse_rad);
  }
  for (sim::MissionStep& step : s.mission)
    if (step.at_s == kSurveyDive_s) {
      step.depth_m = kRunDepth_m;
      step.speed_m_s = kOrder_m_s;
    }

  s.sensors.of<ImuSample>() = simulated(grade_of(one), 1.0);
  sim::GpsConfig& gps = s.sensors.of<GpsSample>();
  gps.enabled = true;
  gps.rate_hz = one.less_kind ? kUnkindGpsRate_hz : kGpsRate_hz;
  gps.lever_B_m = kGpsLever_B_m;
  gps.position_sigma_m = kGpsNoise_m;
  gps.altitude_sigma_m = 2.0 * kGpsNoise_m;
  gps.correlated_sigma_m = kGpsDrift_m;
  gps.correlated_altitude_sigma_m = 2.0 * kGpsDrift_m;
  gps.correlated_tau_s = kGpsDrift_s;
  gps.velocity_sigma_m_s = gps_velocity_m_s(one);
  gps.velocity_down_sigma_m_s = 2.0 * gps_velocity_m_s(one);
  gps.dropouts.push_back({kSurveyDive_s, kSurveyDuration_s});

  sim::DvlConfig& dvl = s.sensors.of<DvlSample>();
  dvl = simulated(kDvl, 1.0);
  dvl.rate_hz = 5.0;
  dvl.phase_s = kUnderWay_s + 5.0;  // switched on when the vehicle is out of the sheltered water
  dvl.lever_B_m = kDvlLever_B_m;
  dvl.bias_sigma_m_s = kDvlBias_m_s;
  if (one.uncalibrated) {
    const DvlFault fault = draw_dvl_fault(one, seed);
    dvl.scale = fault.scale;
    dvl.mounting_rpy_rad = {0.0, 0.0, fault.yaw_rad};
  } else {
    dvl.scale_sigma = kDvlScale;
    dvl.misalignment_sigma_rad = kDvlMisalignment_rad;
  }
  dvl.outlier_probability = one.outlier_probability;
  dvl.working_beams = one.beams;
  for (double t = kSurveyDive_s + 270.0; t < kSurveyDuration_s; t += 300.0)
    dvl.dropouts.push_back({t, t + 30.0});
  if (one.water_track) {
    dvl.water_track = true;
    dvl.maximum_range_m = 30.0;
  }

  sim::Random random(seed, "compass of the vehicle");
  sim::HeadingConfig& heading = s.sensors.of<HeadingSample>();
  heading.enabled = true;
  heading.rate_hz = 1.0;
  heading.sigma_rad = kCompassNoise_rad;
  for (std::size_t i = 0; i < heading.deviation_rad.size(); ++i)
    heading.deviation_rad[i] = random.normal(i == 0 ? kCompassA_rad : kCompassCurve_rad);

  sim::DepthConfig& depth = s.sensors.of<DepthSample>();
  depth.enabled = true;
  depth.rate_hz = 1.0;
  depth.sigma_m = kDepthNoise_m;
  depth.bias_sigma_m = kDepthBias_m;

  if (one.usbl) add_survey_usbl(s);
  return s;
}

DvlFault draw_dvl_fault(const SurveyCase& one, std::uint64_t seed) {
  if (!one.uncalibrated) return {};
  if (one.fault_sigma != 0.0)
    return {one.fault_sigma * kUncalibratedScale, one.fault_sigma * kUncalibratedYaw_rad};
  sim::Random random(seed, "calibration of the Doppler log");
  const double scale = random.normal(kUncalibratedScale);
  return {scale, random.normal(kUncalibratedYaw_rad)};
}

estimation::EngineConfig survey_config(const SurveyCase& one, SurveyFilter filter) {
  const bool published = filter == SurveyFilter::hybrid25;
  const bool states25 = filter != SurveyFilter::full;
  const ImuGrade grade = grade_of(one);
  estimation::EngineConfig c;
  c.configuration = states25 ? "hybrid25" : "full";
  (void)estimation::named_state_groups(c.configuration, c.groups);
  // The published filter considers nothing beyond its states.
  if (states25) c.left_out = estimation::LeftOut::noise;
  if (!states25) {
    c.groups.dvl_bias = true;
    c.groups.current = one.water_track;
    c.groups.usbl_bias = c.groups.usbl_misalignment = one.usbl;
  }
  tell(c.imu, grade, published ? ImuModelling::biases : ImuModelling::everything);

  estimation::StateModelConfig& states = c.states;
  states.dvl_scale_sigma = one.uncalibrated ? kUncalibratedScale : kDvlScale;
  states.dvl_misalignment_sigma_rad = one.uncalibrated ? kUncalibratedYaw_rad : kDvlMisalignment_rad;
  states.dvl_bias_sigma_m_s = kDvlBias_m_s;
  states.current_sigma_m_s = 0.3;
  states.current_time_constant_s = 0.0;  // it does not change here
  states.depth_bias_sigma_m = kDepthBias_m;
  states.surface_altitude_m = kSurface_m;
  states.surface_altitude_sigma_m = 5.0;
  states.surface_altitude_walk_m_sqrt_s = 1e-4;
  states.heading_bias_sigma_rad = kCompassA_rad;
  states.heading_bias_time_constant_s = 0.0;
  states.heading_deviation_sigma_rad = kCompassCurve_rad;
  states.gps_bias_sigma_m = kGpsDrift_m;
  states.gps_bias_time_constant_s = kGpsDrift_s;
  states.usbl_bias_sigma_m = 0.3;

  estimation::AlignmentConfig& alignment = c.alignment;
  alignment.mode = estimation::StartMode::at_rest;
  alignment.heading_source =
      one.navigation_grade ? estimation::HeadingSource::gyrocompass : estimation::HeadingSource::compass;
  alignment.averaging_s = 45.0;
  alignment.compass_sigma_rad = std::hypot(kCompassA_rad, std::sqrt(2.0) * kCompassCurve_rad);
  alignment.rest_velocity_sigma_m_s = 0.02;
  alignment.tilt_sigma_floor_rad = 2e-4;
  alignment.position_sigma_m = 0.3;

  auto gps = estimation::default_sensor(SourceKind::gps, "gps");
  gps.lever_B_m = kGpsLever_B_m;
  // Where the slow error is no state it is noise.
  const double horizontal = c.groups.gps_position_bias ? kGpsNoise_m : std::hypot(kGpsNoise_m, kGpsDrift_m);
  gps.sigma = {horizontal, horizontal, 2.0 * horizontal};
  const double velocity = gps_velocity_m_s(one);
  gps.velocity_sigma_m_s = {velocity, velocity, 2.0 * velocity};
  gps.use_sample_sigma = false;
  gps.frozen_change = 0.0;
  // The printed measurement of the Doppler log is that of the velocity of the IMU.
  auto dvl = told(kDvl, published ? std::array<double, 3>{0.0, 0.0, 0.0} : kDvlLever_B_m);
  dvl.use_beams = !published && one.beams < 4;
  auto depth = estimation::default_sensor(SourceKind::depth, "depth");
  depth.sigma = {kDepthNoise_m, kDepthNoise_m, kDepthNoise_m};
  depth.frozen_change = 0.0;
  auto compass = estimation::default_sensor(SourceKind::heading, "heading");
  const double compass_sigma = published ? kCompassAccuracy_rad : kCompassFilter_rad;
  compass.sigma = {compass_sigma, compass_sigma, compass_sigma};
  compass.frozen_change = 0.0;
  c.sensors = {gps, dvl, depth, compass};
  if (one.usbl) c.sensors.push_back(told_survey_usbl());
  if (published)
    for (auto& sensor : c.sensors) believe_everything(sensor);
  return c;
}

}  // namespace fathom::study
