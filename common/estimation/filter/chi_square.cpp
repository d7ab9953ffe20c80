#include "estimation/filter/chi_square.hpp"

#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>

namespace fathom::estimation {

double chi_square_quantile(double probability, int degrees) {
  const double exact = boost::math::quantile(boost::math::chi_squared(degrees), probability);
  constexpr double kDigits = 1e9;
  return std::round(exact * kDigits) / kDigits;
}

}  // namespace fathom::estimation
