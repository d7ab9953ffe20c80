#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "codec/satellite/fix_epochs.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::codec::novatel {

enum Log : std::uint16_t {
  best_position = 42,
  best_velocity = 99,
  time_of_receiver = 101,
  heading2 = 1335,
  dual_antenna_heading = 2042,
};

/// Of the byte after a message's number.
inline constexpr std::uint8_t kSourceMask = 0x1F;
inline constexpr std::uint8_t kSecondaryAntenna = 1;
inline constexpr std::uint8_t kFormatMask = 0x60;  ///< 0 is binary
inline constexpr std::uint8_t kResponse = 0x80;    ///< an answer to a command

/// How well a receiver knows the time. They are listed from worst to best, but for the last three.
enum class TimeStatus : std::uint8_t {
  unknown = 20,
  approximate = 60,
  coarse_adjusting = 80,
  coarse = 100,  ///< to 10 ms
  coarse_steering = 120,
  freewheeling = 130,
  fine_adjusting = 140,
  fine = 160,  ///< to a microsecond
  fine_backup_steering = 170,
  fine_steering = 180,
  of_satellite = 200,  ///< of what a satellite has sent, as an almanac
  external = 220,
  exact = 240,
};
[[nodiscard]] bool is_known(TimeStatus status);

/// Of a solution.
inline constexpr std::uint32_t kSolutionComputed = 0;
inline constexpr std::uint32_t kInsufficientObservations = 1;
inline constexpr std::uint32_t kDatumWgs84 = 61;

/// Position or velocity type: those that the simulator's encoder sends, of many.
enum class SolutionType : std::uint32_t {
  none = 0,
  fixed_height = 2,
  doppler_velocity = 8,
  single = 16,
  differential = 17,
  propagated = 19,
  narrow_float = 34,
  narrow_integer = 50,
};
/// What a position of this type is worth; nothing where it is no type of a position.
[[nodiscard]] std::optional<GpsFix> fix_of_solution(std::uint32_t type);

/// The header's fields that matter.
struct Header {
  std::uint16_t message = 0;
  std::uint8_t message_type = 0;
  TimeStatus time_status = TimeStatus::unknown;
  std::uint16_t week = 0;
  std::uint32_t time_of_week_ms = 0;

  /// A log that the receiver made of its primary antenna.
  [[nodiscard]] bool is_log_of_primary() const;
};
/// Precondition: kHeader bytes.
[[nodiscard]] Header read_header(Bytes frame);

// Why a log is refused; nothing when it is good. Without a solution the fix is none, and velocity or heading
// are unknown.
[[nodiscard]] std::optional<RejectReason> read_position(Bytes message, GpsSample& into);
/// All but the time of the week, which the header has.
[[nodiscard]] std::optional<RejectReason> read_velocity(Bytes message, EpochVelocity& into);

struct Heading {
  HeadingSample sample;
  bool to_another_vehicle = false;
};
/// Both logs of a heading have it in the same places.
[[nodiscard]] std::optional<RejectReason> read_heading(Bytes message, Heading& into);

/// How far GPS time is ahead of UTC; left as it is where the receiver does not vouch for it.
[[nodiscard]] std::optional<RejectReason> read_time(Bytes message, DurationNs& ahead_of_utc_ns);

}  // namespace fathom::codec::novatel
