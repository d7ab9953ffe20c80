#pragma once

#include <array>
#include <optional>

#include "commission/fit/series.hpp"

namespace fathom::commission {

/// A figure and its standard deviation.
struct Figure {
  double value = 0.0;
  double sigma = 1e9;
};

/// A compass against the attitude of the vehicle:
/// heading(t + latency) = yaw(t) + A + B sin yaw + C cos yaw + D sin 2 yaw + E cos 2 yaw.
struct CompassFit {
  std::array<Figure, 5> deviation_rad;  ///< A to E; those of what was not steered have a large sigma
  Figure latency_s;
};
/// `rpy_rad`: roll, pitch, unwrapped yaw. Nothing where they hardly meet. From a first guess of the latency.
[[nodiscard]] std::optional<CompassFit> fit_compass(const ScalarSeries& heading, const VectorSeries& rpy_rad,
                                                    double latency_s);

/// A depth against the way down: depth(t + latency) = scale * sunk(t) + offset, an offset for each half
/// minute.
struct DepthFit {
  Figure scale;
  Figure latency_s;
};
/// From a first guess of both.
[[nodiscard]] std::optional<DepthFit> fit_depth(const ScalarSeries& depth, const ScalarSeries& sunk_m,
                                                double scale, double latency_s);

}  // namespace fathom::commission
