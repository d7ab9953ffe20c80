#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "codec/framer.hpp"

namespace fathom::codec::pd6 {

/// Longest line looked at; the longest of the manual has 64 characters.
inline constexpr std::size_t kMaxLine = 128;

/// The lines that are read, in the order in which the manual has them. Of a velocity, the three frames follow
/// each other: instrument, ship, earth.
enum class LineKind : std::uint8_t { sa, ts, wi, ws, we, wd, bi, bs, be, bd };
inline constexpr std::size_t kLineKinds = 10;

/// What one line says; what its kind does not say, or marks as bad, is unknown.
struct Line {
  LineKind kind = LineKind::sa;
  /// Of the vessel along the three axes of the line's frame, and the error velocity.
  std::array<double, 4> velocity_m_s{kUnknown, kUnknown, kUnknown, kUnknown};
  bool bad_zeros = false;  ///< the velocity is marked bad, with zeros in its place
  double pitch_rad = kUnknown;
  double roll_rad = kUnknown;
  double heading_rad = kUnknown;
  double sound_speed_m_s = kUnknown;
  std::optional<TimeNs> clock_ns;
  double range_m = kUnknown;  ///< to the bottom
};

/// Finds the line at the front: `:`, two capital letters, a comma, printable characters up to the line end or
/// the next `:`, neither of which belongs to it.
[[nodiscard]] Probe probe_line(Bytes front);

/// What a line that probe_line has accepted is; nothing for those that are not read.
[[nodiscard]] std::optional<LineKind> kind_of(std::string_view line);

/// Reads such a line into `out`, or says what is wrong with it.
[[nodiscard]] std::optional<RejectReason> read_line(LineKind kind, std::string_view line, Line& out);

}  // namespace fathom::codec::pd6
