#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "base/unknown.hpp"
#include "bridge/sanity.hpp"

namespace fathom::bridge {

/// Why a sample is not published; nothing: it is.
using Judgement = std::optional<Refusal>;
using Limits = config::SampleLimits;

inline bool any_infinite(std::span<const double> values) {
  for (const double value : values) {
    if (std::isinf(value)) return true;
  }
  return false;
}

inline bool all_finite(std::span<const double> values) {
  for (const double value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

// True for a known value beyond the limit; an unknown one breaks none.
inline bool beyond(double value, double limit) {
  return std::abs(value) > limit;
}

inline bool any_beyond(std::span<const double> values, double limit) {
  for (const double value : values) {
    if (beyond(value, limit)) return true;
  }
  return false;
}

inline Judgement position(double latitude_rad, double longitude_rad) {
  if (any_infinite(std::array{latitude_rad, longitude_rad})) return Refusal::not_finite;
  if (beyond(latitude_rad, std::numbers::pi / 2) || beyond(longitude_rad, std::numbers::pi)) {
    return Refusal::impossible;
  }
  return std::nullopt;
}

/// Of each kind in a file of its own.
template <class Sample>
[[nodiscard]] Judgement judge(const Sample& sample, const Limits& limits);

}  // namespace fathom::bridge
