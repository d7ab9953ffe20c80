// A vehicle under water that only acoustic fixes place (ALN-21).
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::AnalyticVehicle;
using test::Normal;
using test::Sample;
using test::SurveyRun;

constexpr double kFixEvery_s = 5.0;
constexpr double kFixSigma_m = 1.5;
constexpr double kAngleSigma_rad = 0.01;
constexpr double kBiasSigma_m = 2.0;
constexpr double kTurnSigma_rad = 0.0087;
constexpr double kAccelBiasSigma_m_s2 = 0.02;
constexpr double kGyroBiasSigma_rad_s = 1e-4;
constexpr double kCompassBiasSigma_rad = 0.0175;

struct Case {
  double speed_m_s = 0.0;  ///< beside what it drifts
  bool dvl = false;
  bool from_ship = false;   ///< range and direction from 300 m away instead of a place
  std::vector<int> wild{};  ///< which of the fixes are 5 km off
  double duration_s = 60.0;
  std::uint64_t seed = 1;
};

struct Rov {
  std::vector<Sample> samples;  ///< by arrival
  std::vector<Truth> truth;
};

/// Hangs 40 m below the surface, sways and turns a little.
Rov rov(const Case& run) {
  Normal normal(run.seed);
  AnalyticVehicle::Motion motion;
  motion.speed_m_s = [&](double t) { return run.speed_m_s + 0.05 * std::sin(0.3 * t); };
  motion.rpy_rad = [](double t) {
    return Vector3d(0.02 * std::sin(0.8 * t), 0.015 * std::sin(0.6 * t), 1.0 + 0.05 * std::sin(0.1 * t));
  };
  const double surface_m = SurveyRun::kSurfaceAltitude_m;
  AnalyticVehicle vehicle(motion, {1.0, 0.2, surface_m - 40.0}, 0.01);
  const geo::Geodetic ship = geo::moved_by({1.0, 0.2, surface_m}, Vector3d(-180.0, 240.0, 3.0));
  const Vector3d gyro_bias = normal.vector(kGyroBiasSigma_rad_s);
  const Vector3d accel_bias = normal.vector(kAccelBiasSigma_m_s2);
  const double compass_bias = normal(kCompassBiasSigma_rad);
  Vector3d fix_bias = normal.vector(kBiasSigma_m);
  fix_bias.z() = 0.0;
  const Vector3d turned = normal.vector(kTurnSigma_rad);
  const Vector3d dvl_turn = normal.vector(0.005);
  Rov out;
  std::uint64_t sequence[5] = {};
  int fixes = 0;
  for (int k = 0; k <= static_cast<int>(run.duration_s * 100.0); ++k) {
    Vector3d dtheta = 0.01 * vehicle.rate_ib_B_rad_s();
    Vector3d dv = 0.01 * vehicle.force_B_m_s2();
    if (k > 0) vehicle.step(dtheta, dv);
    const auto head = [&](auto& sample, const char* name, int stream, double delay_s) {
      sample.header.vehicle = "auv";
      sample.header.sensor = name;
      sample.header.stamp_ns = SurveyRun::kEpochNs + static_cast<TimeNs>(k) * 10'000'000;
      sample.header.received_ns = sample.header.stamp_ns + from_seconds(delay_s);
      sample.header.sequence = ++sequence[stream];
    };
    const Matrix3d c = vehicle.C_NB();
    Truth& truth = out.truth.emplace_back();
    truth.latitude_rad = vehicle.position().latitude_rad;
    truth.longitude_rad = vehicle.position().longitude_rad;
    truth.altitude_m = vehicle.position().altitude_m;
    truth.rpy_rad = geo::arr(vehicle.rpy_rad());
    ImuSample imu;
    head(imu, "imu", 0, 0.002);
    dtheta += 0.01 * gyro_bias + normal.vector(6e-5 * 0.1);
    dv += 0.01 * accel_bias + normal.vector(1.4e-3 * 0.1);
    imu.delta_angle_B_rad = geo::arr(dtheta);
    imu.delta_velocity_B_m_s = geo::arr(dv);
    imu.delta_time_s = 0.01;
    imu.angular_rate_B_rad_s = geo::arr(dtheta / 0.01);
    imu.specific_force_B_m_s2 = geo::arr(dv / 0.01);
    out.samples.emplace_back(imu);
    if (k % 20 == 3 && run.dvl) {
      DvlSample dvl;
      head(dvl, "dvl0", 1, 0.1);
      const Vector3d v =
          c.transpose() * vehicle.v_N_m_s() + geo::cross(vehicle.rate_nb_B_rad_s(), SurveyRun::dvl_lever());
      dvl.velocity_D_m_s = geo::arr(v - geo::cross(dvl_turn, v) + normal.vector(0.01));
      out.samples.emplace_back(dvl);
    }
    if (k % 20 == 5) {
      DepthSample depth;
      head(depth, "depth0", 2, 0.05);
      depth.depth_m = surface_m - vehicle.position().altitude_m + normal(0.03);
      out.samples.emplace_back(depth);
      HeadingSample heading;
      head(heading, "compass0", 3, 0.05);
      heading.heading_rad = geo::wrap_two_pi(vehicle.rpy_rad().z() + compass_bias + normal(0.005));
      out.samples.emplace_back(heading);
    }
    if (k % static_cast<int>(100.0 * kFixEvery_s) == 250) {
      UsblSample usbl;
      head(usbl, "usbl0", 4, 1.5);
      Vector3d wrong = fix_bias;
      if (std::count(run.wild.begin(), run.wild.end(), fixes++) > 0) wrong.x() += 5000.0;
      const geo::Geodetic at = geo::moved_by(vehicle.position(), wrong);
      if (run.from_ship) {
        Vector3d path = geo::difference_N(ship, at);
        path -= geo::cross(turned, path);
        usbl.frame = UsblFrame::vessel_frd;
        usbl.station_latitude_rad = ship.latitude_rad;
        usbl.station_longitude_rad = ship.longitude_rad;
        usbl.station_depth_m = 3.0;
        usbl.station_rpy_rad = {0.0, 0.0, 0.0};
        usbl.range_m = path.norm() + normal(kFixSigma_m);
        usbl.depression_rad = std::atan2(path.z(), std::hypot(path.x(), path.y())) + normal(kAngleSigma_rad);
        usbl.bearing_rad = geo::wrap_two_pi(std::atan2(path.y(), path.x()) + normal(kAngleSigma_rad));
      } else {
        const geo::Geodetic fix = geo::moved_by(at, normal.vector(kFixSigma_m));
        usbl.latitude_rad = fix.latitude_rad;
        usbl.longitude_rad = fix.longitude_rad;
        usbl.depth_m = surface_m - fix.altitude_m;
      }
      out.samples.emplace_back(usbl);
    }
  }
  std::stable_sort(out.samples.begin(), out.samples.end(), [](const Sample& a, const Sample& b) {
    return test::header(a).received_ns < test::header(b).received_ns;
  });
  return out;
}

