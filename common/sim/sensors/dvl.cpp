#include "sim/sensors/dvl.hpp"

#include <array>
#include <cmath>

#include "geo/so3.hpp"
#include "sim/encode/dvl/nortek.hpp"
#include "sim/encode/dvl/pd0.hpp"
#include "sim/encode/dvl/pd6.hpp"
#include "sim/encode/dvl/waterlinked.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {

using Eigen::Matrix3d;
using Eigen::Vector3d;

DvlModel::DvlModel(const DvlConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, "dvl"), layer_(seed, "dvl.water_layer") {
  scale_ = config.scale + random_.normal(config.scale_sigma);
  const auto& m = config.mounting_rpy_rad;
  const double sigma = config.misalignment_sigma_rad;
  const double roll = random_.normal(sigma);
  const double pitch = random_.normal(sigma);
  const double yaw = random_.normal(sigma);
  q_BD_ = q_of_rpy(m[0], m[1], m[2]) * q_of_rpy(roll, pitch, yaw);
  Random bias(seed, "dvl.bias");
  for (int i = 0; i < 3; ++i) bias_D_m_s_[i] = bias.normal(config.bias_sigma_m_s);
}

DvlSample DvlModel::sample(const TruthPoint& point) {
  const TruthPoint at = at_lever(point, geo::vec(config_.lever_B_m));
  const bool outlier = random_.chance(config_.outlier_probability);
  const bool far = at.water_depth_m - at.depth_m > std::cos(config_.beam_angle_rad) * config_.maximum_range_m;
  return measure(at, {config_.water_track && far, outlier}, random_);
}

std::optional<DvlSample> DvlModel::second(const TruthPoint& point) {
  if (!config_.water_layer) return std::nullopt;
  return measure(at_lever(point, geo::vec(config_.lever_B_m)), {.water = true}, layer_);
}

DvlSample DvlModel::measure(const TruthPoint& at, const Ping& ping, Random& random) const {
  const Eigen::Quaterniond q_DN = (at.q_NB * q_BD_).conjugate();
  const Vector3d ground_D = q_DN * at.v_N_m_s;
  const Vector3d down_D = q_DN * Vector3d::UnitZ();
  const double height_m = at.water_depth_m - at.depth_m;
  const double s = std::sin(config_.beam_angle_rad);
  const double c = std::cos(config_.beam_angle_rad);
  const std::array<Vector3d, 4> beam_D{Vector3d(0, -s, c), Vector3d(0, s, c), Vector3d(s, 0, c),
                                       Vector3d(-s, 0, c)};
  const bool deaf = inside(config_.dropouts, at.t_s) || at.depth_m < 0.0;
  const double sigma = std::hypot(config_.beam_sigma_m_s, config_.beam_sigma_per_speed * ground_D.norm());
  const bool water = ping.water;
  const bool no_echo = !water && inside(config_.bottom_lost, at.t_s);
  const Vector3d v_D = water ? Vector3d(q_BD_.conjugate() * at.V_B_m_s) : ground_D;

  DvlSample out;
  out.mode = water ? DvlMode::water : DvlMode::bottom;
  out.recorded_frame =
      config_.frame == DvlConfig::Frame::beam
          ? DvlFrame::beam
          : (config_.frame == DvlConfig::Frame::ship ? DvlFrame::ship : DvlFrame::instrument);
  out.beam_angle_rad = config_.beam_angle_rad;
  out.sound_speed_m_s = config_.sound_speed_m_s;
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double range_sum_m = 0.0;
  int good = 0;
  for (std::size_t i = 0; i < beam_D.size(); ++i) {
    const double noise = random.normal(sigma);
    const bool lost = random.chance(config_.beam_dropout_probability);
    const double steepness = beam_D[i].dot(down_D);  // cosine of the beam against the vertical
    const double slant_m = steepness > 0.1 ? height_m / steepness : config_.maximum_range_m * 10.0;
    const bool reached = height_m > config_.minimum_range_m && slant_m < config_.maximum_range_m;
    const bool dead = (config_.working_beams < 4 && i == 3) || (config_.working_beams < 3 && i == 1);
    if (deaf || lost || dead || no_echo || !(reached || water)) continue;
    double velocity = beam_D[i].dot((1.0 + scale_) * v_D + bias_D_m_s_) + noise;
    if (ping.outlier) velocity += config_.outlier_m_s * (i % 2 == 0 ? 1.0 : -0.5);
    out.beam_velocity_m_s[i] = velocity;
    if (!water) out.beam_range_m[i] = slant_m * c;
    normal += beam_D[i] * beam_D[i].transpose();
    right += beam_D[i] * velocity;
    range_sum_m += slant_m * c;
    ++good;
  }
  if (good > 0 && !water) out.altitude_m = range_sum_m / good;
  if (good >= 3) out.velocity_D_m_s = geo::arr(Vector3d(normal.inverse() * right));
  if (good == 4) {
    const auto& b = out.beam_velocity_m_s;
    out.error_velocity_m_s = (b[0] + b[1] - b[2] - b[3]) / (2.0 * std::sqrt(2.0) * s);
  }
  return out;
}

Bytes SimulatedDevice<DvlSample>::encode(const DvlSample& dvl, const DeviceCall& device) {
  if (device.protocol == "nortek") return encode::nortek(dvl, {dvl.header.stamp_ns, dvl.header.received_ns});
  if (device.protocol != "waterlinked") return both_layers(dvl, device);
  if (dvl.mode == DvlMode::water) return {};  // it has no word for it
  const TimeNs valid_ns = dvl.header.stamp_ns;
  const double since_ms = last_ns_ == 0 ? kUnknown : to_seconds(valid_ns - last_ns_) * 1e3;
  last_ns_ = valid_ns;
  return bytes_of(encode::waterlinked(dvl, {valid_ns, dvl.header.received_ns, since_ms}));
}

Bytes SimulatedDevice<DvlSample>::both_layers(const DvlSample& sample, const DeviceCall& device) {
  const TimeNs valid_ns = sample.header.stamp_ns;
  if (sample.mode == DvlMode::bottom && device.scenario.sensors.of<DvlSample>().water_layer) {
    ping_ = sample;  // the other half comes next
    return {};
  }
  if (sample.mode == DvlMode::bottom) return written(sample, nullptr, valid_ns, device);
  DvlSample bottom = sample;
  bottom.mode = DvlMode::bottom;
  if (ping_ && ping_->header.stamp_ns == valid_ns) {
    bottom = *ping_;
  } else {
    bottom.velocity_D_m_s.fill(kUnknown);
    bottom.beam_velocity_m_s.fill(kUnknown);
    bottom.beam_range_m.fill(kUnknown);
    bottom.error_velocity_m_s = bottom.altitude_m = kUnknown;
  }
  ping_.reset();
  return written(bottom, &sample, valid_ns, device);
}

Bytes SimulatedDevice<DvlSample>::written(const DvlSample& bottom, const DvlSample* water, TimeNs valid_ns,
                                          const DeviceCall& device) {
  if (device.protocol == "pd6") return bytes_of(encode::pd6(bottom, valid_ns, 0.0, water));
  encode::Pd0Options options;
  options.ensemble = ++ensemble_;
  return encode::pd0(bottom, valid_ns, options, water);
}

}  // namespace fathom::sim
