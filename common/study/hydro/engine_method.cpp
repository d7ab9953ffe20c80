#include "study/hydro/engine_method.hpp"

#include <cmath>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::study::hydro {
namespace {

estimation::EngineConfig config_of(const Run& run, EngineMethod method) {
  estimation::EngineConfig c;
  c.groups = {};
  c.configuration = "hydro";
  c.left_out = estimation::LeftOut::noise;  // the simulated instruments have no other errors than these
  c.alignment.mode = estimation::StartMode::given;
  // The data sheet of the instruments.
  c.imu.angle_random_walk_rad_sqrt_s = 0.05 * kRadPerDeg / 60.0;
  c.imu.velocity_random_walk_m_s_sqrt_s = 5e-4;
  c.imu.gyro_bias_sigma_rad_s = 1.0 * kRadPerDeg / 3600.0;
  c.imu.gyro_bias_instability_rad_s = 0.05 * kRadPerDeg / 3600.0;
  c.imu.accel_bias_sigma_m_s2 = 0.5e-3 * 9.80665;
  c.imu.accel_bias_instability_m_s2 = 0.02e-3 * 9.80665;
  c.imu.gyro_scale_sigma = c.imu.accel_scale_sigma = 0.0;
  c.imu.gyro_misalignment_sigma_rad = c.imu.accel_misalignment_sigma_rad = 0.0;
  auto dvl = estimation::default_sensor(SourceKind::dvl, "dvl");
  dvl.sigma = {kDvlSigma_m_s, kDvlSigma_m_s, 0.6 * kDvlSigma_m_s};
  dvl.proportional_sigma = 0.0;
  auto depth = estimation::default_sensor(SourceKind::depth, "depth");
  depth.sigma = {0.02, 0.02, 0.02};
  c.sensors = {dvl, depth};
  c.horizon_s = 1.0;
  c.snapshot_interval_s = 0.5;
  if (method == EngineMethod::conventional) {
    // The scale is no state of it: it is told of the scale error as noise.
    c.sensors.front().sigma[0] = c.sensors.front().sigma[1] = dvl_equivalent_sigma_m_s();
    return c;
  }
  c.groups.dvl_scale = true;
  c.states.dvl_scale_sigma = kDvlScaleSigma;
  if (method == EngineMethod::without_model) return c;
  c.groups.current = c.groups.model_scale = c.groups.model_bias = true;
  c.states.current_time_constant_s = 0.0;  // (STUDY-6): it stays for the ten minutes
  c.vehicle_model.sigma_m_s = {0.01, 0.01};
  c.vehicle_model.enabled = true;
  c.vehicle_model.coefficients = run.coefficients;
  c.sensors.push_back(estimation::default_sensor(SourceKind::propulsion, "propulsion"));
  c.sensors.push_back(estimation::default_sensor(SourceKind::fins, "fins"));
  return c;
}

ErrorPoint error_of(const NavState& state, const Truth& truth, double t_s) {
  const Eigen::Vector3d d = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                              {state.latitude_rad, state.longitude_rad, state.altitude_m});
  const auto& p = state.position_covariance_N_m2;
  const double determinant = p[0] * p[4] - p[1] * p[3];
  const double nees =
      (p[4] * d.x() * d.x() - 2.0 * p[1] * d.x() * d.y() + p[0] * d.y() * d.y()) / determinant;
  return {t_s, d.x(), d.y(), nees};
}

}  // namespace

std::vector<ErrorPoint> run_engine(const Run& run, EngineMethod method) {
  estimation::FusionEngine engine(config_of(run, method));
  engine.start_from(run.start);
  std::vector<ErrorPoint> out;
  Verdict verdict;
  for (const sim::Measurement& measurement : run.measurements) {
    if (const auto* imu = std::get_if<ImuSample>(&measurement)) {
      if (!engine.add(*imu)) continue;
      const std::size_t second = out.size() + 1;
      if (second < run.truth.size() && imu->header.stamp_ns >= run.truth[second].header.stamp_ns)
        out.push_back(error_of(engine.nav_state(), run.truth[second], static_cast<double>(second)));
    } else {
      std::visit(
          [&](const auto& sample) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(sample)>, ImuSample>) engine.add(sample);
          },
          measurement);
    }
    while (engine.next_verdict(verdict)) {
    }
  }
  return out;
}

}  // namespace fathom::study::hydro