EngineConfig config_for(const Case& run) {
  EngineConfig c = SurveyRun::config();
  EXPECT_TRUE(named_state_groups("full", c.groups));
  SensorConfig& usbl = c.sensors.back();
  usbl.sigma = {kFixSigma_m, kFixSigma_m, kFixSigma_m};
  usbl.angle_sigma_rad = kAngleSigma_rad;
  c.imu.angle_random_walk_rad_sqrt_s = 6e-5;
  c.imu.velocity_random_walk_m_s_sqrt_s = 1.4e-3;
  c.imu.gyro_bias_sigma_rad_s = kGyroBiasSigma_rad_s;
  c.imu.accel_bias_sigma_m_s2 = kAccelBiasSigma_m_s2;
  c.states.usbl_bias_sigma_m = kBiasSigma_m;
  c.states.usbl_misalignment_sigma_rad = kTurnSigma_rad;
  if (!run.dvl) c.sensors.erase(c.sensors.begin() + 1);
  return c;
}

struct Outcome {
  std::optional<double> start_s;
  double worst_m = 0.0;  ///< horizontally
  // Squares of errors by their sigmas, at the start and at the end; the position by its two axes.
  double position_at_start = 0.0;
  double position_at_end = 0.0;
  double heading_at_start = 0.0;
  double heading_at_end = 0.0;
};

