#pragma once

#include <vector>

#include "base/unknown.hpp"

namespace fathom::commission {

/// One point of an Allan deviation.
struct AllanPoint {
  double tau_s = 0.0;
  double deviation = 0.0;  ///< in the unit of the samples
  double sigma = 0.0;      ///< one standard deviation of it
};

/// Overlapping Allan deviation of evenly spaced samples, at clusters that grow by a half octave up to a fifth
/// of the record.
[[nodiscard]] std::vector<AllanPoint> allan_deviation(const std::vector<double>& samples, double dt_s);

/// What an Allan deviation tells: variance = N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3, none of the three
/// negative.
struct NoiseFigures {
  double density = kUnknown;  ///< N, unit * sqrt(s)
  double density_sigma = kUnknown;
  double instability = kUnknown;  ///< B, unit; unknown where the record ends before the curve is flat
  double instability_sigma = kUnknown;
};
[[nodiscard]] NoiseFigures noise_figures(const std::vector<AllanPoint>& curve);

}  // namespace fathom::commission
