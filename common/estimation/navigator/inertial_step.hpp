#pragma once

#include <cstdint>

#include "estimation/engine_config.hpp"
#include "estimation/filter/strapdown.hpp"

namespace fathom::estimation {

/// What was wrong with inertial samples that were refused since the one before. They move nothing, but what
/// averages must not trust an interval in which the instrument was not well.
enum class ImuFault : std::uint8_t { none = 0, not_finite = 1, stale = 2 };

/// One inertial interval as the mechanisation takes it. Increments are along B, not yet corrected for bias.
struct ImuStep {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
  Increments increments;
  double gap_s = 0.0;  ///< part of the interval during which nothing was measured
  ImuFault fault = ImuFault::none;

  /// A tick of the grid of this period lies within it.
  [[nodiscard]] bool passes_tick(DurationNs period_ns) const {
    return to_ns / period_ns != from_ns / period_ns;
  }
};

/// What may have happened while nothing was measured: standard deviations along each axis.
struct GapSigma {
  GapSigma(const ImuConfig& imu, double gap_s)
      : position_m(0.5 * imu.gap_acceleration_sigma_m_s2 * gap_s * gap_s),
        velocity_m_s(imu.gap_acceleration_sigma_m_s2 * gap_s),
        angle_rad(imu.gap_rate_sigma_rad_s * gap_s) {}
  double position_m;
  double velocity_m_s;
  double angle_rad;
};

}  // namespace fathom::estimation
