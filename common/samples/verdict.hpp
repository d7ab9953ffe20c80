#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// What became of one measurement. Exactly one per measurement.
enum class VerdictKind : std::uint8_t {
  used = 0,
  rejected = 1,      ///< by the gate: test ratio above 1
  late = 2,          ///< older than the horizon
  duplicate = 3,     ///< same stamp or sequence as one already seen
  frozen = 4,        ///< value repeats while the vehicle moves
  out_of_range = 5,  ///< not finite, or outside what the instrument can measure
  not_aligned = 6,   ///< the filter has no attitude or position to test it against
  source_disabled = 7,
  unknown_frame = 8,
  from_the_future = 9,  ///< stamped further ahead of the newest inertial sample than clocks can differ
};
inline constexpr std::size_t kVerdictKinds = 10;

/// The word used on the command line and in reports, e.g. "not_aligned".
[[nodiscard]] std::string_view to_string(VerdictKind kind);

enum class SourceKind : std::uint8_t {
  imu = 0,
  gps = 1,
  dvl = 2,
  depth = 3,
  heading = 4,
  usbl = 5,
  airspeed = 6,
  propulsion = 7,
  fins = 8,
};
inline constexpr std::size_t kSourceKinds = 9;
[[nodiscard]] std::string_view to_string(SourceKind source);

/// header: stamp and sequence of the measurement; received_ns: its arrival.
struct Verdict {
  SampleHeader header;
  SourceKind source = SourceKind::imu;
  Name model;   ///< aiding model that judged it, e.g. "dvl_velocity"
  Name writer;  ///< who published it, where known
  VerdictKind kind = VerdictKind::used;
  std::uint32_t dimensions = 0;  ///< of what follows, 0 to 6
  std::array<double, 6> innovation{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  std::array<double, 6> innovation_sigma{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  double test_ratio = kUnknown;  ///< below 1 accepted
  double limit = kUnknown;       ///< chi-square threshold behind the ratio, or the bound that was broken
};

}  // namespace fathom
