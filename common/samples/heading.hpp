#pragma once

#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

enum class North : std::uint8_t { true_north = 0, magnetic = 1 };

struct HeadingSample {
  SampleHeader header;
  North north = North::true_north;
  double heading_rad = kUnknown;  ///< [0, 2 pi)
  double sigma_rad = kUnknown;
  double variation_rad = kUnknown;  ///< magnetic variation the instrument reported, east positive
  double deviation_rad = kUnknown;  ///< compass deviation the instrument reported, east positive
};

}  // namespace fathom
