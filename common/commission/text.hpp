#pragma once

#include <string>

namespace fathom::commission {

/// A number for people: `digits` after the point.
[[nodiscard]] std::string number(double value, int digits);
/// "0.12 ± 0.03".
[[nodiscard]] std::string with_sigma(double value, double sigma);

}  // namespace fathom::commission
