// What the sums say, and how it is said.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/units.hpp"
#include "estimation/navigator/plausibility/plausibility.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix2d;

/// A likelihood ratio above c is seen once in c times where all is as configured, however often one looks
/// (Ville); of all explanations together once in ten thousand.
constexpr double kExplanations = 57.0;
constexpr double kFalseAlarms = 1e-4;
const double kClaim = std::log(kExplanations / kFalseAlarms);
constexpr double kHeld_s = 4.5;
constexpr double kFewestIntervals = 50.0;
/// Of the rate of the IMU: oscillators are off by far less, and a stamp by 0.1 s at either end of the time
/// that is needed.
constexpr double kRateShare = 0.05;
/// No clock is off by more, and no usual rate lies nearer to another: 100 and 120 Hz are two settings, and
/// time is right with either.
constexpr double kOtherRate = 0.15;
/// Less may be a compass's deviation, or a current that nobody knows.
constexpr double kLeastTurn_rad = 25.0 * kRadPerDeg;

const Proof kClaimed{.fewest = kFewestPairs, .most_left = 0.25, .claim = kClaim};
/// Enough not to rely on a vehicle, and far from enough to accuse one.
constexpr Proof kDoubted{.fewest = 1.0, .most_left = 0.25, .claim = 0.0};
/// Of what a compass says against a gyro, while the course may yet say that it is the compass.
constexpr double kUntilCourseSpeaks = 0.5;
/// What was claimed once stays until the configuration explains as much.
constexpr Proof kStanding{.fewest = kFewestPairs, .most_left = 1.0, .claim = 0.0};

Matrix2d matrix(double a, double b, double c, double d) {
  Matrix2d out;
  out << a, b, c, d;
  return out;
}

}  // namespace

/// The explanation that is proven best, of those that are asked for.
struct Plausibility::Best {
  double evidence;                       ///< to be exceeded
  Implausible only = Implausible::none;  ///< none: all
  PlausibilityFinding finding{};
  void hear(Implausible kind, double value, double evidence_for_it) {
    if (!(evidence_for_it > evidence) || (only != Implausible::none && only != kind)) return;
    evidence = evidence_for_it;
    finding = {kind, value};
  }
  /// `share`: of the evidence that counts.
  /// A vehicle may turn on the spot, and a compass may hang: that is a doubt, as long as the other one does
  /// not turn on its own, and no fault of the gyro.
  void hear_turns(const PairFit& fit, const Proof& proof, double share = 1.0) {
    const auto hear_factor = [&](Implausible kind, double factor) {
      if (fit.is_related(factor) || (!proof.accuses() && !fit.moves()))
        hear(kind, factor, share * fit.evidence(factor, proof));
    };
    hear_factor(Implausible::gyro_negated, -1.0);
    for (const double sign : {1.0, -1.0}) {
      hear_factor(Implausible::gyro_in_degrees, sign * kRadPerDeg);
      hear_factor(Implausible::gyro_too_slow, sign / kRadPerDeg);
    }
  }
  void hear_headings(const PairFit& fit, const Proof& proof) {
    hear(Implausible::heading_negated, -1.0, fit.evidence(-1.0, proof));
    hear(Implausible::heading_unit, kDegPerRad, fit.evidence(kRadPerDeg, proof));
  }
  void hear_track(const PairFit& fit, double latitude_rad, const Proof& proof) {
    // Where it would be with radians for degrees: the way east is another one there.
    const double there_rad = latitude_rad * kDegPerRad;
    if (std::abs(there_rad) < 1.57) {
      const double east = std::cos(latitude_rad) / std::cos(there_rad);
      hear(Implausible::gps_place_unit, kDegPerRad,
           fit.evidence(matrix(kRadPerDeg, 0.0, 0.0, kRadPerDeg * east), proof));
    }
    for (const double factor : {kKnot_m_s, kKmh_m_s, 1e-2, 1e-3})
      hear(Implausible::gps_unit, factor, fit.evidence(factor, proof));
    hear(Implausible::gps_axes, 0.0, fit.evidence(matrix(0, 1, 1, 0), proof));
    hear(Implausible::gps_axes, 0.0, fit.evidence(matrix(-1, 0, 0, 1), proof));
    hear(Implausible::gps_axes, 0.0, fit.evidence(matrix(1, 0, 0, -1), proof));
    hear(Implausible::gps_axes, 0.0, fit.evidence(matrix(-1, 0, 0, -1), proof));
  }
  void hear_speed(const PairFit& fit, const Proof& proof) {
    for (const double factor : {1e-3, 1e-2, kKnot_m_s, kFoot_m, 1e3})
      hear(Implausible::dvl_unit, factor, fit.evidence(factor, proof));
  }
  void hear_depth(const PairFit& fit, const Proof& proof) {
    // The reading of one metre: bar, millibar, pascal, feet.
    for (const double reading : {0.0997, 99.7, 9970.0, 1.0 / kFoot_m})
      hear(Implausible::depth_unit, 1.0 / reading, fit.evidence(reading, proof));
    hear(Implausible::depth_upwards, -1.0, fit.evidence(-1.0, proof));
  }
  void hear_ground(const PairFit& ground, const PairFit& mirror, const Proof& proof) {
    const double angle = ground.turn_rad();
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    if (std::abs(angle) > kLeastTurn_rad)
      hear(Implausible::dvl_turned, angle, ground.evidence(matrix(c, -s, s, c), proof));
    hear(Implausible::dvl_mirrored, 0.0, ground.evidence_of(mirror.left_over(Matrix2d::Identity()), proof));
  }
};

