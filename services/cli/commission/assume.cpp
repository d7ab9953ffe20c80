#include "cli/commission/assume.hpp"

#include "geo/so3.hpp"

namespace fathom::cli {
namespace {

commission::AssumedInstrument first_of(const config::FusionConfig& config, SourceKind kind) {
  commission::AssumedInstrument out;
  for (const estimation::SensorConfig& sensor : config.engine.sensors) {
    if (sensor.kind != kind) continue;
    out.configured = true;
    out.lever_B_m = geo::vec(sensor.lever_B_m);
    out.C_BD = geo::to_matrix(geo::from_rpy(geo::vec(sensor.mounting_rpy_rad)));
    out.latency_s = sensor.latency_s;
    out.sigma = geo::vec(sensor.sigma);
    out.velocity_sigma_m_s = geo::vec(sensor.velocity_sigma_m_s);
    break;
  }
  return out;
}

}  // namespace

commission::Assumed assumed_by(const config::FusionConfig& config) {
  const estimation::ImuConfig& imu = config.engine.imu;
  commission::Assumed out;
  out.configured = true;
  out.imu_rate_hz = imu.nominal_rate_hz;
  out.imu_point_samples = imu.rate_convention == estimation::RateConvention::point;
  out.C_BI = geo::to_matrix(geo::from_rpy(geo::vec(imu.mounting_rpy_rad)));
  out.angle_random_walk = imu.angle_random_walk_rad_sqrt_s;
  out.velocity_random_walk = imu.velocity_random_walk_m_s_sqrt_s;
  if (config.engine.magnetic_variation_known) out.variation_rad = config.engine.magnetic_variation_rad;
  out.gps = first_of(config, SourceKind::gps);
  out.dvl = first_of(config, SourceKind::dvl);
  out.depth = first_of(config, SourceKind::depth);
  out.heading = first_of(config, SourceKind::heading);
  return out;
}

}  // namespace fathom::cli
