#pragma once

#include <vector>

#include "commission/fit/series.hpp"

namespace fathom::commission {

struct Span {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// Where the vehicle lies still: the inertial unit is as quiet as in its quietest second, within what noise
/// allows, for at least `least_s`, and GPS and DVL, where they speak, say no speed. Longest first.
[[nodiscard]] std::vector<Span> rest_spans(const Series& series, double least_s = 5.0);

}  // namespace fathom::commission
