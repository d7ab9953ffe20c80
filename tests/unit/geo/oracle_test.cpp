// The ellipsoid held against GeographicLib, which shares no formula with it.
#include <cmath>

#include <GeographicLib/Ellipsoid.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "geo/wgs84.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::geo {
namespace {

using Eigen::Vector3d;

Geodetic place(test::Normal& draw, double most_latitude_deg) {
  const double latitude = draw.uniform(-most_latitude_deg, most_latitude_deg) * kRadPerDeg;
  const double longitude = draw.uniform(-180.0, 180.0) * kRadPerDeg;
  return {latitude, longitude, draw.uniform(-6000.0, 12000.0)};
}

Vector3d geocentric(const Geodetic& at) {
  Vector3d out;
  GeographicLib::Geocentric::WGS84().Forward(at.latitude_rad / kRadPerDeg, at.longitude_rad / kRadPerDeg,
                                             at.altitude_m, out.x(), out.y(), out.z());
  return out;
}

TEST(Oracle, RadiiOfCurvature) {
  const GeographicLib::Ellipsoid& earth = GeographicLib::Ellipsoid::WGS84();
  for (double degrees = -90.0; degrees <= 90.0; degrees += 0.5) {
    const Radii own = radii(degrees * kRadPerDeg);
    EXPECT_NEAR(own.meridian_m, earth.MeridionalCurvatureRadius(degrees), 1e-6) << degrees;
    EXPECT_NEAR(own.normal_m, earth.TransverseCurvatureRadius(degrees), 1e-6) << degrees;
  }
}

TEST(Oracle, NormalGravity) {
  const GeographicLib::NormalGravity& gravity = GeographicLib::NormalGravity::WGS84();
  test::Normal draw(11);
  for (int i = 0; i < 2000; ++i) {
    const Geodetic at = place(draw, 89.0);
    double north = 0.0;
    double up = 0.0;
    gravity.Gravity(at.latitude_rad / kRadPerDeg, at.altitude_m, north, up);
    const Vector3d own = gravity_N(at.latitude_rad, at.altitude_m);
    // The third order of altitude is left out, and under water the lean, which is below 5e-5 m/s^2 there.
    EXPECT_NEAR(own.z(), -up, 3e-6) << at.latitude_rad << " " << at.altitude_m;
    const double lean = at.altitude_m < 0.0 ? 5e-5 : 0.02 * std::abs(north) + 2e-8;
    EXPECT_NEAR(own.x(), north, lean) << at.latitude_rad << " " << at.altitude_m;
  }
}

TEST(Oracle, WaysOverTheGroundAreGeodesics) {
  const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
  test::Normal draw(11);
  for (int i = 0; i < 2000; ++i) {
    Geodetic from = place(draw, 80.0);
    from.altitude_m = 0.0;
    const double length = std::exp(draw.uniform(std::log(1.0), std::log(5000.0)));
    const double way = draw.uniform(-180.0, 180.0) * kRadPerDeg;
    const Vector3d delta(length * std::cos(way), length * std::sin(way), 0.0);
    const Geodetic to = moved_by(from, delta);
    double distance = 0.0;
    earth.Inverse(from.latitude_rad / kRadPerDeg, from.longitude_rad / kRadPerDeg,
                  to.latitude_rad / kRadPerDeg, to.longitude_rad / kRadPerDeg, distance);
    EXPECT_NEAR(distance, length, 1e-6 * length + 1e-7) << from.latitude_rad << " " << way;
    EXPECT_NEAR(difference_N(from, to).norm(), distance, 1e-6 * length + 1e-7);
  }
}

TEST(Oracle, StepsOfAVehicleAreChordsInSpace) {
  test::Normal draw(11);
  for (int i = 0; i < 2000; ++i) {
    const Geodetic from = place(draw, 80.0);
    const Vector3d delta(draw.uniform(-20.0, 20.0), draw.uniform(-20.0, 20.0), draw.uniform(-5.0, 5.0));
    const Geodetic to = moved_by(from, delta);
    EXPECT_NEAR((geocentric(to) - geocentric(from)).norm(), delta.norm(), 2e-5);
  }
}

}  // namespace
}  // namespace fathom::geo