Outcome navigate(const Case& run) {
  const Rov vehicle = rov(run);
  FusionEngine engine(config_for(run));
  Outcome out;
  std::size_t index = 0;
  for (const Sample& sample : vehicle.samples) {
    test::feed(engine, sample);
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = vehicle.truth[index++];
    const NavState& nav = engine.nav_state();
    if (nav.mode == NavMode::none || nav.mode == NavMode::aligning) continue;
    const Vector3d e = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                         {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    const auto& p = nav.position_covariance_N_m2;
    out.position_at_end = (e.x() * e.x() * p[4] - 2.0 * e.x() * e.y() * p[1] + e.y() * e.y() * p[0]) /
                          (p[0] * p[4] - p[1] * p[3]);
    out.heading_at_end = std::pow(geo::wrap_pi(nav.rpy_rad[2] - truth.rpy_rad[2]) / nav.rpy_sigma_rad[2], 2);
    out.worst_m = std::max(out.worst_m, e.head<2>().norm());
    if (out.start_s) continue;
    out.start_s = 0.01 * static_cast<double>(index - 1);
    out.position_at_start = out.position_at_end;
    out.heading_at_start = out.heading_at_end;
  }
  return out;
}

/// Starts, and is as wrong as it says: means over seeds, of two axes and of one.
void expect_honest(Case run, const char* what) {
  constexpr int kSeeds = 16;
  Outcome sum;
  for (run.seed = 1; run.seed <= kSeeds; ++run.seed) {
    const Outcome one = navigate(run);
    ASSERT_TRUE(one.start_s) << what << ", seed " << run.seed;
    EXPECT_LT(*one.start_s, 25.0) << what << ", seed " << run.seed;
    EXPECT_LT(one.worst_m, 25.0) << what << ", seed " << run.seed;
    sum.position_at_start += one.position_at_start / kSeeds;
    sum.position_at_end += one.position_at_end / kSeeds;
    sum.heading_at_start += one.heading_at_start / kSeeds;
    sum.heading_at_end += one.heading_at_end / kSeeds;
  }
  // Three sigmas of such a mean; a start may say less than it knows.
  EXPECT_LT(sum.position_at_start, 2.0 + 3.0 * 2.0 / std::sqrt(kSeeds)) << what;
  EXPECT_LT(sum.position_at_end, 2.0 + 3.0 * 2.0 / std::sqrt(kSeeds)) << what;
  EXPECT_LT(sum.heading_at_start, 1.0 + 3.0 * std::sqrt(2.0 / kSeeds)) << what;
  EXPECT_LT(sum.heading_at_end, 1.0 + 3.0 * std::sqrt(2.0 / kSeeds)) << what;
  EXPECT_GT(sum.position_at_end, 0.4) << what;
}

TEST(AcousticStart, AVehicleAtRestStartsByTwoFixes) {
  expect_honest({}, "no DVL");
  expect_honest({.dvl = true}, "DVL");
}

TEST(AcousticStart, WhatStaysOfTheAcousticSystemIsNotUnlearned) {
  expect_honest({.from_ship = true}, "no DVL");
  expect_honest({.dvl = true, .from_ship = true}, "DVL");
}

TEST(AcousticStart, ASlowVehicleStartsAsOneAtRestDoes) {
  expect_honest({.speed_m_s = 0.4, .dvl = true}, "0.4 m/s");
}

// Seen fixes arrive at 4, 9, 14, 19 s.
TEST(AcousticStart, OneWildFixStartsNothing) {
  for (const bool dvl : {false, true}) {
    for (const double speed_m_s : {0.0, 1.5}) {  // at rest, or under way
      if (speed_m_s > 0.0 && !dvl) continue;
      const Case run{.speed_m_s = speed_m_s, .dvl = dvl};
      Case wild = run;
      wild.wild = {0};
      Case later = run;
      later.wild = {1};
      for (const Case& one : {run, wild, later}) {
        const Outcome out = navigate(one);
        ASSERT_TRUE(out.start_s) << dvl << speed_m_s;
        EXPECT_LT(out.worst_m, 25.0) << dvl << speed_m_s;
        EXPECT_GT(*out.start_s, one.wild.empty() ? 8.9 : one.wild[0] == 0 ? 13.9 : 18.9) << dvl << speed_m_s;
      }
    }
  }
}

TEST(AcousticStart, FixesThatAllDisagreeStartNothing) {
  EXPECT_FALSE(navigate({.wild = {0, 2, 4, 6, 8, 10}}).start_s);
}

}  // namespace
}  // namespace fathom::estimation
