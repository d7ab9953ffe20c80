#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/unknown.hpp"
#include "codec/satellite/epochs.hpp"
#include "samples/gps.hpp"

namespace fathom::codec {

/// What a receiver says of velocity in a frame of its own; unknown where there is no solution.
struct EpochVelocity {
  std::uint32_t time_of_week_ms = 0;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> sigma_N_m_s{kUnknown, kUnknown, kUnknown};
  double course_rad = kUnknown;
};

/// A position and its velocity, which come in two frames of the same time of the week.
struct FixWithVelocity {
  using Instant = std::optional<std::uint32_t>;  ///< time of the week, ms
  using Sample = GpsSample;
  using Part = EpochVelocity;
  static constexpr std::size_t kParts = 1;
  static constexpr std::size_t kVelocity = 0;
  static constexpr int kWaitsInVain = 2;
  static void join(GpsSample& sample, std::size_t /*which*/, const EpochVelocity& velocity) {
    if (sample.fix == GpsFix::none) return;
    sample.velocity_N_m_s = velocity.velocity_N_m_s;
    sample.velocity_sigma_N_m_s = velocity.sigma_N_m_s;
    sample.course_rad = velocity.course_rad;
  }
};
using FixEpochs = Epochs<FixWithVelocity>;

}  // namespace fathom::codec