std::string_view to_string(Implausible kind) {
  static constexpr std::array<std::string_view, kImplausibles> kNames{
      "none",       "force_in_g",    "force_downwards", "force_along_x",   "force_along_y",
      "imu_rate",   "gyro_negated",  "gyro_axes",       "gyro_in_degrees", "gyro_too_slow",
      "gps_axes",   "gps_unit",      "dvl_unit",        "dvl_turned",      "dvl_mirrored",
      "depth_unit", "depth_upwards", "heading_unit",    "heading_negated", "gps_place_unit"};
  return kNames[std::min(static_cast<std::size_t>(kind), kImplausibles - 1)];
}

bool Plausibility::judge_force() {
  // How a unit lies does not change: a vehicle that has been upright once flies loops, or stands on its nose.
  upright_ = upright_ || upwards_s_ > kHeld_s;
  if (upright_) return false;
  if (in_g_s_ > kHeld_s) {
    finding_ = {Implausible::force_in_g, kStandardGravity_m_s2};
  } else if (downwards_s_ > kHeld_s) {
    finding_ = {Implausible::force_downwards, -1.0};
  } else if (along_x_s_ > kHeld_s) {
    finding_ = {Implausible::force_along_x, 0.0};
  } else if (along_y_s_ > kHeld_s) {
    finding_ = {Implausible::force_along_y, 0.0};
  } else {
    // It stands until gravity is felt as it should be.
    return finding_.kind >= Implausible::force_in_g && finding_.kind <= Implausible::force_along_y;
  }
  return true;
}

double Plausibility::off(const Setup& setup, double count) const {
  return std::abs(count / (interval_s_ * setup.config.imu.nominal_rate_hz) - 1.0);
}

void Plausibility::explain(const Proof& proof, const OtherAxes& by_tilts, Best& best) const {
  // A gyro that goes along with one of the two is not what the other one speaks against.
  if (course_.fit.agrees()) {
    best.hear_headings(compass_.fit, proof);
  } else if (course_.fit.is_empty() || course_.fit.refutes()) {
    const bool waits = course_.from_ns != 0 && course_.fit.is_empty();
    best.hear_turns(compass_.fit, proof, waits ? kUntilCourseSpeaks : 1.0);
  }
  if (!compass_.fit.agrees()) best.hear_turns(course_.fit, proof);
  for (const OtherAxes other : {axes_.other(proof), by_tilts})
    best.hear(Implausible::gyro_axes, static_cast<double>(other.number), other.evidence);
  best.hear_track(track_.fit, track_.latitude_rad, proof);
  // Only a GPS velocity that goes along its positions can speak against a DVL.
  if (!best.finding && track_.fit.agrees()) {
    best.hear_speed(speed_, proof);
    if (!compass_.fit.refutes()) best.hear_ground(ground_, mirror_, proof);
  }
  // And only a DVL that goes along with GPS, where there is one, against a depth.
  const bool vouched = (speed_.is_empty() || speed_.agrees()) && (ground_.is_empty() || ground_.agrees());
  if (!best.finding && vouched) best.hear_depth(depth_.fit, proof);
}

bool Plausibility::is_doubted() const {
  Best best{.evidence = kDoubted.claim};
  explain(kDoubted, {}, best);
  return static_cast<bool>(best.finding);
}

bool Plausibility::stands() const {
  if (finding_.kind == Implausible::gyro_axes && tilts_.stands(static_cast<std::size_t>(finding_.value)))
    return true;
  Best best{.evidence = kStanding.claim, .only = finding_.kind};
  explain(kStanding, {}, best);
  return static_cast<bool>(best.finding);
}

