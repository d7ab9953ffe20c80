#include "study/consistency/instruments.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "base/units.hpp"

namespace fathom::study {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

std::array<double, 3> array(const Vector3d& a) {
  return {a.x(), a.y(), a.z()};
}

Vector3d draw3(sim::Random& random, double sigma) {
  const double x = random.normal(sigma);
  const double y = random.normal(sigma);
  const double z = random.normal(sigma);
  return {x, y, z};
}

}  // namespace

InertialUnit::InertialUnit(const ImuGrade& grade, std::uint64_t seed)
    : random_(seed, "inertial unit"),
      gyro_(draw(grade.gyro_bias_rad_s, grade.gyro_in_run_rad_s, grade.gyro_scale, grade.misalignment_rad,
                 grade.angle_walk_rad_sqrt_s, grade.in_run_s)),
      accelerometer_(draw(grade.accel_bias_m_s2, grade.accel_in_run_m_s2, grade.accel_scale,
                          grade.misalignment_rad, grade.velocity_walk_m_s_sqrt_s, grade.in_run_s)) {
  for (int i = 0; i < 3; ++i) g_sensitivity_.col(i) = draw3(random_, grade.gyro_g_sensitivity_rad_s_per_m_s2);
}

InertialUnit::Triad InertialUnit::draw(double bias, double in_run, double scale, double misalignment,
                                       double walk, double in_run_s) {
  Triad out;
  out.bias = draw3(random_, bias);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      out.shape(row, column) =
          (row == column ? 1.0 : 0.0) + random_.normal(row == column ? scale : misalignment);
  for (auto& one : out.in_run) one = sim::GaussMarkov(in_run, in_run_s, random_);
  out.walk = walk;
  return out;
}

Vector3d InertialUnit::distort(Triad& triad, const Vector3d& increment, double dt_s) {
  Vector3d bias = triad.bias;
  for (int i = 0; i < 3; ++i) bias(i) += triad.in_run[static_cast<std::size_t>(i)].advance(dt_s, random_);
  return triad.shape * increment + dt_s * bias + draw3(random_, triad.walk * std::sqrt(dt_s));
}

ImuSample InertialUnit::read(const PerfectIncrements& truth, double dt_s) {
  const Vector3d felt = truth.velocity_m_s + dt_s * Vector3d(0.0, 0.0, kStandardGravity_m_s2);
  const Vector3d angle = distort(gyro_, truth.angle_rad, dt_s) + g_sensitivity_ * felt;
  const Vector3d velocity = distort(accelerometer_, truth.velocity_m_s, dt_s);
  ImuSample out;
  out.angular_rate_B_rad_s = array(angle / dt_s);
  out.specific_force_B_m_s2 = array(velocity / dt_s);
  out.delta_angle_B_rad = array(angle);
  out.delta_velocity_B_m_s = array(velocity);
  out.delta_time_s = dt_s;
  return out;
}

GpsReceiver::GpsReceiver(const GpsFigures& figures, std::uint64_t seed)
    : figures_(figures), random_(seed, "GPS receiver") {
  for (std::size_t i = 0; i < 3; ++i)
    drift_[i] = sim::GaussMarkov(figures.drift_m * (i == 2 ? 2.0 : 1.0), figures.drift_s, random_);
}

GpsSample GpsReceiver::read(const Pose& pose, double dt_s) {
  const Vector3d lever = vector(figures_.lever_B_m);
  Vector3d error_N_m;
  Vector3d velocity = pose.velocity_N_m_s + pose.axes_NB * pose.rate_EB_B_rad_s.cross(lever);
  GpsSample out;
  for (std::size_t i = 0; i < 3; ++i) {
    const double more = i == 2 ? 2.0 : 1.0;
    const auto axis = static_cast<Eigen::Index>(i);
    error_N_m(axis) = drift_[i].advance(dt_s, random_) + random_.normal(more * figures_.noise_m);
    velocity(axis) += random_.normal(more * figures_.velocity_m_s);
    out.position_sigma_N_m[i] = more * std::hypot(figures_.noise_m, figures_.drift_m);
    out.velocity_sigma_N_m_s[i] = more * figures_.velocity_m_s;
  }
  const ecef::Geodetic place = ecef::moved(pose.place, pose.axes_NB * lever + error_N_m);
  out.fix = GpsFix::fix_3d;
  out.satellites = 10;
  out.latitude_rad = place.latitude_rad;
  out.longitude_rad = place.longitude_rad;
  out.altitude_m = place.height_m;
  out.velocity_N_m_s = array(velocity);
  out.hdop = 0.9;
  return out;
}

DopplerLog::DopplerLog(const DvlFigures& figures, std::uint64_t seed)
    : figures_(figures), random_(seed, "Doppler log"), scale_(random_.normal(figures.scale)) {
  const Vector3d turn = draw3(random_, figures.misalignment_rad);
  axes_DB_ = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix().transpose();
  bias_D_m_s_ = draw3(random_, figures.bias_m_s);
}

DvlSample DopplerLog::read(const Pose& pose) {
  const Vector3d v_B =
      pose.axes_NB.transpose() * pose.velocity_N_m_s + pose.rate_EB_B_rad_s.cross(vector(figures_.lever_B_m));
  const double sigma = std::hypot(figures_.noise_m_s, figures_.per_speed * v_B.norm());
  DvlSample out;
  out.velocity_D_m_s = array((1.0 + scale_) * (axes_DB_ * v_B) + bias_D_m_s_ + draw3(random_, sigma));
  return out;
}

DepthGauge::DepthGauge(const DepthFigures& figures, double surface_height_m, std::uint64_t seed)
    : figures_(figures),
      surface_height_m_(surface_height_m),
      random_(seed, "depth gauge"),
      bias_m_(random_.normal(figures.bias_m)) {}

DepthSample DepthGauge::read(const Pose& pose) {
  DepthSample out;
  out.depth_m = surface_height_m_ - pose.place.height_m + bias_m_ + random_.normal(figures_.noise_m);
  return out;
}

Compass::Compass(const CompassFigures& figures, std::uint64_t seed)
    : figures_(figures), random_(seed, "compass"), bias_rad_(random_.normal(figures.bias_rad)) {}

HeadingSample Compass::read(const Pose& pose) {
  const double heading = std::atan2(pose.axes_NB(1, 0), pose.axes_NB(0, 0));
  const double said = heading + bias_rad_ + random_.normal(figures_.noise_rad);
  HeadingSample out;
  out.heading_rad = said - 2.0 * std::numbers::pi * std::floor(said / (2.0 * std::numbers::pi));
  return out;
}

}  // namespace fathom::study
