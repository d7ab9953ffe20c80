#include "commission/depth_check.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "commission/asked.hpp"
#include "commission/fit/latency.hpp"
#include "commission/fit/track_fit.hpp"
#include "commission/heading_check.hpp"
#include "commission/text.hpp"

namespace fathom::commission {
namespace {

using Eigen::Vector3d;

constexpr double kDepthStep_s = 4.0;
constexpr double kDepthGap_s = 1.5;

struct Slope {
  double value = 0.0, sigma = 1e9, squares = 0.0;
  std::size_t count = 0;
};

Slope compare_depth(const ScalarSeries& depth, const ScalarSeries& sunk, double latency_s) {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  Slope out;
  for (std::size_t i = 0; i < depth.size();) {
    std::size_t k = i + 1;
    while (k < depth.size() && depth.t_s[k] - depth.t_s[i] < kDepthStep_s - 1e-3) ++k;
    if (k >= depth.size()) break;
    const auto a = at(sunk, depth.t_s[i] - latency_s, kDepthGap_s);
    const auto b = at(sunk, depth.t_s[k] - latency_s, kDepthGap_s);
    if (a && b && depth.t_s[k] - depth.t_s[i] < kDepthStep_s + 1.0) {
      xx += (*b - *a) * (*b - *a);
      xy += (*b - *a) * (depth.v[k] - depth.v[i]);
      yy += std::pow(depth.v[k] - depth.v[i], 2);
      ++out.count;
    }
    i = k;
  }
  if (out.count < 8 || xx <= 0.0) return out;
  out.value = xy / xx;
  out.squares = std::max(0.0, yy - xy * xy / xx);
  out.sigma = std::sqrt(out.squares / static_cast<double>(out.count - 1) / xx);
  return out;
}

template <class Add>
void report_depth_latency(const LatencyFit& fit, const Assumed& assumed, const Add& add) {
  const double offset = fit.latency_s;
  const double sigma = fit.sigma_s;
  const bool told = sigma < 0.15;
  const bool wrong = told && std::abs(offset) > 5.0 * sigma && std::abs(offset) > 0.5;
  const bool note = told && assumed.depth.configured && differs(offset, sigma, kNoticedLatency_s);
  const bool is_known = known_to(kAskedLatency_s, sigma);
  const std::string stamped = "The depth is stamped " + with_sigma(offset, sigma) +
                              " s later than the motion beyond the configured latency.";
  const char* const steeper = " Steeper dives would tell.";
  add("latency", FindingKind::latency, is_known,
      wrong  ? Severity::wrong
      : note ? Severity::note
             : Severity::ok,
      is_known ? stamped
      : told   ? stamped + " That is not known to five milliseconds." + steeper
               : std::string("The time offset of the depth cannot be told.") + steeper,
      assumed.depth.latency_s + offset, "s", sigma);
}

}  // namespace

Findings check_depth(const Series& series, const Assumed& assumed, const ImuReading& reading,
                     const VectorSeries& dvl_B, const JointFit& joint) {
  Findings out;
  const auto add = [&](const char* what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value = kUnknown, const char* unit = "", double sigma = kUnknown) {
    out.push_back({"depth", what, kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  if (series.depth.size() < 20) return out;
  // Way down by the DVL. Pairs are shorter than five seconds, so that what it is across a longer silence
  // counts nowhere.
  const VectorSeries down = down_of(series, reading, 5.0);
  ScalarSeries sunk;
  double last = 0.0;
  for (std::size_t i = 0; i < dvl_B.size(); ++i) {
    const auto axis = at(down, dvl_B.t_s[i], 0.5);
    if (!axis) continue;
    const Vector3d port =
        dvl_B.v[i] + rate_about(series.imu, reading, dvl_B.t_s[i]).cross(assumed.depth.lever_B_m);
    const double speed = axis->dot(port);
    const double before =
        sunk.size() > 0 ? sunk.v.back() + 0.5 * (dvl_B.t_s[i] - sunk.t_s.back()) * (speed + last) : 0.0;
    sunk.t_s.push_back(dvl_B.t_s[i]);
    sunk.v.push_back(before);
    last = speed;
  }
  const double latency = scan_latency(0.05, 30, [&](double latency_s) {
    const Slope slope = compare_depth(series.depth, sunk, latency_s);
    return slope.count >= 8 ? slope.squares : std::numeric_limits<double>::infinity();
  });
  const Slope best = compare_depth(series.depth, sunk, latency);
  if (best.count < 8 || !(std::abs(best.value) > 10.0 * best.sigma)) {
    add("sign", FindingKind::sign, false, Severity::ok,
        "Sign and unit of the depth cannot be told: there is no dive and ascent with the DVL on the bottom. "
        "A dive of some metres would tell.");
    return out;
  }
  struct Unit {
    double factor;
    const char* name;
  };
  static constexpr std::array<Unit, 6> kUnits{
      {{1.0, "m"}, {0.1, "bar"}, {3.2808, "ft"}, {100.0, "mbar or cm"}, {10.0, "kPa"}, {1000.0, "mm"}}};
  const Unit* unit = &kUnits[0];
  for (const Unit& each : kUnits)
    if (std::abs(std::log(std::abs(best.value) / each.factor)) <
        std::abs(std::log(std::abs(best.value) / unit->factor)))
      unit = &each;
  const bool fits = std::abs(std::log(std::abs(best.value) / unit->factor)) <
                    std::max(0.25, 3.0 * best.sigma / std::abs(best.value));
  add("sign", FindingKind::sign, true, best.value < 0.0 ? Severity::wrong : Severity::ok,
      best.value < 0.0 ? "The depth has the wrong sign: it falls where the vehicle sinks."
                       : "The depth grows where the vehicle sinks.",
      best.value < 0.0 ? -1.0 : 1.0, "");
  const std::string grows = "It grows by " + with_sigma(std::abs(best.value), best.sigma) +
                            " for each metre that the vehicle sinks by DVL";
  if (unit->factor != 1.0 && fits)
    add("unit", FindingKind::unit, true, Severity::wrong,
        std::string("The depth is in ") + unit->name + ", where metres are expected. " + grows + ".",
        best.value, "", best.sigma);
  else
    add("unit", FindingKind::unit, true, fits ? Severity::ok : Severity::wrong,
        fits ? "The depth is in metres. " + grows + "."
             : "The depth has a scale that belongs to no unit. " + grows + ".",
        best.value, "", best.sigma);
  std::optional<LatencyFit> late;
  if (joint.done && joint.sunk_m.size() > 0) {
    const Vector3d& l = assumed.depth.lever_B_m;
    ScalarSeries way = joint.sunk_m;
    for (std::size_t i = 0; i < way.size(); ++i) {
      const Vector3d& rpy = joint.rpy_rad.v[i];
      way.v[i] += std::cos(rpy.y()) * (std::sin(rpy.x()) * l.y() + std::cos(rpy.x()) * l.z()) -
                  std::sin(rpy.y()) * l.x();
    }
    if (const auto fit = fit_depth(series.depth, way, best.value, latency))
      late = LatencyFit{fit->latency_s.value, fit->latency_s.sigma};
  }
  if (!late) {
    const double h = 0.1;
    const double left = compare_depth(series.depth, sunk, latency - h).squares;
    const double right = compare_depth(series.depth, sunk, latency + h).squares;
    late = parabola(latency, h, left, best.squares, right, static_cast<double>(best.count));
  }
  if (late) report_depth_latency(*late, assumed, add);
  return out;
}

}  // namespace fathom::commission
