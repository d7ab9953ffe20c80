#pragma once

#include <cmath>

#include <Eigen/Core>

/// The WGS-84 ellipsoid, its gravity, and the rates of the local level frame N (north, east, down).
/// Angles in rad, lengths in m, altitude above the ellipsoid, up positive.
namespace fathom::geo {

inline constexpr double kSemiMajorAxis_m = 6378137.0;
inline constexpr double kFlattening = 1.0 / 298.257223563;
inline constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);
inline constexpr double kEarthRate_rad_s = 7.292115e-5;
inline constexpr double kGravitationalConstant_m3_s2 = 3.986004418e14;

/// A point by its geodetic coordinates.
struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;
};

struct Radii {
  double meridian_m = 0.0;  ///< R_M
  double normal_m = 0.0;    ///< R_N, of the prime vertical
};
[[nodiscard]] Radii radii(double latitude_rad);
/// R_N by the sine of the latitude.
[[nodiscard]] inline double normal_radius_m(double sine) {
  return kSemiMajorAxis_m / std::sqrt(1.0 - kEccentricitySquared * sine * sine);
}

/// Normal gravity along down, m/s^2: Somigliana on the ellipsoid, second order in altitude.
[[nodiscard]] double gravity(double latitude_rad, double altitude_m);
/// Normal gravity along N, m/s^2. Above the ellipsoid it leans towards the equator by 8.1e-9 h sin 2L: level
/// surfaces at altitude are not parallel to the ellipsoid.
[[nodiscard]] Eigen::Vector3d gravity_N(double latitude_rad, double altitude_m);

/// Rate of the Earth relative to inertial space, in N.
[[nodiscard]] Eigen::Vector3d earth_rate_N(double latitude_rad);

/// Rate of N relative to the Earth when moving at v_N.
[[nodiscard]] Eigen::Vector3d transport_rate_N(const Geodetic& at, const Eigen::Vector3d& v_N_m_s);

/// The ellipsoid at one point, with the sine and cosine of the latitude taken once: what a step of the
/// mechanisation and its error dynamics share. The same figures as the functions above.
struct LocalEarth {
  explicit LocalEarth(const Geodetic& at);

  double sine;
  double cosine;                 ///< kept away from zero: nearer to a pole longitude means nothing
  double meridian_m;             ///< R_M + altitude
  double normal_m;               ///< R_N + altitude
  double gravity_m_s2;           ///< along down
  double gravity_north_m_s2;     ///< along north: as gravity_N()
  Eigen::Vector3d earth_rate_N;  ///< rad/s

  [[nodiscard]] Eigen::Vector3d gravity_N() const { return {gravity_north_m_s2, 0.0, gravity_m_s2}; }
  [[nodiscard]] Eigen::Vector3d transport_rate_N(const Eigen::Vector3d& v_N_m_s) const {
    const double east = v_N_m_s.y() / normal_m;
    return {east, -v_N_m_s.x() / meridian_m, -east * sine / cosine};
  }
};

/// `to` minus `from` in metres north, east, down, with the radii halfway: exact to 1e-6 of the distance
/// within 10 km, and consistent with moved_by().
[[nodiscard]] Eigen::Vector3d difference_N(const Geodetic& from, const Geodetic& to);

/// The point `delta_N_m` away from `from`.
[[nodiscard]] Geodetic moved_by(const Geodetic& from, const Eigen::Vector3d& delta_N_m);

/// The angle as its equal in (-pi, pi].
[[nodiscard]] double wrap_pi(double angle_rad);
/// The angle as its equal in [0, 2 pi).
[[nodiscard]] double wrap_two_pi(double angle_rad);

}  // namespace fathom::geo
