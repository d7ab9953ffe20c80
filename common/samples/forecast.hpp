#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// When the 95 % uncertainty will pass a limit if nothing changes.
struct ForecastLimit {
  Name name;                          ///< e.g. "horizontal_100m"
  double limit = kUnknown;            ///< m, or rad for heading
  double now = kUnknown;              ///< present 95 % value, same unit
  double time_to_limit_s = kUnknown;  ///< +infinity when never
};

struct Forecast {
  static constexpr std::size_t kMaxLimits = 8;
  SampleHeader header;
  double horizontal_95_m = kUnknown;
  double vertical_95_m = kUnknown;
  double heading_95_rad = kUnknown;
  double horizontal_growth_m_s = kUnknown;
  std::uint32_t limit_count = 0;
  std::array<ForecastLimit, kMaxLimits> limits{};
};

}  // namespace fathom
