#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// KVH 1725, 1750 and 1775: messages of the normal mode in the formats A, B and C (1775 IMU interface
/// control document 56-0298, tables 5-1 to 5-9). Results of built-in tests (5.3) are ignored. Formats may
/// change in the middle of a stream.
///
/// How the unit was set does not stand in a message: whether it gives delta angles or rates (=ROTFMT), in
/// radians or degrees (=ROTUNITS), and the unit of its temperature (=TEMPUNITS) are in KvhOptions.
/// Accelerations are in g. A delta angle becomes the mean rate over its interval: beside it there is no
/// velocity increment, so the sample has rates only.
///
/// Axes: the unit's own x, y, z as they are marked, right-handed. An accelerometer whose axis points up
/// reads +1 g, so forces are specific forces. Lying on its base the unit has z up: where x is forward, its
/// axes are forward, left, up, and its bridge or vehicle turns them.
///
/// Status: axes that the unit does not call valid are unknown, as its gyros are when it was just switched on.
///
/// Temperature: format C has it in every fourth message, the magnetic field in the others, which is ignored.
///
/// Time: format B has a counter of microseconds, carried on across its 32 bits; the others have none. The
/// sequence number says what was lost, which nobody asks: a gap shows in the stamps.
[[nodiscard]] std::unique_ptr<Codec> make_kvh(const CodecOptions& options);

namespace kvh {

/// The last byte of the header, which says the format.
enum class Format : std::uint8_t {
  a = 0x55,  ///< temperature; what the unit sends unless it is told otherwise
  b = 0x56,  ///< time and temperature
  c = 0x57,  ///< temperature and magnetic field in turn
};

// The header; behind it a byte for the kind of message and one for the format.
inline constexpr std::uint8_t kFirst = 0xFE;
inline constexpr std::uint8_t kSecond = 0x81;
inline constexpr std::uint8_t kData = 0xFF;
inline constexpr std::uint8_t kTest = 0x00;
inline constexpr std::uint8_t kShortTest = 0xAA;
inline constexpr std::uint8_t kLongTest = 0xAB;

// Three numbers each; what follows them depends on the format.
inline constexpr std::size_t kRotation = 4;
inline constexpr std::size_t kAcceleration = 16;
inline constexpr std::size_t kRest = 28;

// A bit of the status for each valid axis: gyros from bit 0, accelerometers from this one on.
inline constexpr unsigned kFirstAccelerometer = 4;
inline constexpr std::uint8_t kSequences = 128;

/// Whether a message has the temperature: in format C one of four has it.
[[nodiscard]] constexpr bool has_temperature(Format format, std::uint8_t sequence) {
  return format != Format::c || sequence % 4 == 0;
}

/// What 1 in a message means, rad/s.
[[nodiscard]] double rotation_unit_rad_s(const KvhOptions& options);

/// The reading of the temperature in °C, and back.
[[nodiscard]] double to_degC(double reading, KvhTemperature unit);
[[nodiscard]] double from_degC(double temperature_degC, KvhTemperature unit);

}  // namespace kvh
}  // namespace fathom::codec
