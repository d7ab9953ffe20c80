#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"
#include "samples/nav_state.hpp"

namespace fathom {

/// One condition that alignment waits for.
struct AlignmentCondition {
  Name name;                ///< e.g. "pitch_rad"
  double value = kUnknown;  ///< now
  double limit = kUnknown;  ///< |value| must stay below it
  double held_s = 0.0;      ///< for how long it has
  double needed_s = 0.0;
  bool met = false;
};

struct AlignmentStatus {
  static constexpr std::size_t kMaxConditions = 12;
  SampleHeader header;
  AlignmentPhase phase = AlignmentPhase::none;
  double in_phase_s = 0.0;
  std::uint32_t condition_count = 0;
  std::array<AlignmentCondition, kMaxConditions> conditions{};
  std::array<double, 3> rpy_sigma_rad{kUnknown, kUnknown, kUnknown};
  double time_to_aligned_s = kUnknown;  ///< predicted; 0 when aligned
  std::array<char, 128> advice{};       ///< the manoeuvre that would help, zero-terminated English
};

}  // namespace fathom
