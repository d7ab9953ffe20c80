#include "commission/dvl_check.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "base/units.hpp"
#include "commission/asked.hpp"
#include "commission/fit/signed_axes.hpp"
#include "commission/text.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The rest of a sentence about what turns and the lever leave open.
constexpr const char* kSideways =
    " Starts and stops sideways or up and down, or turns in a current that sets the vehicle sideways, would "
    "tell.";
constexpr std::array<const char*, 3> kAngles{"roll", "pitch", "yaw"};

// What hypotheses do not agree on that explain the log alike, the log does not tell.
DvlFigures with_what_is_apart(const DvlFound& found) {
  DvlFigures out = found.fit;
  out.similarity.turn_sigma_rad = turn_sigma_rad(found);
  for (int axis = 0; axis < 3; ++axis)
    out.lever_sigma_m[axis] = std::hypot(out.lever_sigma_m[axis], found.lever_apart_m[axis]);
  out.latency_sigma_s = std::hypot(out.latency_sigma_s, found.latency_apart_s);
  return out;
}

}  // namespace

DvlCheck check_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading,
                   const DvlFound& by_log, Patch& patch) {
  DvlCheck out;
  const auto add = [&](std::string what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value = kUnknown, const char* unit = "", double sigma = kUnknown) {
    out.findings.push_back(
        {"dvl", std::move(what), kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  if (series.dvl.size() < 10) return out;
  const DvlFigures fit = with_what_is_apart(by_log);
  const bool mirrored = by_log.mirrored;
  const bool but_for_half_a_turn = by_log.about_the_way == DvlFound::AboutTheWay::but_for_half_a_turn;
  if (!fit.done) {
    add("mounting", FindingKind::missing, false, Severity::ok,
        "How the DVL is mounted cannot be told: there is no minute under way with the DVL on the bottom. "
        "Turns to both sides, starts and stops "
        "would tell.");
    return out;
  }
  const bool mirror_told = by_log.mirror_told;
  const Similarity& found = fit.similarity;
  Matrix3d D = Matrix3d::Identity();
  if (mirrored) D(1, 1) = -1.0;
  // Signs of the whole vector and of z are told apart by the motion that turns give.
  const Matrix3d axes = found.C * D;
  const bool negated = mirrored && (nearest_signed_axes(axes) + Matrix3d::Identity()).isZero(1e-9);
  add("mirror", FindingKind::axes, mirror_told, mirrored ? Severity::wrong : Severity::ok,
      negated    ? "The DVL velocity is negated: it is that of the bottom, not of the vehicle."
      : mirrored ? "The DVL velocity is mirrored: " + describe(nearest_signed_axes(axes)) + "."
      : mirror_told
          ? "The DVL is right-handed, as expected."
          : std::string("Whether the DVL is mirrored cannot be told: the vehicle slipped too little "
                        "sideways.") +
                (but_for_half_a_turn ? kSideways : " Tight turns under way would tell."));
  static constexpr std::array<Unit, 5> kUnits{
      {{1.0, "m/s"}, {1e-3, "mm/s"}, {1e-2, "cm/s"}, {kKnot_m_s, "knots"}, {kFoot_m, "ft/s"}}};
  const Unit* unit = &kUnits[0];
  for (const Unit& each : kUnits)
    if (std::abs(std::log(found.scale / each.factor)) < std::abs(std::log(found.scale / unit->factor)))
      unit = &each;
  const bool scale_told = found.scale_sigma < 0.2 * found.scale;
  if (unit->factor != 1.0 && scale_told)
    add("unit", FindingKind::unit, true, Severity::wrong,
        std::string("The DVL velocity is in ") + unit->name + ", where m/s are expected: the motion is " +
            with_sigma(found.scale, found.scale_sigma) + " of it.",
        found.scale, "", found.scale_sigma);
  const double excess = unit->factor / found.scale - 1.0;  // what it reads too much
  const double excess_sigma = found.scale_sigma / found.scale;
  const bool scale_known = excess_sigma < 0.05;
  add("scale", FindingKind::scale, scale_known,
      scale_known && std::abs(excess) > 0.05 && std::abs(excess) > 5.0 * excess_sigma ? Severity::wrong
                                                                                      : Severity::ok,
      scale_known ? "The DVL reads " + with_sigma(100.0 * excess, 100.0 * excess_sigma) + " % too much."
                  : "The scale of the DVL cannot be told to five per cent: starts, stops and turns under way "
                    "would tell.",
      excess, "", excess_sigma);
  // Mounting: of the DVL's axes in body, against what is configured. Roll is seen only where the vehicle
  // slips.
  const Vector3d rpy = geo::to_rpy(geo::from_matrix(found.C)) / kRadPerDeg;
  const Vector3d sigma = found.turn_sigma_rad / kRadPerDeg;
  const std::optional<Matrix3d> C_found = mounting_found(by_log, assumed.dvl.C_BD);
  const auto off_by = [&](const Matrix3d& C) {
    return Vector3d(geo::log(geo::from_matrix(assumed.dvl.C_BD.transpose() * C)) / kRadPerDeg);
  };
  const Vector3d off =
      (sigma.array() < kToldTurn_rad / kRadPerDeg).select(off_by(C_found.value_or(found.C)), off_by(found.C));
  // The same uncertainty as roll, pitch and yaw have it.
  Vector3d rpy_sigma = Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kStep = 1e-5;
    const Vector3d moved =
        geo::to_rpy(geo::from_matrix(found.C * geo::to_matrix(geo::exp(kStep * Vector3d::Unit(axis)))));
    for (int i = 0; i < 3; ++i) {
      const double slope = geo::wrap_pi(moved[i] - rpy[i] * kRadPerDeg) / kStep;
      rpy_sigma[i] = std::hypot(rpy_sigma[i], slope * sigma[axis]);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const bool told = sigma[axis] < kToldTurn_rad / kRadPerDeg;
    const bool is_known = known_to(kAskedTurn_deg, sigma[axis]);
    const bool wrong = told && std::abs(off[axis]) > 5.0 * sigma[axis] && std::abs(off[axis]) > 5.0;
    const bool note = told && assumed.dvl.configured && differs(off[axis], sigma[axis], kNoticedTurn_deg);
    const std::string turned = "The DVL is turned by " + with_sigma(off[axis], sigma[axis]) +
                               " degrees about its " + kAxes[i] + " axis against what is configured.";
    const std::string would =
        but_for_half_a_turn && by_log.turn_apart_rad[axis] > 0.0
            ? std::string(
                  " Half a turn about the way it goes, with another lever, explains the log as well: "
                  "all that was sideways came from turning.") +
                  kSideways
        : axis == 0 ? " The vehicle slipped too little sideways: tight turns would tell."
                    : " Starts, stops and turns under way would tell.";
    const Severity severity = wrong ? Severity::wrong : note ? Severity::note : Severity::ok;
    add(std::string("mounting_") + kAngles[i], FindingKind::mounting, is_known, severity,
        !told ? std::string("DVL mounting ") + kAngles[i] + " cannot be told to two degrees." + would
        : wrong && !C_found
            ? "The DVL is not mounted as configured: of the mountings that explain the log one is turned "
              "by " +
                  with_sigma(off[axis], sigma[axis]) + " degrees about its " + kAxes[i] +
                  " axis. Which it is the log does not tell, and none is written." + kSideways
            : (wrong ? turned + " Its " + kAngles[i] + " in the body is " + number(rpy[axis], 1) + " degrees."
                     : std::string("DVL mounting ") + kAngles[i] + " " +
                           with_sigma(rpy[axis], rpy_sigma[axis]) + " degrees.") +
                  (is_known ? "" : " That is not known to 0.2 degrees." + would),
        rpy[axis], "deg", rpy_sigma[axis]);
    add(std::string("turn_") + kAxes[i], FindingKind::mounting, is_known, Severity::ok, turned, off[axis],
        "deg", sigma[axis]);
    if (wrong || note) patch.C_BD = C_found;
  }
  if (mirrored) patch.C_BD.reset();  // a mirror is no mounting
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double s = fit.lever_sigma_m[axis];
    const double off_m = fit.lever_B_m[axis] - assumed.dvl.lever_B_m[axis];
    const bool is_known = known_to(kAskedLever_m, s);
    const bool moved = s < 0.2 && assumed.dvl.configured && differs(off_m, s, kNoticedLever_m);
    const std::string lies = std::string("The DVL lies ") + with_sigma(fit.lever_B_m[axis], s) + " m along " +
                             kAxes[i] + " from the inertial unit.";
    const std::string would = by_log.lever_apart_m[axis] > by_log.fit.lever_sigma_m[axis] ? kSideways
                              : axis == 2 ? " Rolling and pitching would tell."
                                          : " Quicker turns would tell.";
    add(std::string("lever_") + kAxes[i], FindingKind::lever, is_known, moved ? Severity::note : Severity::ok,
        is_known  ? lies
        : s < 0.2 ? lies + " That is not known to five centimetres." + would
                  : std::string("The lever of the DVL along ") + kAxes[i] + " cannot be told." + would,
        fit.lever_B_m[axis], "m", s);
    if (!moved) continue;
    if (!patch.dvl_lever_B_m) patch.dvl_lever_B_m = assumed.dvl.lever_B_m;
    (*patch.dvl_lever_B_m)[axis] = fit.lever_B_m[axis];
  }
  const bool told = fit.latency_sigma_s < 0.1;
  const bool late =
      told && std::abs(fit.latency_s) > 0.2 && std::abs(fit.latency_s) > 5.0 * fit.latency_sigma_s;
  const bool note =
      told && assumed.dvl.configured && differs(fit.latency_s, fit.latency_sigma_s, kNoticedLatency_s);
  const bool late_known = known_to(kAskedLatency_s, fit.latency_sigma_s);
  const std::string stamped = "The DVL is stamped " + with_sigma(fit.latency_s, fit.latency_sigma_s) + " s " +
                              (late ? "late" : "later than the motion") + " beyond the configured latency.";
  const char* const quicker = " Starts, stops and turns under way would tell.";
  add("latency", FindingKind::latency, late_known,
      late   ? Severity::wrong
      : note ? Severity::note
             : Severity::ok,
      late_known ? stamped
      : told     ? stamped + " That is not known to five milliseconds." + quicker
                 : std::string("The time offset of the DVL cannot be told.") + quicker,
      assumed.dvl.latency_s + fit.latency_s, "s", fit.latency_sigma_s);
  if (late || note) patch.dvl_latency_s = assumed.dvl.latency_s + fit.latency_s;
  const Matrix3d M = found.scale * axes;
  // A lever that the log does not tell is as configured.
  Vector3d lever = assumed.dvl.lever_B_m;
  for (int axis = 0; axis < 3; ++axis)
    if (fit.lever_sigma_m[axis] < 0.2) lever[axis] = fit.lever_B_m[axis];
  for (std::size_t i = 0; i < series.dvl.size(); ++i) {
    const double t = series.dvl.t_s[i] - fit.latency_s;
    out.velocity_B.t_s.push_back(t);
    out.velocity_B.v.push_back(M * series.dvl.v[i] - rate_about(series.imu, reading, t).cross(lever));
  }
  return out;
}

}  // namespace fathom::commission
