#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "base/units.hpp"
#include "dataset/dataset.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {

/// A boat on flat water that neither rolls nor pitches and goes where its bow points: a minute at rest, then
/// runs and turns of half a circle to both sides, and a stop now and then.
struct LevelBoat {
  Eigen::Matrix3d C_BD = Eigen::Matrix3d::Identity();
  Eigen::Vector3d dvl_lever_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d gps_lever_B_m = Eigen::Vector3d::Zero();
  double gps_late_s = 0.0;
  double gps_velocity_noise_m_s = 0.03;
  double current_north_m_s = 0.0;  ///< comes up after the rest
};

inline dataset::Dataset sail(const LevelBoat& boat, std::uint64_t seed) {
  using Eigen::Vector3d;
  constexpr double kStep_s = 0.01, kRest_s = 60.0, kEnd_s = 460.0, kCycle_s = 60.0, kTurn_s = 20.0;
  constexpr double kSpeed_m_s = 2.0, kPull_m_s2 = 0.2, kCurrentComes_s = 20.0;
  constexpr double kDvlNoise_m_s = 0.01, kPositionNoise_m = 0.4;
  sim::Random random(seed, "level boat");
  const geo::Geodetic origin{54.35 * kRadPerDeg, 10.18 * kRadPerDeg, 42.0};
  const Vector3d earth_N = geo::earth_rate_N(origin.latitude_rad);
  const Vector3d gravity_N(0.0, 0.0, geo::gravity(origin.latitude_rad, 0.0));
  const auto noise = [&](double sigma) {
    return Vector3d(random.normal(sigma), random.normal(sigma), random.normal(sigma));
  };
  dataset::Dataset data;
  double heading = random.uniform(0.0, 6.0);
  double speed = 0.0;
  Vector3d place_N = Vector3d::Zero();
  for (int k = 1; k * kStep_s < kEnd_s; ++k) {
    const double t = k * kStep_s;
    const double under_way_s = t - kRest_s;
    const double cycle = std::floor(under_way_s / kCycle_s);
    const double in_cycle_s = under_way_s - cycle * kCycle_s;
    const bool turns = under_way_s > 0.0 && in_cycle_s > kCycle_s - kTurn_s;
    const double side = std::fmod(cycle, 3.0) < 1.5 ? 1.0 : -1.0;
    const double rate = turns ? side * 9.0 * kRadPerDeg : 0.0;
    const bool stops = under_way_s < 0.0 || (std::fmod(cycle, 2.0) > 0.5 && in_cycle_s < 15.0);
    const double before = speed;
    speed = std::clamp(speed + (stops ? -1.0 : 1.0) * kPull_m_s2 * kStep_s, 0.0, kSpeed_m_s);
    const double pull = (speed - before) / kStep_s;
    const double share = std::clamp(under_way_s / kCurrentComes_s, 0.0, 1.0);
    const Vector3d current_N(share * boat.current_north_m_s, 0.0, 0.0);
    const bool comes = share > 0.0 && share < 1.0;
    const Vector3d comes_N(comes ? boat.current_north_m_s / kCurrentComes_s : 0.0, 0.0, 0.0);
    const auto turned = [](double angle) {
      return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    };
    const Eigen::Matrix3d C_middle = turned(heading + 0.5 * rate * kStep_s);
    heading += rate * kStep_s;
    const Eigen::Matrix3d C_NB = turned(heading);
    const Vector3d rate_B(0.0, 0.0, rate);
    const Vector3d v_N = C_NB * Vector3d(speed, 0.0, 0.0) + current_N;
    place_N += v_N * kStep_s;

    ImuSample imu;
    imu.header.stamp_ns = imu.header.received_ns = dataset::kDefaultEpochNs + from_seconds(t);
    imu.angular_rate_B_rad_s = geo::arr(Vector3d(rate_B + C_middle.transpose() * earth_N + noise(6e-4)));
    const double middle_speed = 0.5 * (before + speed);
    const Vector3d coriolis_N = 2.0 * earth_N.cross(v_N);
    imu.specific_force_B_m_s2 =
        geo::arr(Vector3d(Vector3d(pull, middle_speed * rate, 0.0) +
                          C_middle.transpose() * (comes_N + coriolis_N - gravity_N) + noise(0.014)));
    data.of<ImuSample>().push_back(imu);
    if (k % 20 == 5) {
      DvlSample dvl;
      dvl.header = imu.header;
      const Vector3d v_B = C_NB.transpose() * v_N + rate_B.cross(boat.dvl_lever_B_m);
      dvl.velocity_D_m_s = geo::arr(Vector3d(boat.C_BD.transpose() * v_B + noise(kDvlNoise_m_s)));
      data.of<DvlSample>().push_back(dvl);
    }
    if (k % 20 == 0) {
      GpsSample gps;
      gps.header.stamp_ns = gps.header.received_ns = imu.header.stamp_ns + from_seconds(boat.gps_late_s);
      gps.fix = GpsFix::fix_3d;
      const geo::Geodetic there =
          geo::moved_by(origin, place_N + C_NB * boat.gps_lever_B_m + noise(kPositionNoise_m));
      gps.latitude_rad = there.latitude_rad;
      gps.longitude_rad = there.longitude_rad;
      gps.altitude_m = there.altitude_m;
      gps.velocity_N_m_s = geo::arr(
          Vector3d(v_N + C_NB * rate_B.cross(boat.gps_lever_B_m) + noise(boat.gps_velocity_noise_m_s)));
      data.of<GpsSample>().push_back(gps);
    }
  }
  return data;
}

/// As a receiver of NMEA 0183 speaks: speed and course.
inline void without_vertical(dataset::Dataset& data) {
  for (GpsSample& sample : data.of<GpsSample>()) sample.velocity_N_m_s[2] = kUnknown;
}

}  // namespace fathom::test
