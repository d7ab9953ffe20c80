#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Safran Sensonor STIM300: datagrams of the normal mode with rates and accelerations, with or without
/// inclinometers, temperatures, and AUX or PPS (data sheet TS1524, revision 31: layout 5.5.6 and tables 5-20
/// to 5-22, status table 5-23, numbers 7.5.2.2). Datagrams without accelerometers are ignored, and so are
/// those of the initialisation mode, but for the configuration.
///
/// Units and range do not stand in a datagram of the normal mode. They are those of Stim300Options until a
/// configuration datagram (5.5.3, table 5-16) says them, which the unit sends when it is switched on and
/// when it is asked. Rates and accelerations may be sampled or averaged. Incremental angles and velocities
/// are those over one sample interval; where both come, the sample has them beside their means. Integrated
/// angles and velocities, and increments at an external trigger, whose interval nobody knows, are ignored.
///
/// Axes: the unit's own x, y, z as they are marked, right-handed. An accelerometer whose axis points up
/// reads +1 g, so forces are specific forces. Lying on its base the unit has z up: where x is forward, its
/// axes are forward, left, up, and its bridge or vehicle turns them.
///
/// Status: what was sampled during start-up, or while the unit's own tests fail (system integrity), is
/// unknown on all axes; after an overload or an error of a channel those axes are that it marks, all where
/// it marks none. Outside of the operating conditions the values stay: they are less accurate, not wrong.
///
/// Temperature: mean of the gyros.
///
/// Time: no clock. Latency is how long before its transmission the sample was taken, and becomes the age.
/// The time on the line and the delay of the unit's low-pass filter come on top of it (`latency_s` of the
/// bridge). The counter has 8 bits and says how many of the unit's own samples were left out, which nobody
/// asks: a gap shows in the stamps.
[[nodiscard]] std::unique_ptr<Codec> make_stim300(const CodecOptions& options);

namespace stim300 {

/// What a datagram of the normal mode holds behind its identifier. Gyros always come first.
struct Triads {
  bool accelerometers = false;
  bool inclinometers = false;
  bool auxiliary = false;        ///< AUX, or PPS
  std::size_t temperatures = 0;  ///< triads of temperatures, that of the gyros first

  [[nodiscard]] std::size_t temperature_at() const;
  [[nodiscard]] std::size_t counter_at() const;
  [[nodiscard]] std::size_t latency_at() const { return counter_at() + 1; }
  [[nodiscard]] std::size_t length() const { return latency_at() + 6; }  ///< with CRC, without CR and LF
};

/// Nothing for identifiers of other datagrams.
[[nodiscard]] std::optional<Triads> triads_of(std::uint8_t identifier);

// Where the triads begin; each is three big-endian numbers and a status.
inline constexpr std::size_t kGyros = 1;
inline constexpr std::size_t kAccelerometers = 11;

/// Of the status behind each triad; below it x, y, z from bit 0.
enum Status : std::uint8_t {
  channel_error = 1U << 3U,
  overload = 1U << 4U,
  outside_conditions = 1U << 5U,
  start_up = 1U << 6U,
  integrity_error = 1U << 7U,
};

// The configuration: without and with CR and LF.
inline constexpr std::uint8_t kConfiguration = 0xBC;
inline constexpr std::uint8_t kConfigurationLine = 0xBD;
inline constexpr std::size_t kConfigurationLength = 26;

/// Of one count.
[[nodiscard]] double rate_unit_rad_s();
[[nodiscard]] double angle_unit_rad();
[[nodiscard]] double force_unit_m_s2(double range_g);
[[nodiscard]] double velocity_unit_m_s(double range_g);
inline constexpr double kTemperatureUnit_degC = 1.0 / 256.0;

/// The last four bytes: crc32_mpeg2 of the bytes before them and of as many zeros, which are not sent, as
/// fill up the last four.
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes);

}  // namespace stim300
}  // namespace fathom::codec
