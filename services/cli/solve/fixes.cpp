#include "cli/solve/fixes.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::cli {

Antenna antenna_of(const config::FusionConfig& config, double found_latency_s) {
  Antenna antenna;
  for (const estimation::SensorConfig& sensor : config.engine.sensors) {
    if (sensor.kind != SourceKind::gps) continue;
    for (std::size_t i = 0; i < 3; ++i)
      antenna.from_output_B_m[i] = sensor.lever_B_m[i] - config.engine.output_lever_B_m[i];
    antenna.latency_s = sensor.latency_s + found_latency_s;
    break;
  }
  return antenna;
}

void Path::add(const NavState& state) {
  if (!known(state.latitude_rad)) return;
  poses_.push_back({state.header.stamp_ns,
                    {state.latitude_rad, state.longitude_rad, state.altitude_m},
                    {state.q_NB[0], state.q_NB[1], state.q_NB[2], state.q_NB[3]}});
}

double Path::error_m(const GpsSample& fix, const Antenna& antenna) const {
  const TimeNs instant_ns = fix.header.stamp_ns - from_seconds(antenna.latency_s);
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), instant_ns,
                       [](const Pose& pose, TimeNs stamp_ns) { return pose.stamp_ns < stamp_ns; });
  if (after == poses_.begin() || after == poses_.end()) return kUnknown;
  const Pose& a = *(after - 1);
  const Pose& b = *after;
  const auto span = static_cast<double>(b.stamp_ns - a.stamp_ns);
  if (!(span > 0.0 && span <= 1e9)) return kUnknown;
  const geo::Geodetic truth{fix.latitude_rad, fix.longitude_rad, fix.altitude_m};
  const auto error = [&](const Pose& pose) {
    const Eigen::Vector3d arm_N = geo::to_matrix(pose.q_NB) * geo::vec(antenna.from_output_B_m);
    return Eigen::Vector3d(geo::difference_N(truth, geo::moved_by(pose.position, arm_N)));
  };
  const double share = static_cast<double>(instant_ns - a.stamp_ns) / span;
  const Eigen::Vector3d between = (1.0 - share) * error(a) + share * error(b);
  return std::hypot(between.x(), between.y());
}

void FixErrors::add(double error_m) {
  if (!known(error_m)) return;
  ++count;
  sum2_m2 += error_m * error_m;
}

void FixErrors::add(const FixErrors& other) {
  count += other.count;
  sum2_m2 += other.sum2_m2;
}

double FixErrors::rms_m() const {
  return count > 0 ? std::sqrt(sum2_m2 / static_cast<double>(count)) : kUnknown;
}

}  // namespace fathom::cli
