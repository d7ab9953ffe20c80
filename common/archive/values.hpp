#pragma once

#include <cmath>
#include <numbers>

#include "archive/visitor.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

/// Fields of the geodetic values.
namespace fathom::geo {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Quaternion>
void fields(Archive& archive, Self& self) {
  constexpr double kUnit = 1.0 + 1e-9;
  archive("w", self.w, fathom::archive::within(-kUnit, kUnit));
  archive("x", self.x, fathom::archive::within(-kUnit, kUnit));
  archive("y", self.y, fathom::archive::within(-kUnit, kUnit));
  archive("z", self.z, fathom::archive::within(-kUnit, kUnit));
  if constexpr (Archive::kReads) {
    const double square = self.w * self.w + self.x * self.x + self.y * self.y + self.z * self.z;
    archive.expect(std::abs(square - 1.0) < 1e-9, "", "a quaternion of unit length");
  }
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Geodetic>
void fields(Archive& archive, Self& self) {
  constexpr double kRightAngle_rad = 0.5 * std::numbers::pi;
  archive("latitude_rad", self.latitude_rad, fathom::archive::within(-kRightAngle_rad, kRightAngle_rad));
  archive("longitude_rad", self.longitude_rad,
          fathom::archive::within(-4.0 * kRightAngle_rad, 4.0 * kRightAngle_rad));
  // From the middle of the Earth to well above where anything flies by wings.
  archive("altitude_m", self.altitude_m, fathom::archive::within(-6e6, 1e8));
}

}  // namespace fathom::geo
