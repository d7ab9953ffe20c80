// The Earth and the motion of the consistency study beside the estimator's own: written apart, equal in what
// they say.
#include "study/consistency/truth_path.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "study/consistency/cells.hpp"

namespace fathom::study {
namespace {

TEST(EarthFixed, GravityIsThatOfSomigliana) {
  for (const double latitude : {-80.0, -35.0, 0.0, 10.0, 45.0, 89.0})
    for (const double height : {0.0, 8000.0}) {
      const ecef::Geodetic place{latitude * kRadPerDeg, 0.7, height};
      const Eigen::Vector3d r = ecef::to_cartesian(place);
      const Eigen::Vector3d turn(0.0, 0.0, ecef::kTurnRate_rad_s);
      const Eigen::Vector3d g_N =
          ecef::axes_EN(place).transpose() * (ecef::gravitation_E_m_s2(r) - turn.cross(turn.cross(r)));
      const Eigen::Vector3d other = geo::gravity_N(place.latitude_rad, height);
      EXPECT_NEAR((g_N - other).norm(), 0.0, height == 0.0 ? 1e-8 : 2e-6) << latitude << " " << height;
    }
}

TEST(EarthFixed, PlacesComeBack) {
  for (const double latitude : {-89.9, -30.0, 0.0, 60.0})
    for (const double height : {-5000.0, 0.0, 20000.0}) {
      const ecef::Geodetic place{latitude * kRadPerDeg, -2.5, height};
      const ecef::Geodetic back = ecef::to_geodetic(ecef::to_cartesian(place));
      EXPECT_NEAR(back.latitude_rad, place.latitude_rad, 1e-14);
      EXPECT_NEAR(back.longitude_rad, place.longitude_rad, 1e-14);
      EXPECT_NEAR(back.height_m, place.height_m, 1e-8);
      const Eigen::Vector3d step(30.0, -40.0, 5.0);
      const geo::Geodetic other =
          geo::moved_by({place.latitude_rad, place.longitude_rad, place.height_m}, step);
      const ecef::Geodetic own = ecef::moved(place, step);
      EXPECT_NEAR(ecef::offset_N_m(own, {other.latitude_rad, other.longitude_rad, other.altitude_m}).norm(),
                  0.0, latitude == -89.9 ? 0.5 : 2e-3);
    }
}

TEST(TruthPath, AtRestItFeelsGravityAndTheEarthsTurn) {
  Manoeuvres still;
  still.heading_rad = Profile(0.6);
  const ecef::Geodetic place{0.7, -1.0, 100.0};
  TruthPath path(still, place);
  PerfectIncrements sum;
  for (int i = 0; i < 100; ++i) {
    const PerfectIncrements one = path.advance(0.01);
    sum.angle_rad += one.angle_rad;
    sum.velocity_m_s += one.velocity_m_s;
  }
  const Eigen::Vector3d rate =
      still.at(0.0).axes_NB.transpose() * Eigen::Vector3d(geo::earth_rate_N(place.latitude_rad));
  EXPECT_NEAR((sum.angle_rad - rate).norm(), 0.0, 1e-11);
  EXPECT_NEAR(sum.velocity_m_s.z(), -geo::gravity(place.latitude_rad, place.height_m), 1e-6);
}

/// The mechanisation is given perfect increments and a perfect start: where it then ends shows each formula
/// that is wrong.
TEST(TruthPath, TheMechanisationFollowsItFreely) {
  for (const Cell& cell : consistency_cells()) {
    const Manoeuvres manoeuvres = cell.motion(3);
    TruthPath path(manoeuvres, {cell.latitude_deg * kRadPerDeg, 0.3, cell.height_m});
    estimation::EngineConfig config;
    config.alignment.mode = estimation::StartMode::given;
    config.sensors = {estimation::default_sensor(SourceKind::gps, "gps")};
    config.groups = {};
    estimation::FusionEngine engine(config);
    const auto start_from = [&](const Pose& pose, TimeNs stamp_ns) {
      const Eigen::Matrix3d& c = pose.axes_NB;
      estimation::InitialState start;
      start.stamp_ns = stamp_ns;
      start.latitude_rad = pose.place.latitude_rad;
      start.longitude_rad = pose.place.longitude_rad;
      start.altitude_m = pose.place.height_m;
      start.velocity_N_m_s = {pose.velocity_N_m_s.x(), pose.velocity_N_m_s.y(), pose.velocity_N_m_s.z()};
      start.rpy_rad = {std::atan2(c(2, 1), c(2, 2)), std::asin(-c(2, 0)), std::atan2(c(1, 0), c(0, 0))};
      engine.start_from(start);
    };
    for (int i = 0; i < 12000; ++i) {
      const PerfectIncrements truth = path.advance(0.01);
      ImuSample sample;
      sample.header.sensor = std::string_view("imu");
      sample.header.stamp_ns = from_seconds(1000.0 + 0.01 * (i + 1));
      sample.header.sequence = static_cast<std::uint64_t>(i + 1);
      for (std::size_t k = 0; k < 3; ++k) {
        sample.delta_angle_B_rad[k] = truth.angle_rad(static_cast<Eigen::Index>(k));
        sample.delta_velocity_B_m_s[k] = truth.velocity_m_s(static_cast<Eigen::Index>(k));
        sample.angular_rate_B_rad_s[k] = 100.0 * sample.delta_angle_B_rad[k];
        sample.specific_force_B_m_s2[k] = 100.0 * sample.delta_velocity_B_m_s[k];
      }
      sample.delta_time_s = 0.01;
      if (i == 0) start_from(path.pose(), 0);
      engine.add(sample);
    }
    const NavState& nav = engine.nav_state();
    const Pose end = path.pose();
    const Eigen::Vector3d off =
        ecef::offset_N_m(end.place, {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    // Two minutes on: coning and sculling between samples of 100 Hz are what is left.
    EXPECT_LT(off.norm(), 0.3) << cell.name << " " << off.transpose();
    const Eigen::Vector3d v = Eigen::Vector3d(nav.velocity_N_m_s.data()) - end.velocity_N_m_s;
    EXPECT_LT(v.norm(), 0.01) << cell.name << " " << v.transpose();
  }
}

}  // namespace
}  // namespace fathom::study
