#pragma once

#include <numbers>

#include "bridge/sanity/judge.hpp"

namespace fathom::bridge {

/// On Earth, or unknown.
inline Judge& place(Judge& judge, std::string_view latitude, double latitude_rad, std::string_view longitude,
                    double longitude_rad) {
  return judge.finite(latitude, latitude_rad)
      .finite(longitude, longitude_rad)
      .at_most(latitude, latitude_rad, 0.5 * std::numbers::pi)
      .at_most(longitude, longitude_rad, std::numbers::pi);
}

}  // namespace fathom::bridge
