#pragma once

#include <cmath>

#include <Eigen/Core>

#include "geo/wgs84.hpp"

namespace fathom::test {

/// Normal gravity from its closed potential in ellipsoidal coordinates (Heiskanen and Moritz 1967, 2-7), by
/// central differences: exact at every altitude, and nothing in it is what common/geo computes by.
class NormalPotential {
 public:
  /// Along N, m/s^2.
  [[nodiscard]] static Eigen::Vector3d gravity_N(double latitude_rad, double altitude_m) {
    const double n = geo::radii(latitude_rad).normal_m;
    const long double p = (n + altitude_m) * std::cos(latitude_rad);
    const long double z = (n * (1.0 - geo::kEccentricitySquared) + altitude_m) * std::sin(latitude_rad);
    constexpr long double kStep = 50.0L;  // metres
    const auto along = [&](long double dp, long double dz) {
      return static_cast<double>(
          (potential(p + kStep * dp, z + kStep * dz) - potential(p - kStep * dp, z - kStep * dz)) /
          (2.0L * kStep));
    };
    const long double s = std::sin(latitude_rad);
    const long double c = std::cos(latitude_rad);
    return {along(-s, c), 0.0, along(-c, -s)};
  }

 private:
  /// Of gravitation and rotation, at the distance p from the axis and z above the equator's plane.
  static long double potential(long double p, long double z) {
    constexpr long double a = geo::kSemiMajorAxis_m;
    constexpr long double b = a * (1.0L - geo::kFlattening);
    const long double e = std::sqrt(a * a - b * b);
    const long double w2 = static_cast<long double>(geo::kEarthRate_rad_s) * geo::kEarthRate_rad_s;
    const long double d = p * p + z * z - e * e;
    const long double u = std::sqrt(0.5L * (d + std::sqrt(d * d + 4.0L * e * e * z * z)));
    const long double sine = z / u;  // of the reduced latitude
    const auto q = [e](long double at) {
      return 0.5L * ((1.0L + 3.0L * at * at / (e * e)) * std::atan(e / at) - 3.0L * at / e);
    };
    return geo::kGravitationalConstant_m3_s2 / e * std::atan(e / u) +
           0.5L * w2 * a * a * q(u) / q(b) * (sine * sine - 1.0L / 3.0L) + 0.5L * w2 * p * p;
  }
};

}  // namespace fathom::test
