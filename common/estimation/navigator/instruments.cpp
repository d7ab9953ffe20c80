#include "estimation/navigator/instruments.hpp"

#include <cmath>

namespace fathom::estimation {
namespace {

/// Equal, and not all of them unknown.
bool same(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  bool any = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i])) return false;
    if (!std::isnan(a[i]) && a[i] != b[i]) return false;
    any = any || !std::isnan(a[i]);
  }
  return any;
}

/// Of the variance that is expected: what a simulator without noise leaves, that may well repeat itself, is
/// less, and what an instrument leaves whose sigma is said eight times too large is more.
constexpr double kLeastNoise = 0.015;
constexpr double kForgets = 0.05;

}  // namespace

Instruments::Instruments(const Setup& setup)
    : count(std::min<std::size_t>(setup.config.sensors.size(), kMaxSensors)) {
  for (std::size_t i = 0; i < count; ++i) {
    sensors[i].enabled = setup.config.sensors[i].enabled;
    if (setup.water_layer[i] >= 0) ++layer_count;
  }
}

void Instrument::note_innovation(double now) {
  if (!repeats && std::isfinite(now)) normalised_square += kForgets * (now - normalised_square);
}

bool Instrument::is_frozen(const std::array<double, 3>& now, const Eigen::Vector3d& prediction, double limit,
                           const Eigen::Vector3d& travelled_N_m, double way_m) {
  repeats = same(now, reading);
  if (!repeats) {
    reading = now;
    first_prediction = prediction;
    first_travelled_N_m = travelled_N_m;
    return false;
  }
  const bool noisy = normalised_square > kLeastNoise;
  return (prediction - first_prediction).norm() > limit ||
         (noisy && (travelled_N_m - first_travelled_N_m).norm() > way_m);
}

}  // namespace fathom::estimation
