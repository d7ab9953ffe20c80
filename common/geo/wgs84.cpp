#include "geo/wgs84.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::geo {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravityEquator_m_s2 = 9.7803253359;
constexpr double kSomigliana = 0.00193185265241;  // (b g_p - a g_e) / (a g_e)
constexpr double kSemiMinorAxis_m = kSemiMajorAxis_m * (1.0 - kFlattening);
// omega^2 a^2 b / GM
constexpr double kRotation = kEarthRate_rad_s * kEarthRate_rad_s * kSemiMajorAxis_m * kSemiMajorAxis_m *
                             kSemiMinorAxis_m / kGravitationalConstant_m3_s2;
// Growth of gravity from the equator to a pole, per radius: d gravity / d(sin^2 L) / a. Gravity has no curl,
// so that its north component grows with altitude as gravity along down changes along the meridian.
constexpr double kLean_1_s2 =
    kGravityEquator_m_s2 * (kSomigliana + 0.5 * kEccentricitySquared) / kSemiMajorAxis_m;  // 8.1e-9
// Nearer than this to a pole the longitude of a short step means nothing.
constexpr double kLeastCosine = 1e-9;
constexpr double kNear_m = 1e3;

double away_from_zero(double cosine) {
  return cosine < kLeastCosine ? kLeastCosine : cosine;
}

Radii radii_at(double sine) {
  const double w2 = 1.0 - kEccentricitySquared * sine * sine;
  const double w = std::sqrt(w2);
  return {kSemiMajorAxis_m * (1.0 - kEccentricitySquared) / (w2 * w), kSemiMajorAxis_m / w};
}

/// `w` is 1 / sqrt(1 - e^2 sine^2).
double gravity_at(double sine, double w, double altitude_m) {
  const double s2 = sine * sine;
  const double surface = kGravityEquator_m_s2 * (1.0 + kSomigliana * s2) * w;
  const double linear = 2.0 / kSemiMajorAxis_m * (1.0 + kFlattening + kRotation - 2.0 * kFlattening * s2);
  const double ratio = altitude_m / kSemiMajorAxis_m;
  return surface * (1.0 - linear * altitude_m + 3.0 * ratio * ratio);
}

double gravity_north_at(double sine, double cosine, double altitude_m) {
  // In water it is left out: 4e-7 m/s^2 at 50 m, a hundredth of what the deflection of the vertical is.
  return -kLean_1_s2 * std::max(altitude_m, 0.0) * 2.0 * sine * cosine;
}

}  // namespace

Radii radii(double latitude_rad) {
  return radii_at(std::sin(latitude_rad));
}

double gravity(double latitude_rad, double altitude_m) {
  const double sine = std::sin(latitude_rad);
  return gravity_at(sine, 1.0 / std::sqrt(1.0 - kEccentricitySquared * sine * sine), altitude_m);
}

Eigen::Vector3d gravity_N(double latitude_rad, double altitude_m) {
  return {gravity_north_at(std::sin(latitude_rad), std::cos(latitude_rad), altitude_m), 0.0,
          gravity(latitude_rad, altitude_m)};
}

LocalEarth::LocalEarth(const Geodetic& at)
    : sine(std::sin(at.latitude_rad)), cosine(away_from_zero(std::cos(at.latitude_rad))) {
  // One root and its reciprocal serve the radii and gravity.
  const double w = 1.0 / std::sqrt(1.0 - kEccentricitySquared * sine * sine);
  normal_m = kSemiMajorAxis_m * w + at.altitude_m;
  meridian_m = kSemiMajorAxis_m * (1.0 - kEccentricitySquared) * w * w * w + at.altitude_m;
  gravity_m_s2 = gravity_at(sine, w, at.altitude_m);
  gravity_north_m_s2 = gravity_north_at(sine, cosine, at.altitude_m);
  earth_rate_N = {kEarthRate_rad_s * cosine, 0.0, -kEarthRate_rad_s * sine};
}

Eigen::Vector3d earth_rate_N(double latitude_rad) {
  return {kEarthRate_rad_s * std::cos(latitude_rad), 0.0, -kEarthRate_rad_s * std::sin(latitude_rad)};
}

Eigen::Vector3d transport_rate_N(const Geodetic& at, const Eigen::Vector3d& v_N_m_s) {
  const Radii r = radii(at.latitude_rad);
  const double east = v_N_m_s.y() / (r.normal_m + at.altitude_m);
  const double cosine = away_from_zero(std::cos(at.latitude_rad));
  return {east, -v_N_m_s.x() / (r.meridian_m + at.altitude_m), -east * std::sin(at.latitude_rad) / cosine};
}

Eigen::Vector3d difference_N(const Geodetic& from, const Geodetic& to) {
  const double latitude = 0.5 * (from.latitude_rad + to.latitude_rad);
  const double altitude = 0.5 * (from.altitude_m + to.altitude_m);
  const Radii r = radii(latitude);
  return {(to.latitude_rad - from.latitude_rad) * (r.meridian_m + altitude),
          wrap_pi(to.longitude_rad - from.longitude_rad) * (r.normal_m + altitude) * std::cos(latitude),
          from.altitude_m - to.altitude_m};
}

Geodetic moved_by(const Geodetic& from, const Eigen::Vector3d& delta_N_m) {
  Geodetic to;
  to.altitude_m = from.altitude_m - delta_N_m.z();
  const double altitude = 0.5 * (from.altitude_m + to.altitude_m);
  // One round settles the radius halfway to a nanometre over a kilometre, two to a micrometre over ten.
  double middle = from.latitude_rad;
  for (int round = 0; round < (std::abs(delta_N_m.x()) < kNear_m ? 1 : 2); ++round)
    middle = from.latitude_rad + 0.5 * delta_N_m.x() / (radii(middle).meridian_m + altitude);
  const Radii r = radii_at(std::sin(middle));
  const double cosine = away_from_zero(std::cos(middle));
  to.latitude_rad = from.latitude_rad + delta_N_m.x() / (r.meridian_m + altitude);
  to.longitude_rad = wrap_pi(from.longitude_rad + delta_N_m.y() / ((r.normal_m + altitude) * cosine));
  return to;
}

double wrap_pi(double angle_rad) {
  if (!(angle_rad <= -kPi || angle_rad > kPi)) return angle_rad;  // an unknown angle as well
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

double wrap_two_pi(double angle_rad) {
  const double wrapped = wrap_pi(angle_rad);
  const double positive = wrapped < 0.0 ? wrapped + 2.0 * kPi : wrapped;
  return positive >= 2.0 * kPi ? 0.0 : positive;
}

}  // namespace fathom::geo
