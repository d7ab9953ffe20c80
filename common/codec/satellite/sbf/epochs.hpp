#pragma once

#include <cstddef>

#include "codec/satellite/epochs.hpp"
#include "codec/satellite/sbf/blocks.hpp"

// What belongs to one epoch of a Septentrio receiver.

namespace fathom::codec::sbf {

/// A fix, whose sigmas come apart.
struct FixWithSigmas {
  using Instant = GpsInstant;
  using Sample = GpsSample;
  using Part = Sigmas;
  static constexpr std::size_t kParts = 2;
  static constexpr int kWaitsInVain = 1;
  static constexpr std::size_t kPosition = 0;
  static constexpr std::size_t kVelocity = 1;
  static void join(GpsSample& sample, std::size_t which, const Sigmas& sigmas) {
    if (sample.fix == GpsFix::none) return;
    auto& into = which == kPosition ? sample.position_sigma_N_m : sample.velocity_sigma_N_m_s;
    for (std::size_t i = 0; i < 3; ++i) {
      if (known(sigmas[i])) into[i] = sigmas[i];
    }
  }
};

/// A heading and its sigma.
struct HeadingWithSigma {
  using Instant = GpsInstant;
  using Sample = HeadingSample;
  using Part = double;
  static constexpr std::size_t kParts = 1;
  static constexpr int kWaitsInVain = 1;
  static constexpr std::size_t kSigma = 0;
  static void join(HeadingSample& sample, std::size_t /*which*/, double sigma_rad) {
    if (known(sample.heading_rad)) sample.sigma_rad = sigma_rad;
  }
};

}  // namespace fathom::codec::sbf
