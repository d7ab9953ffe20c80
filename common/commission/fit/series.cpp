#include "commission/fit/series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Vector3d;

// Of the usable rows as many as are in the order of time. Where a clock leaps and comes back, those rows are
// left out that leapt, and not all that follow them.
template <class Sample, class Usable>
std::vector<const Sample*> in_order(const std::vector<Sample>& rows, Usable usable) {
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> last;                        // of the best order of each length: its last row
  std::vector<std::size_t> before(rows.size(), kNone);  // in the best order that ends with a row
  const auto earlier = [&rows](std::size_t i, TimeNs t) { return rows[i].header.stamp_ns < t; };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!usable(rows[i])) continue;
    const TimeNs t = rows[i].header.stamp_ns;
    const auto place = last.empty() || earlier(last.back(), t)
                           ? last.end()
                           : std::lower_bound(last.begin(), last.end(), t, earlier);
    if (place != last.begin()) before[i] = *(place - 1);
    if (place == last.end()) {
      last.push_back(i);
    } else if (t < rows[*place].header.stamp_ns) {
      *place = i;
    }
  }
  std::vector<const Sample*> out(last.size());
  std::size_t row = last.empty() ? kNone : last.back();
  for (auto kept = out.rbegin(); kept != out.rend(); ++kept, row = before[row]) *kept = &rows[row];
  return out;
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
  const auto usable = [](const GpsSample& fix) {
    return fix.fix >= GpsFix::fix_2d && known(fix.latitude_rad) && known(fix.longitude_rad);
  };
  for (const GpsSample* row : in_order(data.of<GpsSample>(), usable)) {
    const GpsSample& fix = *row;
    const double t = to_seconds(fix.header.stamp_ns - out.epoch_ns) - assumed.gps.latency_s;
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
  const auto kept = in_order(imu, [](const ImuSample& sample) {
    return geo::vec(sample.angular_rate_B_rad_s).allFinite() &&
           geo::vec(sample.specific_force_B_m_s2).allFinite();
  });
  out.epoch_ns = (kept.empty() ? &imu.front() : kept.front())->header.stamp_ns;
  const auto seconds = [&](const auto* sample) { return to_seconds(sample->header.stamp_ns - out.epoch_ns); };
  for (const ImuSample* sample : kept) {
    out.imu.t_s.push_back(seconds(sample));
    out.imu.rate.push_back(assumed.C_BI * geo::vec(sample->angular_rate_B_rad_s));
    out.imu.force.push_back(assumed.C_BI * geo::vec(sample->specific_force_B_m_s2));
  }
  take_gps(data, assumed, out);
  for (const DvlSample* sample : in_order(data.of<DvlSample>(), [](const DvlSample& one) {
         return one.mode == DvlMode::bottom && geo::vec(one.velocity_D_m_s).allFinite();
       })) {
    out.dvl.t_s.push_back(seconds(sample) - assumed.dvl.latency_s);
    out.dvl.v.push_back(geo::vec(sample->velocity_D_m_s));
  }
  for (const DepthSample* sample :
       in_order(data.of<DepthSample>(), [](const DepthSample& one) { return known(one.depth_m); })) {
    out.depth.t_s.push_back(seconds(sample) - assumed.depth.latency_s);
    out.depth.v.push_back(sample->depth_m);
  }
  for (const HeadingSample* sample :
       in_order(data.of<HeadingSample>(), [](const HeadingSample& one) { return known(one.heading_rad); })) {
    const double last = out.heading.v.empty() ? sample->heading_rad : out.heading.v.back();
    out.heading.t_s.push_back(seconds(sample) - assumed.heading.latency_s);
    out.heading.v.push_back(last + geo::wrap_pi(sample->heading_rad - last));
    out.heading_magnetic = sample->north == North::magnetic;
    if (known(sample->variation_rad)) out.heading_variation_rad = sample->variation_rad;
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