void Plausibility::judge(const Setup& setup) {
  if (judge_force()) {
    // Nobody knew which way was down.
    compass_.fit.reset();
    course_.fit.reset();
    depth_.fit.reset();
    return;
  }
  const double rate_hz = interval_s_ > 0.0 ? intervals_ / interval_s_ : 0.0;
  const double by_intervals = off(setup, intervals_);
  if (interval_s_ > kHeard_s && intervals_ > kFewestIntervals && by_intervals < kOtherRate &&
      by_intervals > kRateShare && off(setup, slots_) > kRateShare) {
    finding_ = {Implausible::imu_rate, rate_hz};
    return;
  }
  // What is as it should be needs no more time; what is not has the time to be found out.
  sound_ = sound_ || (upwards_s_ > 0.0 && by_intervals < kRateShare);
  Best best{.evidence = kClaimed.claim};
  explain(kClaimed, tilts_.other(), best);
  if (best.finding || !finding_ || !stands()) finding_ = best.finding;
}

void write_sentence(const PlausibilityFinding& finding, double nominal_rate_hz, std::array<char, 128>& out) {
  out.fill('\0');
  const auto say = [&out](const char* format, auto... values) {
    std::snprintf(out.data(), out.size(), format, values...);
  };
  const double v = finding.value;
  switch (finding.kind) {
    case Implausible::none:
      return;
    case Implausible::force_in_g:
      return say("%s",
                 "Not plausible: accelerometer reads 1 in rest, m/s2 are expected: multiply it by 9.80665.");
    case Implausible::force_downwards:
      return say("%s",
                 "Not plausible: force is felt downwards: negate accelerometer x, y, z, or turn the IMU by "
                 "180 deg.");
    case Implausible::force_along_x:
      return say("%s",
                 "Not plausible: gravity lies along x: exchange accelerometer x and z, or set the IMU's "
                 "mounting pitch.");
    case Implausible::force_along_y:
      return say("%s",
                 "Not plausible: gravity lies along y: exchange accelerometer y and z, or set the IMU's "
                 "mounting roll.");
    case Implausible::gyro_axes:
      return say("Not plausible: the gyro turns otherwise than gravity: %s.",
                 axes_hypothesis(static_cast<std::size_t>(v)).remedy);
    case Implausible::imu_rate:
      return say(
          "Not plausible: the IMU gives %.1f Hz, configured are %.1f Hz: check its clock, or set the rate.",
          v, nominal_rate_hz);
    case Implausible::gyro_negated:
      return say(
          "%s", "Not plausible: the gyro turns against compass or course: negate its z (or all three) axes.");
    case Implausible::gyro_in_degrees:
      return say("Not plausible: the gyro is in deg/s, rad/s are expected: multiply it by %.6f.", v);
    case Implausible::gyro_too_slow:
      return say("Not plausible: the gyro turns 57 times too slowly: multiply it by %.4f.", v);
    case Implausible::gps_axes:
      return say("%s",
                 "Not plausible: GPS velocity does not go along its positions: is it east, north, up? NED is "
                 "expected.");
    case Implausible::gps_unit:
      return say(
          "Not plausible: GPS velocity is not in m/s: multiply it by %.4g to agree with its positions.", v);
    case Implausible::dvl_unit:
      return say("Not plausible: DVL velocity is not in m/s: multiply it by %.4g to agree with GPS.", v);
    case Implausible::dvl_turned:
      return say(
          "Not plausible: DVL and GPS point apart: turn the DVL's mounting yaw by %+.0f deg, or check the "
          "compass.",
          v / kRadPerDeg);
    case Implausible::dvl_mirrored:
      return say("%s", "Not plausible: DVL velocity is mirrored against GPS: negate its y axis.");
    case Implausible::depth_unit:
      return say("Not plausible: depth is not in m: multiply it by %.4g to agree with the DVL.", v);
    case Implausible::depth_upwards:
      return say("%s",
                 "Not plausible: depth falls as the DVL goes down: negate the depth, or the DVL's z axis.");
    case Implausible::heading_unit:
      return say(
          "Not plausible: heading turns 57 times less than gyro and course: radians? Multiply it by %.4f.",
          v);
    case Implausible::heading_negated:
      return say("%s",
                 "Not plausible: heading turns against gyro and course: clockwise is expected, negate it.");
    case Implausible::gps_place_unit:
      return say(
          "Not plausible: GPS positions go 57 times less far than its velocity: multiply them by %.4f.", v);
  }
}

}  // namespace fathom::estimation
