#pragma once

#include <array>
#include <string>

namespace fathom::commission {

inline constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

/// In which figures may have been recorded.
struct Unit {
  double factor;  ///< of SI
  const char* name;
};

/// A number for people: `digits` after the point.
[[nodiscard]] std::string number(double value, int digits);
/// "0.12 ± 0.03".
[[nodiscard]] std::string with_sigma(double value, double sigma);

}  // namespace fathom::commission
