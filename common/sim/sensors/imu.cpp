#include "sim/sensors/imu.hpp"

#include <algorithm>
#include <cmath>

#include "geo/so3.hpp"
#include "sim/encode/imu/kvh.hpp"
#include "sim/encode/imu/microstrain.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/imu/stim300.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "sim/encode/imu/xsens.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

using Eigen::Vector3d;

namespace {
constexpr DurationNs kStimSample_ns = 500'000;  // its own rate, whatever the rate of its datagrams
}

TriadModel::TriadModel(const TriadConfig& config, Random& random) : config_(config) {
  for (int i = 0; i < 3; ++i) turn_on_[i] = random.normal(config.bias_sigma);
  for (auto& process : in_run_)
    process = GaussMarkov(config.instability_sigma, config.instability_tau_s, random);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      response_(row, column) +=
          random.normal(row == column ? config.scale_sigma : config.misalignment_sigma_rad);
    }
  }
}

Vector3d TriadModel::bias() const {
  return turn_on_ + Vector3d(in_run_[0].value(), in_run_[1].value(), in_run_[2].value());
}

void TriadModel::advance(double dt_s, Random& random) {
  for (auto& process : in_run_) process.advance(dt_s, random);
}

Vector3d TriadModel::increment(const Vector3d& truth, double dt_s, Random& random) {
  advance(dt_s, random);
  Vector3d out = response_ * truth + bias() * dt_s;
  const double noise = config_.random_walk * std::sqrt(dt_s);
  for (int i = 0; i < 3; ++i) {
    out[i] += random.normal(noise) + random.normal(config_.vibration_sigma * dt_s);
    if (config_.range > 0.0) out[i] = std::clamp(out[i], -config_.range * dt_s, config_.range * dt_s);
    if (config_.quantum > 0.0) {  // what does not fill a count stays for the next one
      const double due = out[i] + remainder_[i];
      out[i] = std::round(due / config_.quantum) * config_.quantum;
      remainder_[i] = due - out[i];
    }
  }
  return out;
}

Vector3d TriadModel::point(const Vector3d& truth, double dt_s, Random& random) {
  advance(dt_s, random);
  Vector3d out = response_ * truth + bias();
  const double noise = config_.random_walk / std::sqrt(dt_s);
  for (int i = 0; i < 3; ++i) {
    out[i] += random.normal(noise) + random.normal(config_.vibration_sigma);
    if (config_.range > 0.0) out[i] = std::clamp(out[i], -config_.range, config_.range);
    if (config_.quantum > 0.0) out[i] = std::round(out[i] / config_.quantum) * config_.quantum;
  }
  return out;
}

ImuModel::ImuModel(const ImuConfig& config, std::uint64_t seed)
    : config_(config),
      random_(seed, "imu"),
      C_IB_(geo::to_matrix(geo::from_rpy(geo::vec(config.mounting_rpy_rad))).transpose()),
      gyro_(config.gyro, random_),
      accelerometer_(config.accelerometer, random_) {}

ImuSample ImuModel::sample(const ImuTruth& interval, const TruthPoint& end) {
  ImuSample out;
  const double dt = interval.dt_s;
  if (config_.increments) {
    const Vector3d angle = gyro_.increment(C_IB_ * interval.delta_angle_B_rad, dt, random_);
    const Vector3d velocity = accelerometer_.increment(C_IB_ * interval.delta_velocity_B_m_s, dt, random_);
    out.delta_angle_B_rad = geo::arr(angle);
    out.delta_velocity_B_m_s = geo::arr(velocity);
    out.delta_time_s = dt;
    out.angular_rate_B_rad_s = geo::arr(angle / dt);
    out.specific_force_B_m_s2 = geo::arr(velocity / dt);
  } else {
    out.angular_rate_B_rad_s = geo::arr(gyro_.point(C_IB_ * end.omega_IB_B_rad_s, dt, random_));
    out.specific_force_B_m_s2 = geo::arr(accelerometer_.point(C_IB_ * end.f_B_m_s2, dt, random_));
  }
  return out;
}

Bytes SimulatedDevice<ImuSample>::encode(const ImuSample& imu, const DeviceCall& device) {
  const DurationNs since_power_on_ns = imu.header.stamp_ns - device.power_on_ns;
  if (device.protocol == "xsens") return encode::xsens(imu, counter_++, since_power_on_ns);
  if (device.protocol == "microstrain") return encode::microstrain(imu, since_power_on_ns);
  if (device.protocol == "sbg") return encode::sbg_imu_short(imu, since_power_on_ns);
  if (device.protocol == "stim300") {
    encode::Stim300Frame frame;
    frame.counter = static_cast<std::uint8_t>(since_power_on_ns / kStimSample_ns);
    return encode::stim300(imu, frame);
  }
  if (device.protocol == "kvh") return encode::kvh(imu, {.sequence = counter_++});
  return encode::vectornav(imu, since_power_on_ns);
}

}  // namespace fathom::sim
