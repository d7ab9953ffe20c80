// A start at rest: levelled by a quiet window, heading from a compass, by hand or from the turning Earth.
#include <algorithm>
#include <cmath>

#include "estimation/navigator/start/correlate.hpp"
#include "estimation/navigator/start/starter.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double horizontal_earth_rate(double latitude_rad) {
  return geo::kEarthRate_rad_s * std::cos(latitude_rad);
}

/// (ALN-5): what the remaining errors of the accelerometers did to the level.
void correlate_level(const Setup& setup, const geo::Geodetic& position, const Matrix3d& c,
                     ErrorFilter& filter) {
  const double g = geo::gravity(position.latitude_rad, position.altitude_m);
  Matrix3d t = Matrix3d::Zero();
  t(0, 1) = 1.0 / g;
  t(1, 0) = -1.0 / g;
  correlate_accelerometers(setup, t * c, -g * c.row(2).transpose(), filter);
}

/// (ALN-5): what the gyro's bias did to a heading that it found.
void correlate_gyrocompass(const Setup& setup, double latitude_rad, const Matrix3d& c, ErrorFilter& filter) {
  const double sigma = setup.config.imu.gyro_bias_sigma_rad_s;
  const int gyro = setup.index.of(Group::gyro_bias);
  const double variance = sigma * sigma;
  for (int k = 0; k < 3; ++k)
    filter.set(8, gyro + k, variance * c(1, k) / horizontal_earth_rate(latitude_rad));
}

}  // namespace

std::optional<Starter::Heading> Starter::heading_at_rest(const Setup& setup, const RestResult& rest,
                                                         const Eigen::Vector2d& tilt,
                                                         double gyro_sigma) const {
  const AlignmentConfig& config = setup.config.alignment;
  const bool gyro_good = gyro_sigma <= config.gyrocompass_limit_rad;
  const auto from_gyro = [&]() -> std::optional<Heading> {
    if (!gyro_good) return std::nullopt;
    return Heading{gyrocompass(tilt, rest.mean_rate_B_rad_s), gyro_sigma,
                   HeadingSource::gyrocompass};  // (ALN-3)
  };
  const HeadingSource source = heading_source(setup);
  switch (source) {
    case HeadingSource::given:
      return Heading{config.given_heading_rad, config.given_heading_sigma_rad};
    case HeadingSource::gyrocompass:
      return from_gyro();
    case HeadingSource::compass:
    case HeadingSource::two_antenna:
    case HeadingSource::automatic:
      break;
  }
  if (window_.headings() > 0)
    return Heading{window_.heading_start_rad(), window_.heading_sigma_rad(),
                   window_.two_antenna() ? HeadingSource::two_antenna : HeadingSource::compass};
  return source == HeadingSource::automatic ? from_gyro() : std::nullopt;
}

bool Starter::start_at_rest(const StartInputs& in, Estimate& estimate) const {
  const Setup& setup = in.setup;
  const AlignmentConfig& config = setup.config.alignment;
  const ImuConfig& imu = setup.config.imu;
  const StateIndex& index = setup.index;
  const RestResult rest = window_.result();
  const StartPlace at = *place(in);
  const Eigen::Vector2d tilt = level(rest.force_start_m_s2);
  const double rate_noise = std::hypot(rest.rate_sigma_rad_s.maxCoeff(),
                                       imu.angle_random_walk_rad_sqrt_s / std::sqrt(rest.duration_s));
  const double earth_rate = horizontal_earth_rate(at.position.latitude_rad);
  const double gyro_sigma = std::hypot(imu.gyro_bias_sigma_rad_s, rate_noise) / earth_rate;
  const std::optional<Heading> heading = heading_at_rest(setup, rest, tilt, gyro_sigma);
  if (!heading) return false;
  const bool from_gyro = heading->from == HeadingSource::gyrocompass;

  FilterState start;
  const geo::Quaternion q_start = geo::from_rpy(Vector3d(tilt.x(), tilt.y(), heading->heading_rad));
  // (ALN-18): the gyro turned the axes back against the stars, and N has turned with the Earth since the
  // middle.
  const Vector3d turned_N = 0.5 * rest.duration_s * geo::earth_rate_N(at.position.latitude_rad);
  start.nav.q_NB = geo::normalized(geo::exp(-turned_N) * q_start * rest.q_start_now);
  start.nav.position = at.position;
  std::array<double, kMaxStates> sigma = setup.initial_sigma;
  const double oblique = index.has(Group::accel_misalignment) ? 0.0 : imu.accel_misalignment_sigma_rad;
  const double tilt_noise = std::hypot(config.tilt_sigma_floor_rad, rest.tilt_sigma_rad, oblique);
  for (std::size_t i = 0; i < 3; ++i) sigma[3 + i] = config.rest_velocity_sigma_m_s;
  sigma[6] = sigma[7] = tilt_noise;
  sigma[8] = heading->sigma_rad;

  const Matrix3d c = geo::to_matrix(start.nav.q_NB);
  double bias_gain = 0.0;
  if (!from_gyro) {
    // (ALN-4): the mean rate less the Earth's is the bias, as far as the vehicle was quiet.
    const Vector3d measured =
        rest.mean_rate_B_rad_s - c.transpose() * geo::earth_rate_N(at.position.latitude_rad);
    const int bias = index.of(Group::gyro_bias);
    for (int i = 0; i < 3; ++i) {
      const double prior = imu.gyro_bias_sigma_rad_s * imu.gyro_bias_sigma_rad_s;
      const double noise = rate_noise * rate_noise + std::pow(earth_rate * heading->sigma_rad, 2) +
                           std::pow(geo::kEarthRate_rad_s * tilt_noise, 2);
      bias_gain = prior / (prior + noise);
      start.x[static_cast<std::size_t>(bias + i)] = bias_gain * measured(i);
      sigma[static_cast<std::size_t>(bias + i)] = std::sqrt((1.0 - bias_gain) * prior);
    }
  }
  begin(in, at, start, sigma, estimate);
  if (!from_gyro) {
    StartHeading::Column column = start_error(index, heading->from == HeadingSource::compass);
    const Vector3d turned_B =
        c.transpose() * geo::cross(Vector3d::UnitZ(), geo::earth_rate_N(at.position.latitude_rad));
    for (int i = 0; i < 3; ++i)
      column[static_cast<std::size_t>(index.of(Group::gyro_bias) + i)] = bias_gain * turned_B(i);
    estimate.start_heading.begin(column);
  }
  correlate_level(setup, at.position, c, estimate.filter);
  if (from_gyro) correlate_gyrocompass(setup, at.position.latitude_rad, c, estimate.filter);
  if (heading->from == HeadingSource::two_antenna) correlate_antennas(setup, kByHeading, estimate.filter);
  return true;
}

}  // namespace fathom::estimation
