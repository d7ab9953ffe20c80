#pragma once

#include <cstddef>
#include <vector>

#include "base/unknown.hpp"

namespace fathom::study {

/// What a set of values amounts to, in their unit. All unknown where there is no value.
struct Statistics {
  std::size_t n = 0;
  double mean = kUnknown;
  double std = kUnknown;  ///< of the sample, divided by n - 1; 0 for a single value
  double rms = kUnknown;
  double median = kUnknown;
  double p05 = kUnknown;
  double p95 = kUnknown;
  double max = kUnknown;  ///< largest magnitude: of a signed error, the worst on either side
};

/// Values that are not finite are left out and not counted; the caller says how many there were. Percentiles
/// are interpolated linearly between the ordered values. The result does not depend on the order of the
/// values beyond rounding, and repeats to the last bit for the same order.
[[nodiscard]] Statistics statistics_of(const std::vector<double>& values);

}  // namespace fathom::study
