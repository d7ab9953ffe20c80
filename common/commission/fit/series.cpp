#include "commission/fit/series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Vector3d;

// Rows that go back in time are left out: where a clock is wrong, the order is the better half.
template <class Times>
bool behind(const Times& t_s, double next_s) {
  return t_s.empty() || next_s > t_s.back();
}

template <class Row, class S>
std::optional<Row> interpolate(const S& series, double t_s, double longest_gap_s) {
  const auto next = std::upper_bound(series.t_s.begin(), series.t_s.end(), t_s);
  if (next == series.t_s.begin() || next == series.t_s.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(next - series.t_s.begin());
  const double span = series.t_s[i] - series.t_s[i - 1];
  if (span > longest_gap_s) return std::nullopt;
  const double share = (t_s - series.t_s[i - 1]) / span;
  return Row(series.v[i - 1] + share * (series.v[i] - series.v[i - 1]));
}

// Receivers of NMEA 0183 give speed and course alone. One that gives the vertical now and then is taken where
// it does.
void settle_down(GpsVelocity& velocity) {
  const auto known_down = std::count_if(velocity.v.begin(), velocity.v.end(),
                                        [](const Vector3d& v) { return std::isfinite(v.z()); });
  velocity.has_down = 2 * static_cast<std::size_t>(known_down) >= velocity.size();
  GpsVelocity out;
  out.has_down = velocity.has_down;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    Vector3d v = velocity.v[i];
    if (!velocity.has_down) v.z() = 0.0;
    if (!v.allFinite()) continue;
    out.t_s.push_back(velocity.t_s[i]);
    out.v.push_back(v);
  }
  velocity = std::move(out);
}

void take_gps(const dataset::Dataset& data, const Assumed& assumed, Series& out) {
  std::optional<geo::Geodetic> origin;
  std::size_t fixed = 0;
  for (const GpsSample& fix : data.of<GpsSample>()) {
    if (fix.fix < GpsFix::fix_2d || !known(fix.latitude_rad) || !known(fix.longitude_rad)) continue;
    const double t = to_seconds(fix.header.stamp_ns - out.epoch_ns) - assumed.gps.latency_s;
    if (!behind(out.gps_position.t_s, t)) continue;
    const geo::Geodetic here{fix.latitude_rad, fix.longitude_rad,
                             known(fix.altitude_m) ? fix.altitude_m : 0.0};
    if (!origin) {
      origin = here;
      out.latitude_rad = here.latitude_rad;
      out.first_altitude_m = fix.altitude_m;
    }
    out.gps_position.t_s.push_back(t);
    out.gps_position.v.push_back(geo::difference_N(*origin, here));
    out.gps_position_sigma_m.push_back(fix.position_sigma_N_m[0]);
    if (fix.fix == GpsFix::rtk_fixed) ++fixed;
    const Vector3d velocity = geo::vec(fix.velocity_N_m_s);
    if (!velocity.head<2>().allFinite()) continue;
    out.gps_velocity.t_s.push_back(t);
    out.gps_velocity.v.push_back(velocity);
  }
  settle_down(out.gps_velocity);
  out.gps_rtk = fixed * 2 > out.gps_position.size();
}

}  // namespace

Series series_of(const dataset::Dataset& data, const Assumed& assumed) {
  Series out;
  const auto& imu = data.of<ImuSample>();
  out.epoch_ns = imu.front().header.stamp_ns;
  const auto seconds = [&](const auto& sample) { return to_seconds(sample.header.stamp_ns - out.epoch_ns); };
  for (const ImuSample& sample : imu) {
    const Vector3d rate = geo::vec(sample.angular_rate_B_rad_s);
    const Vector3d force = geo::vec(sample.specific_force_B_m_s2);
    const double t = seconds(sample);
    if (!rate.allFinite() || !force.allFinite() || !behind(out.imu.t_s, t)) continue;
    out.imu.t_s.push_back(t);
    out.imu.rate.push_back(assumed.C_BI * rate);
    out.imu.force.push_back(assumed.C_BI * force);
  }
  take_gps(data, assumed, out);
  for (const DvlSample& sample : data.of<DvlSample>()) {
    const Vector3d velocity = geo::vec(sample.velocity_D_m_s);
    const double t = seconds(sample) - assumed.dvl.latency_s;
    if (sample.mode != DvlMode::bottom || !velocity.allFinite() || !behind(out.dvl.t_s, t)) continue;
    out.dvl.t_s.push_back(t);
    out.dvl.v.push_back(velocity);
  }
  for (const DepthSample& sample : data.of<DepthSample>()) {
    const double t = seconds(sample) - assumed.depth.latency_s;
    if (!known(sample.depth_m) || !behind(out.depth.t_s, t)) continue;
    out.depth.t_s.push_back(t);
    out.depth.v.push_back(sample.depth_m);
  }
  for (const HeadingSample& sample : data.of<HeadingSample>()) {
    const double t = seconds(sample) - assumed.heading.latency_s;
    if (!known(sample.heading_rad) || !behind(out.heading.t_s, t)) continue;
    const double last = out.heading.v.empty() ? sample.heading_rad : out.heading.v.back();
    out.heading.t_s.push_back(t);
    out.heading.v.push_back(last + geo::wrap_pi(sample.heading_rad - last));
    out.heading_magnetic = sample.north == North::magnetic;
    if (known(sample.variation_rad)) out.heading_variation_rad = sample.variation_rad;
  }
  return out;
}

std::optional<Vector3d> at(const VectorSeries& series, double t_s, double longest_gap_s) {
  return interpolate<Vector3d>(series, t_s, longest_gap_s);
}

std::optional<double> at(const ScalarSeries& series, double t_s, double longest_gap_s) {
  return interpolate<double>(series, t_s, longest_gap_s);
}

}  // namespace fathom::commission
