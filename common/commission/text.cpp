#include "commission/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace fathom::commission {

std::string number(double value, int digits) {
  std::array<char, 64> out{};
  std::snprintf(out.data(), out.size(), "%.*f", digits, value);
  return out.data();
}

std::string with_sigma(double value, double sigma) {
  // Two digits of the sigma.
  const int digits = sigma > 0.0 && std::isfinite(sigma)
                         ? std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 8)
                         : 3;
  return number(value, digits) + " ± " + number(sigma, digits);
}

}  // namespace fathom::commission
