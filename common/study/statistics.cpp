#include "study/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::study {
namespace {

double percentile(const std::vector<double>& ordered, double share) {
  const double at = share * static_cast<double>(ordered.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, ordered.size() - 1);
  return ordered[below] + (at - static_cast<double>(below)) * (ordered[above] - ordered[below]);
}

}  // namespace

Statistics statistics_of(const std::vector<double>& values) {
  std::vector<double> ordered;
  ordered.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(ordered),
               [](double value) { return std::isfinite(value); });
  Statistics out;
  out.n = ordered.size();
  if (ordered.empty()) return out;
  std::sort(ordered.begin(), ordered.end());
  const auto n = static_cast<double>(ordered.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : ordered) {
    sum += value;
    squares += value * value;
  }
  out.mean = sum / n;
  out.rms = std::sqrt(squares / n);
  double spread = 0.0;
  for (const double value : ordered) spread += (value - out.mean) * (value - out.mean);
  out.std = ordered.size() > 1 ? std::sqrt(spread / (n - 1.0)) : 0.0;
  out.median = percentile(ordered, 0.5);
  out.p05 = percentile(ordered, 0.05);
  out.p95 = percentile(ordered, 0.95);
  out.max = std::max(std::abs(ordered.front()), std::abs(ordered.back()));
  return out;
}

}  // namespace fathom::study
