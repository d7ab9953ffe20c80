#include "estimation/navigator/setup.hpp"

#include <algorithm>
#include <limits>

#include "base/units.hpp"
#include "estimation/aiding/registry.hpp"

namespace fathom::estimation {

using Eigen::Vector3d;

namespace {

/// In that time no sigma grows by what anybody would notice, and the products that a second order leaves out
/// of Phi are below 1e-4.
constexpr double kStride_s = 0.05;
/// A step longer than the nominal one by half is one with a sample missing.
constexpr double kMissedSample = 1.5;

void fill(std::array<double, kMaxStates>& values, const StateIndex& index, Group group, double value) {
  const int start = index.of(group);
  for (int i = 0; start >= 0 && i < group_size(group); ++i)
    values[static_cast<std::size_t>(start + i)] = value;
}

/// A first-order Gauss-Markov process of the given steady state.
void markov(Setup& setup, Group group, double sigma, double time_constant_s) {
  fill(setup.walk, setup.index, group, 2.0 * sigma * sigma / time_constant_s);
  fill(setup.decay_per_s, setup.index, group, 1.0 / time_constant_s);
}

/// Where no measurement finds it, the slow error of these sensors is half of what they are off by, at least:
/// of acoustic fixes by the ship's place, the mounting of the array and the bent path of the sound, of two
/// antennas by how they are mounted and by multipath. More of it is found (GATE-13).
template <class Is>
double least_slow_error(const EngineConfig& config, const Is& is) {
  constexpr double kShare = 0.5;
  double sigma = std::numeric_limits<double>::infinity();
  for (const SensorConfig& one : config.sensors)
    if (is(one)) sigma = std::min(sigma, one.sigma[0]);
  return kShare * sigma;
}

}  // namespace

Setup::Setup(const EngineConfig& engine_config, StateIndex::Considered considered)
    : config(engine_config),
      index(engine_config.groups, engine_config.considered(), considered),
      q_B_imu(geo::from_rpy(geo::vec(engine_config.imu.mounting_rpy_rad))),
      q_B_wheels(geo::from_rpy(geo::vec(engine_config.constraints.non_holonomic.mounting_rpy_rad))) {
  int layers = 0;
  water_layer.fill(-1);
  for (std::size_t i = 0; i < config.sensors.size() && i < limits.size(); ++i) {
    limits[i] = gate_limits(config.sensors[i]);
    if (config.sensors[i].kind == SourceKind::dvl && layers < kMaxWaterLayers) water_layer[i] = layers++;
  }
  // A constraint is weighed down as far as it is broken and never refused: a slide ends some time.
  constraint_gate.robust = RobustKind::student_t;
  constraint_gate.robust_reject_ratio = 1e12;
  constraint_limits = gate_limits(constraint_gate);

  const ImuConfig& imu = config.imu;
  const StateModelConfig& model = config.states;
  imu_noise[MotionNoise::kAccelerometers] =
      imu.velocity_random_walk_m_s_sqrt_s * imu.velocity_random_walk_m_s_sqrt_s;
  imu_noise[MotionNoise::kGyros] = imu.angle_random_walk_rad_sqrt_s * imu.angle_random_walk_rad_sqrt_s;
  const auto sigma = [&](Group group, double value) { fill(initial_sigma, index, group, value); };
  sigma(Group::accel_bias, imu.accel_bias_sigma_m_s2);
  sigma(Group::gyro_bias, imu.gyro_bias_sigma_rad_s);
  // The turn-on part does not decay, so the in-run part is a random walk of the same growth.
  const double accel = imu.accel_bias_instability_m_s2;
  const double gyro = imu.gyro_bias_instability_rad_s;
  fill(walk, index, Group::accel_bias, 2.0 * accel * accel / imu.accel_bias_time_constant_s);
  fill(walk, index, Group::gyro_bias, 2.0 * gyro * gyro / imu.gyro_bias_time_constant_s);
  sigma(Group::accel_scale, imu.accel_scale_sigma);
  sigma(Group::gyro_scale, imu.gyro_scale_sigma);
  sigma(Group::accel_misalignment, imu.accel_misalignment_sigma_rad);
  sigma(Group::gyro_misalignment, imu.gyro_misalignment_sigma_rad);
  sigma(Group::dvl_scale, model.dvl_scale_sigma);
  sigma(Group::dvl_scale_xyz, model.dvl_scale_sigma);
  sigma(Group::dvl_misalignment, model.dvl_misalignment_sigma_rad);
  sigma(Group::dvl_bias, model.dvl_bias_sigma_m_s);
  sigma(Group::current, model.current_sigma_m_s);
  if (model.current_time_constant_s > 0.0)
    markov(*this, Group::current, model.current_sigma_m_s, model.current_time_constant_s);
  sigma(Group::depth_bias, model.depth_bias_sigma_m);
  sigma(Group::surface_altitude, model.surface_altitude_sigma_m);
  fill(walk, index, Group::surface_altitude,
       model.surface_altitude_walk_m_sqrt_s * model.surface_altitude_walk_m_sqrt_s);
  sigma(Group::heading_bias, model.heading_bias_sigma_rad);
  if (model.heading_bias_time_constant_s > 0.0)
    markov(*this, Group::heading_bias, model.heading_bias_sigma_rad, model.heading_bias_time_constant_s);
  sigma(Group::heading_deviation, model.heading_deviation_sigma_rad);
  sigma(Group::usbl_bias, config.groups.usbl_bias ? model.usbl_bias_sigma_m
                                                  : least_slow_error(config, [](const SensorConfig& one) {
                                                      return one.kind == SourceKind::usbl;
                                                    }));
  sigma(Group::antenna_bias, least_slow_error(config, [](const SensorConfig& one) {
          return one.kind == SourceKind::heading && one.two_antenna;
        }));
  sigma(Group::beacon_place, model.beacon_place_sigma_m);
  sigma(Group::gps_position_bias, model.gps_bias_sigma_m);
  markov(*this, Group::gps_position_bias, model.gps_bias_sigma_m, model.gps_bias_time_constant_s);
  if (const int bias = index.of(Group::gps_position_bias); bias >= 0) {
    initial_sigma[static_cast<std::size_t>(bias + 2)] *= 2.0;
    walk[static_cast<std::size_t>(bias + 2)] *= 4.0;
  }
  sigma(Group::usbl_misalignment, model.usbl_misalignment_sigma_rad);
  sigma(Group::gps_latency, model.gps_latency_sigma_s);
  sigma(Group::gps_lever, model.gps_lever_sigma_m);
  sigma(Group::log_scale, model.log_scale_sigma);
  sigma(Group::airspeed_bias, model.airspeed_bias_sigma_m_s);
  sigma(Group::airspeed_scale, model.airspeed_scale_sigma);
  sigma(Group::flow_angles, model.flow_angle_sigma_rad);
  markov(*this, Group::flow_angles, model.flow_angle_sigma_rad, model.flow_angle_time_constant_s);
  sigma(Group::baro_bias, model.baro_bias_sigma_m);
  fill(walk, index, Group::baro_bias, model.baro_bias_walk_m_sqrt_s * model.baro_bias_walk_m_sqrt_s);
  sigma(Group::mount_angles, model.mount_angle_sigma_rad);
  sigma(Group::mount_lever, model.mount_lever_sigma_m);
  sigma(Group::model_scale, model.model_scale_sigma);
  sigma(Group::model_bias, model.model_bias_sigma_m_s);
  markov(*this, Group::model_bias, model.model_bias_sigma_m_s, model.model_bias_time_constant_s);
  model_gate.reacquire_s = 0.0;
  model_limits = gate_limits(model_gate);
  if (config.vehicle_model.enabled) velocity_model.emplace(config.vehicle_model.coefficients);
  // Shaft and fins serve the vehicle model, and the shaft serves the alignment after a drop.
  const bool driven = velocity_model || config.alignment.mode == StartMode::air_drop;
  for (std::size_t i = 0; i < config.sensors.size() && i < unused.size(); ++i)
    unused[i] = !driven && !may_aid(config.sensors[i]);
  drift = StateDrift(walk, decay_per_s, index.size());
  // Whoever finds what is considered goes back along every step, and needs the covariance at each.
  if (considered == StateIndex::Considered::kept) stride_s = kStride_s;
}

ProcessNoise Setup::process_noise(const Eigen::Matrix3d& C_NB, const SquaredInputs& inputs) const {
  // (NOISE-1): white noise, and as equivalent noise the scale and misalignment that are not estimated.
  const ImuConfig& imu = config.imu;
  ProcessNoise noise;
  noise.drift = &drift;
  noise.attitude = imu_noise[MotionNoise::kGyros] * Eigen::Matrix3d::Identity();
  noise.velocity = imu_noise[MotionNoise::kAccelerometers] * Eigen::Matrix3d::Identity();
  const auto add = [&](Eigen::Matrix3d& to, const Vector3d& squares, bool scale, double scale_sigma,
                       bool misalignment, double misalignment_sigma) {
    if (scale && misalignment) return;
    Vector3d variance = Vector3d::Zero();
    if (!scale) variance += scale_sigma * scale_sigma * squares;
    if (!misalignment)
      variance += misalignment_sigma * misalignment_sigma * (Vector3d::Constant(squares.sum()) - squares);
    to += C_NB * (imu.equivalent_noise_time_s * variance).asDiagonal() * C_NB.transpose();
  };
  add(noise.attitude, inputs.rate_B, index.has(Group::gyro_scale), imu.gyro_scale_sigma,
      index.has(Group::gyro_misalignment), imu.gyro_misalignment_sigma_rad);
  add(noise.velocity, inputs.force_B, index.has(Group::accel_scale), imu.accel_scale_sigma,
      index.has(Group::accel_misalignment), imu.accel_misalignment_sigma_rad);
  const double g_sensitivity = imu.gyro_g_sensitivity_rad_s_per_m_s2;
  noise.attitude.diagonal().array() +=
      imu.equivalent_noise_time_s * g_sensitivity * g_sensitivity * inputs.felt;
  const double nonlinearity = imu.accel_nonlinearity_sigma;
  noise.velocity.diagonal().array() +=
      imu.equivalent_noise_time_s * nonlinearity * nonlinearity * inputs.felt;
  return noise;
}

DropConfig Setup::drop_config() const {
  DropConfig out = config.air_drop;
  for (const SensorConfig& one : config.sensors)
    if (one.kind == SourceKind::propulsion && one.scale_m_s_per_rpm > 0.0)
      out.speed_per_rpm = one.scale_m_s_per_rpm;
  out.stability.max_gap_s = std::min(out.stability.max_gap_s, kMissedSample / config.imu.nominal_rate_hz);
  return out;
}

}  // namespace fathom::estimation
