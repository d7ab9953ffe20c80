#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/unknown.hpp"

namespace fathom {

/// The middle one, of an even number the upper. Unknown values do not count; unknown of nothing.
[[nodiscard]] inline double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !known(value); });
  if (values.empty()) return kUnknown;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace fathom
