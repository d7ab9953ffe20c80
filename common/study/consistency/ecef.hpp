#pragma once

#include <Eigen/Core>

/// The Earth as the truth of the consistency study has it: Cartesian, Earth-fixed axes E (x to Greenwich, z
/// to the north pole). The estimator's Earth (geo/wgs84.hpp) is written in curvature radii and Somigliana's
/// formula; nothing here uses it, so that a formula that is wrong there shows as an error.
namespace fathom::study::ecef {

/// Of the Earth, along E.
inline constexpr double kTurnRate_rad_s = 7.292115e-5;

struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;  ///< above the WGS-84 ellipsoid
};

[[nodiscard]] Eigen::Vector3d to_cartesian(const Geodetic& place);
/// By iteration to rounding; not for places within kilometres of the centre.
[[nodiscard]] Geodetic to_geodetic(const Eigen::Vector3d& r_E_m);
/// Columns: north, east, down of the ellipsoid's normal, along E.
[[nodiscard]] Eigen::Matrix3d axes_EN(const Geodetic& place);
/// Gradient of the gravitational potential of the level ellipsoid: its even zonal harmonics to degree ten
/// (Heiskanen and Moritz, Physical Geodesy, 2-92). Without the centrifugal part.
[[nodiscard]] Eigen::Vector3d gravitation_E_m_s2(const Eigen::Vector3d& r_E_m);
/// Where a displacement along N leads.
[[nodiscard]] Geodetic moved(const Geodetic& from, const Eigen::Vector3d& step_N_m);
/// From `origin` to `place`, along N of `origin`.
[[nodiscard]] Eigen::Vector3d offset_N_m(const Geodetic& origin, const Geodetic& place);

}  // namespace fathom::study::ecef
