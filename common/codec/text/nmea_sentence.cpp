#include "codec/text/nmea_sentence.hpp"

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr std::size_t kMinAddress = 3;
constexpr std::size_t kMaxAddress = 10;

bool starts_sentence(std::uint8_t byte) {
  return byte == '$' || byte == '!';
}

bool in_address(char c) {
  return is_digit(c) || (c >= 'A' && c <= 'Z');
}

}  // namespace

std::uint8_t nmea_checksum(std::string_view between_dollar_and_star) {
  std::uint8_t sum = 0;
  for (const char c : between_dollar_and_star) {
    sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  }
  return sum;
}

Probe probe_fields(Bytes front, std::size_t from, bool require_checksum) {
  const std::string_view text = text_of(front);
  std::uint8_t sum = nmea_checksum(text.substr(1, from - 1));
  for (std::size_t i = from; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '*') {
      if (i + 1 < text.size() && is_line_end(text[i + 1])) {
        return require_checksum ? Probe::bad(RejectReason::no_checksum, i + 1) : Probe::frame(i + 1);
      }
      if (i + 2 >= text.size()) return Probe::need(i + 3);
      const std::optional<std::uint8_t> sent = parse_hex_byte(text[i + 1], text[i + 2]);
      if (!sent) return Probe::bad(RejectReason::checksum, i + 1);
      return *sent == sum ? Probe::frame(i + 3) : Probe::bad(RejectReason::checksum, i + 3);
    }
    if (is_line_end(c)) {
      return require_checksum ? Probe::bad(RejectReason::no_checksum, i) : Probe::frame(i);
    }
    // A new sentence begins before this one has ended: this one was cut.
    if (c == '$') return Probe::bad(RejectReason::length, i);
    if (static_cast<unsigned char>(c) < 0x20) return Probe::bad(RejectReason::structure, i);
    sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  }
  return Probe::need();
}

Probe probe_sentence(Bytes front, bool require_checksum) {
  if (!starts_sentence(front[0])) {
    std::size_t count = 1;
    while (count < front.size() && !starts_sentence(front[count])) ++count;
    return Probe::skip(count);
  }
  const std::string_view text = text_of(front);
  std::size_t end = 1;
  while (end < text.size() && end <= kMaxAddress + 1 && in_address(text[end])) ++end;
  if (end > kMaxAddress + 1) return Probe::skip(1);
  if (end == text.size()) return Probe::maybe();
  if (end - 1 < kMinAddress || (text[end] != ',' && text[end] != '*')) return Probe::skip(1);
  return probe_fields(front, end, require_checksum);
}

Sentence split_sentence(Bytes frame) {
  std::string_view text = text_of(frame).substr(1);
  text = text.substr(0, text.find('*'));
  Sentence sentence;
  std::size_t comma = text.find(',');
  const std::string_view address = text.substr(0, comma);
  if (address.front() == 'P' || address.size() < 5) {
    sentence.type = address;
  } else {
    sentence.talker = address.substr(0, 2);
    sentence.type = address.substr(2);
  }
  while (comma != std::string_view::npos) {
    text.remove_prefix(comma + 1);
    comma = text.find(',');
    if (sentence.fields < Sentence::kMaxFields) sentence.field[sentence.fields] = text.substr(0, comma);
    ++sentence.fields;
  }
  return sentence;
}

std::string_view FieldReader::text(std::size_t index) const {
  return index < sentence_.fields && index < Sentence::kMaxFields ? sentence_.field[index]
                                                                  : std::string_view();
}

void FieldReader::refuse(RejectReason reason) {
  if (!refused_) refused_ = reason;
}

double FieldReader::number(std::size_t index, double low, double high) {
  const std::string_view digits = text(index);
  if (digits.empty()) return kUnknown;
  const std::optional<double> value = parse_decimal(digits);
  if (!value) {
    refuse(RejectReason::field);
    return kUnknown;
  }
  if (*value < low || *value > high) {
    refuse(RejectReason::out_of_range);
    return kUnknown;
  }
  return *value;
}

char FieldReader::letter(std::size_t index, std::string_view allowed) {
  const std::string_view word = text(index);
  if (word.empty()) return '\0';
  if (word.size() != 1 || allowed.find(word.front()) == std::string_view::npos) {
    refuse(RejectReason::field);
    return '\0';
  }
  return word.front();
}

std::optional<DurationNs> FieldReader::time_of_day(std::size_t index) {
  const std::string_view digits = text(index);
  if (digits.empty()) return std::nullopt;
  const std::optional<std::uint32_t> whole = parse_digits(digits.substr(0, 6));
  const std::string_view rest = digits.substr(std::min<std::size_t>(6, digits.size()));
  if (digits.size() < 6 || !whole || (!rest.empty() && rest.front() != '.')) {
    refuse(RejectReason::field);
    return std::nullopt;
  }
  DurationNs fraction = 0;
  DurationNs unit = kNsPerSecond;
  for (const char c : rest.substr(rest.empty() ? 0 : 1)) {
    if (!is_digit(c)) {
      refuse(RejectReason::field);
      return std::nullopt;
    }
    unit /= 10;
    fraction += unit * (c - '0');
  }
  const std::uint32_t hour = *whole / 10'000;
  const std::uint32_t minute = *whole / 100 % 100;
  const std::uint32_t second = *whole % 100;
  if (hour > 23 || minute > 59 || second > 60) {
    refuse(RejectReason::out_of_range);
    return std::nullopt;
  }
  return (DurationNs{hour} * 3600 + DurationNs{minute} * 60 + second) * kNsPerSecond + fraction;
}

double FieldReader::latitude(std::size_t index) {
  return angle(index, "NS", 90.0);
}

double FieldReader::longitude(std::size_t index) {
  return angle(index, "EW", 180.0);
}

double FieldReader::angle(std::size_t index, std::string_view hemispheres, double limit_deg) {
  const std::string_view digits = text(index);
  const char hemisphere = letter(index + 1, hemispheres);
  if (digits.empty() || hemisphere == '\0') return kUnknown;
  const std::size_t point = digits.find('.');
  const std::string_view whole = digits.substr(0, point);
  if (whole.size() < 3 || whole.size() > 5 || !parse_digits(whole)) {
    refuse(RejectReason::field);
    return kUnknown;
  }
  const std::optional<double> degrees = parse_decimal(whole.substr(0, whole.size() - 2));
  const std::optional<double> minutes = parse_decimal(digits.substr(whole.size() - 2));
  if (!degrees || !minutes) {
    refuse(RejectReason::field);
    return kUnknown;
  }
  const double value_deg = *degrees + *minutes / 60.0;
  if (*minutes >= 60.0 || value_deg > limit_deg) {
    refuse(RejectReason::out_of_range);
    return kUnknown;
  }
  return (hemisphere == hemispheres.front() ? value_deg : -value_deg) * kRadPerDeg;
}

double FieldReader::east_west(std::size_t index, double limit_deg) {
  const double value_deg = number(index, 0.0, limit_deg);
  const char side = letter(index + 1, "EW");
  if (!known(value_deg) || side == '\0') return kUnknown;
  return (side == 'E' ? value_deg : -value_deg) * kRadPerDeg;
}

}  // namespace fathom::codec
