#include "study/consistency/ecef.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace fathom::study::ecef {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kEquator_m = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);
constexpr double kGm_m3_s2 = 3.986004418e14;
constexpr double kJ2 = 1.082629821313e-3;
constexpr int kZonals = 5;

/// J2, J4 ... J10 of an ellipsoid that is a level surface: they follow from its shape and J2.
std::array<double, kZonals> zonals() {
  std::array<double, kZonals> j{};
  double power = 1.0;
  for (int n = 1; n <= kZonals; ++n) {
    power *= kEccentricitySquared;
    const double sign = n % 2 == 0 ? -1.0 : 1.0;
    j[static_cast<std::size_t>(n - 1)] =
        sign * 3.0 * power / ((2 * n + 1) * (2 * n + 3)) * (1.0 - n + 5.0 * n * kJ2 / kEccentricitySquared);
  }
  return j;
}

double normal_radius_m(double sine) {
  return kEquator_m / std::sqrt(1.0 - kEccentricitySquared * sine * sine);
}

}  // namespace

Vector3d to_cartesian(const Geodetic& place) {
  const double sine = std::sin(place.latitude_rad);
  const double cosine = std::cos(place.latitude_rad);
  const double n = normal_radius_m(sine);
  return {(n + place.height_m) * cosine * std::cos(place.longitude_rad),
          (n + place.height_m) * cosine * std::sin(place.longitude_rad),
          (n * (1.0 - kEccentricitySquared) + place.height_m) * sine};
}

Geodetic to_geodetic(const Vector3d& r_E_m) {
  const double axis_m = std::hypot(r_E_m.x(), r_E_m.y());
  Geodetic out;
  out.longitude_rad = std::atan2(r_E_m.y(), r_E_m.x());
  // The normal through the point meets the axis e^2 n sin(latitude) below the centre.
  double tangent = r_E_m.z() / (axis_m * (1.0 - kEccentricitySquared));
  double sine = 0.0;
  for (int i = 0; i < 6; ++i) {
    sine = tangent / std::sqrt(1.0 + tangent * tangent);
    tangent = (r_E_m.z() + kEccentricitySquared * normal_radius_m(sine) * sine) / axis_m;
  }
  out.latitude_rad = std::atan(tangent);
  const double cosine = std::cos(out.latitude_rad);
  sine = std::sin(out.latitude_rad);
  out.height_m =
      axis_m * cosine + r_E_m.z() * sine - kEquator_m * std::sqrt(1.0 - kEccentricitySquared * sine * sine);
  return out;
}

Matrix3d axes_EN(const Geodetic& place) {
  const double sl = std::sin(place.latitude_rad);
  const double cl = std::cos(place.latitude_rad);
  const double so = std::sin(place.longitude_rad);
  const double co = std::cos(place.longitude_rad);
  Matrix3d axes;
  axes << -sl * co, -so, -cl * co,  //
      -sl * so, co, -cl * so,       //
      cl, 0.0, -sl;
  return axes;
}

Vector3d gravitation_E_m_s2(const Vector3d& r_E_m) {
  static const std::array<double, kZonals> j = zonals();
  const double r = r_E_m.norm();
  const double s = r_E_m.z() / r;
  const double ratio = (kEquator_m / r) * (kEquator_m / r);
  // Legendre polynomials and their slopes by recursion; only the even ones act.
  double before = 1.0;
  double p = s;
  double radial = 1.0;
  double meridian = 0.0;
  double power = 1.0;
  for (int degree = 2; degree <= 2 * kZonals; ++degree) {
    const double next = ((2 * degree - 1) * s * p - (degree - 1) * before) / degree;
    before = p;
    p = next;
    if (degree % 2 != 0) continue;
    const double slope = degree * (before - s * p) / (1.0 - s * s);
    power *= ratio;
    const double weight = j[static_cast<std::size_t>(degree / 2 - 1)] * power;
    radial -= (degree + 1) * weight * p;
    meridian += weight * slope;
  }
  const double strength = kGm_m3_s2 / (r * r);
  const Vector3d out = r_E_m / r;
  return -strength * radial * out - strength * meridian * (Vector3d::UnitZ() - s * out);
}

Geodetic moved(const Geodetic& from, const Vector3d& step_N_m) {
  return to_geodetic(to_cartesian(from) + axes_EN(from) * step_N_m);
}

Vector3d offset_N_m(const Geodetic& origin, const Geodetic& place) {
  return axes_EN(origin).transpose() * (to_cartesian(place) - to_cartesian(origin));
}

}  // namespace fathom::study::ecef
