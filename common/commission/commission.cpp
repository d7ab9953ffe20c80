#include "commission/commission.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "commission/asked.hpp"
#include "commission/depth_check.hpp"
#include "commission/dvl_check.hpp"
#include "commission/explanation.hpp"
#include "commission/fit/joint_fit.hpp"
#include "commission/gps_check.hpp"
#include "commission/heading_check.hpp"
#include "commission/imu_axes.hpp"
#include "commission/imu_noise.hpp"
#include "commission/text.hpp"
#include "geo/so3.hpp"

namespace fathom::commission {
namespace {

using Eigen::Vector3d;

constexpr double kWindow_s = 12.0;
// Of the rate that an inertial unit reads at rest, as a bias: the Earth turns, and it wanders.
constexpr double kRest_s = 20.0;
constexpr double kBiasAtRest_rad_s = 3e-4;
constexpr double kBias_rad_s = 0.01;
constexpr std::size_t kLeastSamples = 100;
constexpr std::size_t kFew = 16;    // windows that hypotheses are compared on
constexpr std::size_t kMany = 250;  // and that figures come from

void append(Findings& to, Findings from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

void report_gps(const GpsFit& fit, const Assumed& assumed, bool has_down, Commissioning& out) {
  const auto add = [&](std::string what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value, const char* unit, double sigma) {
    out.findings.push_back(
        {"gps", std::move(what), kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  if (!fit.done) {
    out.findings.push_back({"gps", "latency", FindingKind::missing, kUnknown, "", kUnknown, false,
                            Severity::ok,
                            "Latency and lever of the antenna cannot be told: there is no minute under way "
                            "with GPS. Turns to both sides, starts and "
                            "stops would tell."});
    return;
  }
  const bool told = fit.latency_sigma_s < 0.1;
  const bool late =
      told && std::abs(fit.latency_s) > 0.3 && std::abs(fit.latency_s) > 5.0 * fit.latency_sigma_s;
  const bool note =
      told && assumed.gps.configured && differs(fit.latency_s, fit.latency_sigma_s, kNoticedLatency_s);
  const bool late_known = known_to(kAskedLatency_s, fit.latency_sigma_s);
  const std::string late_by = "GPS is stamped " + with_sigma(fit.latency_s, fit.latency_sigma_s) +
                              " s later than the motion beyond the configured latency.";
  const char* const quicker = " Quicker turns, starts and stops at the surface would tell.";
  add("latency", FindingKind::latency, late_known,
      late   ? Severity::wrong
      : note ? Severity::note
             : Severity::ok,
      late_known ? late_by
      : told     ? late_by + " That is not known to five milliseconds." + quicker
                 : std::string("The time offset of GPS cannot be told.") + quicker,
      assumed.gps.latency_s + fit.latency_s, "s", fit.latency_sigma_s);
  if (late || note) out.patch.gps_latency_s = assumed.gps.latency_s + fit.latency_s;
  for (int axis = 0; axis < 3; ++axis) {
    const double s = fit.lever_sigma_m[axis];
    const double off = fit.lever_B_m[axis] - assumed.gps.lever_B_m[axis];
    const bool moved = s < 0.3 && assumed.gps.configured && differs(off, s, kNoticedLever_m);
    const std::string name = kAxes[static_cast<std::size_t>(axis)];
    const std::string lies = "The antenna lies " + with_sigma(fit.lever_B_m[axis], s) + " m along " + name +
                             " from the inertial unit.";
    const std::string would = axis == 2 ? " Rolling and pitching would tell." : " Quicker turns would tell.";
    const bool is_known = known_to(kAskedLever_m, s);
    add("lever_" + name, FindingKind::lever, is_known, moved ? Severity::note : Severity::ok,
        is_known  ? lies
        : s < 0.3 ? lies + " That is not known to five centimetres." + would
                  : "The lever of the antenna along " + name + " cannot be told." + would,
        fit.lever_B_m[axis], "m", s);
    if (!moved) continue;
    if (!out.patch.gps_lever_B_m) out.patch.gps_lever_B_m = assumed.gps.lever_B_m;
    (*out.patch.gps_lever_B_m)[axis] = fit.lever_B_m[axis];
  }
  const double steady = fit.way.direction_B.norm();
  if (steady > kSteady) {
    const Vector3d& way_B = fit.way.direction_B;
    const double yaw = std::atan2(way_B.y(), way_B.x());
    const double pitch = -std::asin(std::clamp(way_B.z() / steady, -1.0, 1.0));
    const double sigma = fit.way.sigma_rad;
    out.findings.push_back({"imu", "travel_yaw", FindingKind::mounting, yaw / kRadPerDeg, "deg",
                            sigma / kRadPerDeg, true, Severity::ok,
                            "The vehicle goes " + with_sigma(yaw / kRadPerDeg, sigma / kRadPerDeg) +
                                " degrees to the right of the x axis on average" +
                                (has_down ? ", and " + number(pitch / kRadPerDeg, 1) + " degrees above it. "
                                          : std::string(". ")) +
                                "On wheels that is the mounting; in water and air drift "
                                "and trim are in it."});
  }
}

void report_datum(const Series& series, Findings& out) {
  if (series.gps_position.size() == 0 || series.depth.size() == 0 || !known(series.first_altitude_m)) return;
  const auto depth = at(series.depth, series.gps_position.t_s.front(), 2.0);
  if (!depth || std::abs(*depth) > 1.0) return;
  const double altitude = series.first_altitude_m;
  out.push_back(
      {"gps", "altitude_datum", FindingKind::datum, altitude, "m", 3.0, false, Severity::ok,
       "The GPS altitude is " + number(altitude, 1) +
           " m where the depth says surface. At sea that is the height of the geoid if altitudes are "
           "above the ellipsoid, as they must be, and about zero if they are above sea level. The log alone "
           "cannot tell on a lake."});
}

}  // namespace

bool Patch::empty() const {
  return !imu_rate_hz && !C_BI && !C_BD && !gps_lever_B_m && !dvl_lever_B_m && !gps_latency_s &&
         !dvl_latency_s && !depth_latency_s && !heading_latency_s && !heading_yaw_rad && !angle_random_walk &&
         !velocity_random_walk;
}

Commissioning commission(const dataset::Dataset& data, const Assumed& assumed) {
  Commissioning out;
  const Series series = series_of(data, assumed);
  if (series.imu.size() < kLeastSamples) {
    out.findings.push_back({"imu", "samples", FindingKind::missing, static_cast<double>(series.imu.size()),
                            "", kUnknown, false, Severity::wrong,
                            "The inertial unit has " + std::to_string(series.imu.size()) +
                                " samples of finite values in the order of time; nothing can be told."});
    return out;
  }
  out.duration_s = series.imu.t_s.back();
  const std::vector<Span> rest = rest_spans(series);
  out.rest_s = rest.empty() ? 0.0 : rest.front().to_s - rest.front().from_s;
  ImuNoise noise = check_imu_noise(series, assumed, rest);
  out.gyro_allan = noise.gyro;
  out.force_allan = noise.force;
  for (const Finding& finding : noise.findings) {
    if (finding.what == "rate" && finding.severity == Severity::wrong) out.patch.imu_rate_hz = finding.value;
    if (finding.what == "gyro_noise" && finding.severity != Severity::ok)
      out.patch.angle_random_walk = finding.value * kRadPerDeg / 60.0;
    if (finding.what == "accelerometer_noise" && finding.severity != Severity::ok)
      out.patch.velocity_random_walk = finding.value / 60.0;
  }
  append(out.findings, noise.findings);

  GpsCheck gps = check_gps(series);
  append(out.findings, gps.findings);
  Evidence evidence;
  evidence.rest = rest;
  if (gps.usable) evidence.gps = windows_of(series, gps.velocity_N, kWindow_s, 6, kFew);
  evidence.dvl = windows_of(series, series.dvl, kWindow_s, 6, kFew);
  ImuAxes axes = check_imu_axes(series, assumed, gps, evidence);
  // A time offset of a second hides the axes: look for it with what was found, and look again.
  if (evidence.gps.size() >= 3)
    evidence.gps_latency_s = scan_gps_latency(series, gps, evidence.gps, axes.reading);
  if (evidence.dvl.size() >= 3) evidence.dvl_latency_s = scan_dvl_latency(series, evidence.dvl, axes.reading);
  if (std::abs(evidence.gps_latency_s) > 0.15 || std::abs(evidence.dvl_latency_s) > 0.15)
    axes = check_imu_axes(series, assumed, gps, evidence);
  append(out.findings, axes.findings);
  for (const Finding& finding : axes.findings) {
    const bool turned = finding.what == "mounting" && finding.severity == Severity::wrong;
    if (turned) out.patch.C_BI = axes.reading.rate * assumed.C_BI;
  }

  GpsFit gps_fit;
  if (gps.usable) {
    const std::vector<Span> windows = windows_of(series, gps.velocity_N, kWindow_s, 6, kMany);
    if (windows.size() >= 3)
      gps_fit = fit_gps(series, gps.velocity_N, windows, axes.reading, evidence.gps_latency_s,
                        assumed.gps.lever_B_m);
  }
  DvlFound dvl_found;
  if (series.dvl.size() >= 10) dvl_found = find_dvl(series, assumed, axes.reading, evidence.dvl_latency_s);
  JointFit joint;
  if (gps_fit.done && gps_fit.attitude && known(series.latitude_rad)) {
    joint = fit_joint(series, gps.velocity_N,
                      {axes.reading, gps_fit, noise.angle_random_walk, noise.velocity_random_walk,
                       out.rest_s > kRest_s ? kBiasAtRest_rad_s : kBias_rad_s, gps.sigma_m_s,
                       dvl_found.fit.done, dvl_found.fit});
    if (joint.done) gps_fit = joint.gps;
    if (joint.done && joint.dvl.done) dvl_found.fit = joint.dvl;
  }
  if (gps.usable) report_gps(gps_fit, assumed, gps.velocity_N.has_down, out);
  DvlCheck dvl = check_dvl(series, assumed, axes.reading, dvl_found, out.patch);
  append(out.findings, dvl.findings);
  append(out.findings, check_heading(series, assumed, axes.reading, gps, dvl.velocity_B, joint));
  append(out.findings, check_depth(series, assumed, axes.reading, dvl.velocity_B, joint));
  for (const Finding& finding : out.findings) {
    if (finding.severity == Severity::ok) continue;
    if (finding.sensor == "heading" && finding.what == "latency") out.patch.heading_latency_s = finding.value;
    if (finding.sensor == "heading" && finding.what == "offset" && !series.heading_magnetic)
      out.patch.heading_yaw_rad = finding.value * kRadPerDeg;
    if (finding.sensor == "depth" && finding.what == "latency") out.patch.depth_latency_s = finding.value;
  }
  report_datum(series, out.findings);
  return out;
}

}  // namespace fathom::commission
