#include "archive/covariance.hpp"

#include <vector>

namespace fathom::archive {
namespace {

constexpr double kRounding = 1e-6;

}  // namespace

bool is_covariance(const double* p, std::size_t n, std::size_t stride) {
  std::vector<double> sigma(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double variance = p[i * stride + i];
    if (!(variance >= 0.0) || !std::isfinite(variance)) return false;
    sigma[i] = std::sqrt(variance);
  }
  std::vector<double> lower(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double here = p[i * stride + j];
      const double there = p[j * stride + i];
      const double scale = sigma[i] * sigma[j];
      if (!(std::abs(here - there) <= kRounding * scale)) return false;
      if (scale == 0.0 && here != 0.0) return false;
      double value = scale == 0.0 ? 0.0 : here / scale;
      if (i == j) value = 1.0 + kRounding;
      for (std::size_t k = 0; k < j; ++k) value -= lower[i * n + k] * lower[j * n + k];
      if (i == j) {
        if (!(value > 0.0)) return false;
        lower[i * n + i] = std::sqrt(value);
      } else {
        lower[i * n + j] = value / lower[j * n + j];
      }
    }
  }
  return true;
}

}  // namespace fathom::archive
