#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The self-description of a DataFlash log: FMT says how a message is laid out, FMTU which unit and which
/// multiplier each of its fields has, UNIT and MULT what these letters mean.
namespace fathom::logs::dataflash {

inline constexpr std::uint8_t kHead1 = 0xA3;
inline constexpr std::uint8_t kHead2 = 0x95;
inline constexpr std::size_t kHeaderSize = 3;
inline constexpr std::uint8_t kFormatType = 128;
inline constexpr std::size_t kFormatLength = 89;

struct Definition {
  std::string name;
  std::string letters;  ///< one a field: its type
  std::vector<std::string> labels;
  std::vector<std::size_t> offsets;  ///< of the fields behind the header
  std::size_t length = 0;            ///< with the header
  std::string fault;                 ///< why its fields cannot be read; the length holds nevertheless
  std::string units;                 ///< FMTU: a letter a field, or nothing
  std::string multipliers;

  [[nodiscard]] std::optional<std::size_t> find(std::string_view label) const;
};

/// What the letters of FMTU mean. Begins with those of ArduPilot, which a log repeats or changes.
struct Letters {
  Letters();
  std::map<char, double> multiplier;
  std::map<char, std::string> unit;
};

/// Bytes of a field; 0 for a letter that is none.
[[nodiscard]] std::size_t size_of(char letter);
[[nodiscard]] bool is_text(char letter);

/// The payload of an FMT message. Nothing where it defines none (a type or a length that cannot be).
struct Defined {
  std::uint8_t type = 0;
  Definition definition;
};
[[nodiscard]] std::optional<Defined> parse_format(std::span<const std::uint8_t> payload);

/// As stored. Precondition: the field is no text and within the payload.
[[nodiscard]] double raw_number(char letter, std::span<const std::uint8_t> payload, std::size_t offset);
/// What a stored number is multiplied by: the field's multiplier where FMTU gives one, else what its letter
/// implies (hundredths of c C e E, 1e-7 degrees of L).
[[nodiscard]] double scale_of(const Definition& definition, std::size_t field, const Letters& letters);
[[nodiscard]] std::string text_at(char letter, std::span<const std::uint8_t> payload, std::size_t offset);

}  // namespace fathom::logs::dataflash
