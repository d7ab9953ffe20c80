#include "commission/fit/allan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace fathom::commission {

std::vector<AllanPoint> allan_deviation(const std::vector<double>& samples, double dt_s) {
  std::vector<double> sum(samples.size() + 1, 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) sum[i + 1] = sum[i] + samples[i] * dt_s;
  std::vector<AllanPoint> curve;
  std::size_t last = 0;
  for (double size = 1.0; size <= static_cast<double>(samples.size()) / 5.0; size *= std::numbers::sqrt2) {
    const auto m = static_cast<std::size_t>(std::lround(size));
    if (m == last) continue;
    last = m;
    const double tau = static_cast<double>(m) * dt_s;
    double squares = 0.0;
    const std::size_t count = sum.size() - 2 * m;
    for (std::size_t i = 0; i < count; ++i) {
      const double second = sum[i + 2 * m] - 2.0 * sum[i + m] + sum[i];
      squares += second * second;
    }
    const double deviation = std::sqrt(squares / (2.0 * static_cast<double>(count) * tau * tau));
    // Equivalent degrees of freedom of white noise (NIST SP 1065, equation 34).
    const auto n = static_cast<double>(samples.size());
    const auto k = static_cast<double>(m);
    const double freedom = std::max(
        1.0, (3.0 * (n - 1.0) / (2.0 * k) - 2.0 * (n - 2.0) / n) * 4.0 * k * k / (4.0 * k * k + 5.0));
    curve.push_back({tau, deviation, deviation / std::sqrt(2.0 * freedom)});
  }
  return curve;
}

NoiseFigures noise_figures(const std::vector<AllanPoint>& curve) {
  NoiseFigures out;
  if (curve.size() < 4) return out;
  // White noise: the first point, and every one behind it as long as the line of slope -1/2 explains them.
  double weight = 0.0;
  double density = 0.0;
  for (const AllanPoint& point : curve) {
    const double here = point.deviation * std::sqrt(point.tau_s);
    const double sigma = point.sigma * std::sqrt(point.tau_s);
    if (!(sigma > 0.0)) continue;
    if (weight > 0.0) {
      const double apart = std::abs(here - density / weight);
      if (apart > 3.0 * std::hypot(sigma, 1.0 / std::sqrt(weight)) && apart > 0.02 * density / weight) break;
    }
    density += here / (sigma * sigma);
    weight += 1.0 / (sigma * sigma);
  }
  if (weight <= 0.0) return out;
  out.density = density / weight;
  // The points overlap, so that they tell little more together than the best of them alone.
  out.density_sigma = std::sqrt(2.0 / weight);
  // The curve is flat where it has a lowest point with a rise behind it that is more than chance.
  const auto lowest =
      std::min_element(curve.begin(), curve.end(),
                       [](const AllanPoint& a, const AllanPoint& b) { return a.deviation < b.deviation; });
  const double white = out.density / std::sqrt(lowest->tau_s);
  const auto rise = std::find_if(lowest, curve.end(), [&](const AllanPoint& point) {
    return point.deviation - lowest->deviation > 2.0 * std::hypot(point.sigma, lowest->sigma);
  });
  const double flat2 = lowest->deviation * lowest->deviation - white * white;
  if (rise != curve.end() && lowest != curve.begin() && flat2 > 0.0) {
    const double per_B = std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);
    out.instability = std::sqrt(flat2) / per_B;
    out.instability_sigma = lowest->sigma * lowest->deviation / std::sqrt(flat2) / per_B;
  }
  return out;
}

}  // namespace fathom::commission
