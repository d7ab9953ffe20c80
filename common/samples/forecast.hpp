#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// When the uncertainty will pass a limit without position fixes, if the vehicle goes on as it did.
struct ForecastLimit {
  Name name;                          ///< e.g. "horizontal_100m"
  double limit = kUnknown;            ///< m, or rad for heading
  double now = kUnknown;              ///< present 95 % value, same unit
  double time_to_limit_s = kUnknown;  ///< of the 95 % value; +infinity when never
  Name without{};                     ///< an aiding sensor that is lost, too; "all": every one; else empty
  double time_expected_s = kUnknown;  ///< of the median: half of such vehicles have passed it by then
};

struct Forecast {
  /// Each configured limit as it is, then without any aiding, then without each aiding sensor.
  static constexpr std::size_t kMaxLimits = 64;
  SampleHeader header;
  double horizontal_95_m = kUnknown;
  double vertical_95_m = kUnknown;
  double heading_95_rad = kUnknown;
  double horizontal_growth_m_s = kUnknown;
  std::uint32_t limit_count = 0;
  std::array<ForecastLimit, kMaxLimits> limits{};
};

}  // namespace fathom
