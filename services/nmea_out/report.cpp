#include "nmea_out/report.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "samples/position/gives_position.hpp"
#include "samples/uncertainty.hpp"

namespace fathom::nmea_out {
namespace {

using config::NmeaSentence;
using exchange::Quality;
using exchange::nmea::Validity;

constexpr double kSecondsPerMinute = 60.0;

char letter_of(NavMode mode) {
  switch (mode) {
    case NavMode::none:
      return 'N';
    case NavMode::aligning:
      return 'L';
    case NavMode::gps_aided:
      return 'G';
    case NavMode::acoustic_aided:
      return 'A';
    case NavMode::dead_reckoning:
      return 'D';
    case NavMode::inertial:
      return 'I';
  }
  return 'N';
}

double square_root(double variance) {
  return variance >= 0.0 ? std::sqrt(variance) : kUnknown;
}

bool has_position(const NavState& state) {
  const bool finite = std::isfinite(state.latitude_rad) && std::isfinite(state.longitude_rad) &&
                      std::isfinite(state.velocity_N_m_s[0]) && std::isfinite(state.velocity_N_m_s[1]) &&
                      std::isfinite(state.velocity_N_m_s[2]);
  return finite && gives_position(state.mode);
}

bool has_attitude(const NavState& state) {
  return std::all_of(state.rpy_rad.begin(), state.rpy_rad.end(),
                     [](double angle) { return std::isfinite(angle); }) &&
         state.mode != NavMode::none;
}

void fill_attitude(const NavState& state, const config::NmeaOutConfig& config, Report& out) {
  const auto [roll, pitch, yaw] = state.rpy_rad;
  // An unknown sigma is not within the limit: the comparison is false for NaN.
  if (state.rpy_sigma_rad[2] <= config.valid_heading_rad) out.point.heading_deg = yaw * kDegPerRad;
  out.uncertainty.heading_sigma_deg = state.rpy_sigma_rad[2] * kDegPerRad;
  out.uncertainty.tilt_sigma_deg = std::max(state.rpy_sigma_rad[0], state.rpy_sigma_rad[1]) * kDegPerRad;
  const auto& rate = state.angular_rate_B_rad_s;
  const double yaw_rate_rad_s = (rate[1] * std::sin(roll) + rate[2] * std::cos(roll)) / std::cos(pitch);
  if (std::isfinite(yaw_rate_rad_s)) out.turn_deg_per_min = yaw_rate_rad_s * kDegPerRad * kSecondsPerMinute;
}

void fill_position(const NavState& state, const config::NmeaOutConfig& config, Report& out) {
  geo::Geodetic place{state.latitude_rad, state.longitude_rad,
                      std::isfinite(state.altitude_m) ? state.altitude_m : 0.0};
  Eigen::Vector3d velocity(state.velocity_N_m_s[0], state.velocity_N_m_s[1], state.velocity_N_m_s[2]);
  double down_m = 0.0;
  const Eigen::Vector3d lever_B(config.point_B_m[0], config.point_B_m[1], config.point_B_m[2]);
  if (!lever_B.isZero() && has_attitude(state)) {
    const Eigen::Matrix3d C_NB = geo::to_matrix({state.q_NB[0], state.q_NB[1], state.q_NB[2], state.q_NB[3]});
    const Eigen::Vector3d rate(state.angular_rate_B_rad_s[0], state.angular_rate_B_rad_s[1],
                               state.angular_rate_B_rad_s[2]);
    const Eigen::Vector3d lever_N = C_NB * lever_B;
    place = geo::moved_by(place, lever_N);
    if (rate.allFinite()) velocity += C_NB * rate.cross(lever_B);
    down_m = lever_N.z();
  }
  exchange::Point& point = out.point;
  point.latitude_deg = place.latitude_rad * kDegPerRad;
  point.longitude_deg = place.longitude_rad * kDegPerRad;
  if (std::isfinite(state.altitude_m)) point.altitude_m = place.altitude_m;
  point.velocity_N_m_s = {velocity.x(), velocity.y(), velocity.z()};
  for (std::size_t i = 0; i < 3; ++i) point.sigma_N_m[i] = square_root(state.position_covariance_N_m2[4 * i]);
  point.quality = state.mode == NavMode::gps_aided ? Quality::fix_3d : Quality::estimated;
  out.uncertainty.radius_95_m = horizontal_95_m(state.position_covariance_N_m2);
  out.uncertainty.down_sigma_m = point.sigma_N_m[2];
  out.uncertainty.velocity_sigma_m_s =
      square_root(std::max(state.velocity_covariance_N_m2_s2[0], state.velocity_covariance_N_m2_s2[4]));
  if (out.uncertainty.radius_95_m <= config.valid_95_m) out.validity = Validity::valid;
  out.uncertainty.depth_m = state.depth_m + down_m;
  out.below_m = state.altitude_above_bottom_m - down_m;
  if (known(point.heading_deg)) {
    const double yaw = state.rpy_rad[2];
    out.forward_m_s = velocity.x() * std::cos(yaw) + velocity.y() * std::sin(yaw);
    out.starboard_m_s = velocity.y() * std::cos(yaw) - velocity.x() * std::sin(yaw);
  }
}

}  // namespace

Report nothing_at(TimeNs utc_ns) {
  Report out;
  out.point.utc_ns = utc_ns;
  out.point.quality = Quality::none;
  out.uncertainty.utc_ns = utc_ns;
  return out;
}

Report report_of(const NavState& state, const config::NmeaOutConfig& config) {
  Report out = nothing_at(state.header.stamp_ns);
  out.uncertainty.mode = letter_of(state.mode);
  out.uncertainty.aligned = state.alignment == AlignmentPhase::aligned;
  out.uncertainty.gps_outage_s = state.gps_outage_s;
  out.uncertainty.resets = state.reset_counter;
  if (has_attitude(state)) fill_attitude(state, config, out);
  if (has_position(state)) fill_position(state, config, out);
  return out;
}

std::string sentence_of(const Report& report, NmeaSentence sentence, const std::string& talker) {
  namespace nmea = exchange::nmea;
  switch (sentence) {
    case NmeaSentence::gga:
      return nmea::gga(talker, report.point);
    case NmeaSentence::rmc:
      return nmea::rmc(talker, report.point, report.validity);
    case NmeaSentence::vtg:
      return nmea::vtg(talker, report.point);
    case NmeaSentence::gst:
      return nmea::gst(talker, report.point);
    case NmeaSentence::hdt:
      return nmea::hdt(talker, report.point.heading_deg);
    case NmeaSentence::zda:
      return nmea::zda(talker, report.point.utc_ns);
    case NmeaSentence::dpt:
      return nmea::dpt(talker, report.below_m, report.uncertainty.depth_m);
    case NmeaSentence::vbw:
      return nmea::vbw(talker, report.forward_m_s, report.starboard_m_s);
    case NmeaSentence::rot:
      return nmea::rot(talker, report.turn_deg_per_min);
    case NmeaSentence::pfthm:
      break;
  }
  return nmea::pfthm(report.uncertainty);
}

}  // namespace fathom::nmea_out
