#include "codec/dvl/pd6_line.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec::pd6 {
namespace {

constexpr std::size_t kAddress = 4;  // ":BI,"
constexpr double kBadVelocity_mm_s = -32'768.0;
constexpr double kMostVelocity_mm_s = 32'767.0;
constexpr std::array<std::string_view, kLineKinds> kAddresses{":SA,", ":TS,", ":WI,", ":WS,", ":WE,",
                                                              ":WD,", ":BI,", ":BS,", ":BE,", ":BD,"};
constexpr std::array<std::size_t, kLineKinds> kFieldCounts{3, 6, 5, 4, 4, 5, 5, 4, 4, 5};

bool is_capital(std::uint8_t byte) {
  return byte >= 'A' && byte <= 'Z';
}

/// The fields of a line without their blanks, read one by one; the first thing that was wrong is kept.
class LineFields {
 public:
  explicit LineFields(std::string_view text) {
    for (;;) {
      const std::size_t comma = text.find(',');
      if (count_ < kMost) fields_[count_] = trimmed(text.substr(0, comma));
      ++count_;
      if (comma == std::string_view::npos) break;
      text.remove_prefix(comma + 1);
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::string_view text(std::size_t index) const { return fields_[index]; }

  /// A number has a digit before and behind its point: what a lost character leaves is none.
  double decimal(std::size_t index, double low, double high) {
    const std::string_view digits = fields_[index];
    const std::size_t sign = !digits.empty() && (digits[0] == '+' || digits[0] == '-') ? 1 : 0;
    const bool shaped = digits.size() > sign && is_digit(digits[sign]) && is_digit(digits.back());
    const std::optional<double> value = shaped ? parse_decimal(digits) : std::nullopt;
    if (!value) return refuse(RejectReason::field);
    if (*value < low || *value > high) return refuse(RejectReason::out_of_range);
    return *value;
  }
  double decimal(std::size_t index) { return decimal(index, -HUGE_VAL, HUGE_VAL); }

  /// m/s, of whole millimetres a second.
  double velocity(std::size_t index) {
    if (fields_[index].find('.') != std::string_view::npos) return refuse(RejectReason::field);
    const double value_mm_s = decimal(index, kBadVelocity_mm_s, kMostVelocity_mm_s);
    return value_mm_s == kBadVelocity_mm_s ? kUnknown : value_mm_s / 1e3;
  }

  double refuse(RejectReason reason) {
    if (!refused_) refused_ = reason;
    return kUnknown;
  }
  [[nodiscard]] const std::optional<RejectReason>& refused() const { return refused_; }

 private:
  static constexpr std::size_t kMost = 6;
  std::array<std::string_view, kMost> fields_;
  std::size_t count_ = 0;
  std::optional<RejectReason> refused_;
};

void read_attitude(LineFields& fields, Line& out) {
  out.pitch_rad = fields.decimal(0, -90.0, 90.0) * kRadPerDeg;
  out.roll_rad = fields.decimal(1, -180.0, 180.0) * kRadPerDeg;
  out.heading_rad = fields.decimal(2, -180.0, 360.0) * kRadPerDeg;
}

/// YYMMDDHHmmsscc. Without century: instruments of this kind exist since the eighties.
std::optional<TimeNs> calendar_clock(LineFields& fields, std::string_view digits) {
  constexpr std::size_t kDigits = 14;
  if (digits.size() != kDigits || !std::all_of(digits.begin(), digits.end(), is_digit)) {
    fields.refuse(RejectReason::field);
    return std::nullopt;
  }
  const auto pair = [&](std::size_t index) {
    return 10 * (digits[2 * index] - '0') + (digits[2 * index + 1] - '0');
  };
  CivilTime civil;
  civil.year = pair(0) < 80 ? 2000 + pair(0) : 1900 + pair(0);
  civil.month = pair(1);
  civil.day = pair(2);
  civil.hour = pair(3);
  civil.minute = pair(4);
  civil.second = pair(5);
  civil.nanosecond = pair(6) * (kNsPerSecond / 100);
  return from_civil(civil);
}

void read_timing(LineFields& fields, Line& out) {
  constexpr std::size_t kMostTestDigits = 4;
  out.clock_ns = calendar_clock(fields, fields.text(0));
  for (const std::size_t salinity_temperature_depth : {1U, 2U, 3U})
    fields.decimal(salinity_temperature_depth);
  const double sound_speed_m_s = fields.decimal(4);
  if (sound_speed_m_s >= 1'300.0 && sound_speed_m_s <= 1'700.0) out.sound_speed_m_s = sound_speed_m_s;
  const std::string_view test = fields.text(5);
  const bool hexadecimal =
      std::all_of(test.begin(), test.end(), [](char c) { return parse_hex_byte('0', c).has_value(); });
  if (test.empty() || test.size() > kMostTestDigits || !hexadecimal) fields.refuse(RejectReason::field);
}

void read_velocity_line(LineFields& fields, Line& out) {
  const std::size_t components = fields.count() - 1;
  std::array<double, 4> velocity_m_s{kUnknown, kUnknown, kUnknown, kUnknown};
  for (std::size_t i = 0; i < components; ++i) velocity_m_s[i] = fields.velocity(i);
  const std::string_view status = fields.text(components);
  if (status == "A") {
    out.velocity_m_s = velocity_m_s;
  } else if (status == "V") {
    out.bad_zeros = velocity_m_s[0] == 0.0 && velocity_m_s[1] == 0.0 && velocity_m_s[2] == 0.0;
  } else if (status != "I") {
    fields.refuse(RejectReason::field);
  }
}

void read_distance(LineFields& fields, Line& out) {
  constexpr double kMostRange_m = 9'999.99;
  for (const std::size_t made_good : {0U, 1U, 2U}) fields.decimal(made_good);
  const double range_m = fields.decimal(3, -1.0, kMostRange_m);
  fields.decimal(4);  // s since the last good velocity
  if (range_m > 0.0) out.range_m = range_m;
}

}  // namespace

Probe probe_line(Bytes front) {
  std::size_t n = 0;
  while (n < front.size() && front[n] != ':') ++n;
  if (n > 0) return Probe::skip(n);
  for (std::size_t i = 1; i < kAddress; ++i) {
    if (i == front.size()) return Probe::maybe();
    if (i + 1 < kAddress ? !is_capital(front[i]) : front[i] != ',') return Probe::skip(1);
  }
  for (std::size_t i = kAddress; i < front.size(); ++i) {
    const std::uint8_t c = front[i];
    if (c == ':' || is_line_end(static_cast<char>(c))) return Probe::frame(i);
    if (c < 0x20 || c > 0x7E) return Probe::bad(RejectReason::structure, i, i);
  }
  return Probe::need();
}

std::optional<LineKind> kind_of(std::string_view line) {
  const auto found = std::find(kAddresses.begin(), kAddresses.end(), line.substr(0, kAddress));
  if (found == kAddresses.end()) return std::nullopt;
  return static_cast<LineKind>(found - kAddresses.begin());
}

std::optional<RejectReason> read_line(LineKind kind, std::string_view line, Line& out) {
  out = Line{};
  out.kind = kind;
  LineFields fields(line.substr(kAddress));
  if (fields.count() != kFieldCounts[static_cast<std::size_t>(kind)]) return RejectReason::structure;
  switch (kind) {
    case LineKind::sa:
      read_attitude(fields, out);
      break;
    case LineKind::ts:
      read_timing(fields, out);
      break;
    case LineKind::wi:
    case LineKind::ws:
    case LineKind::we:
    case LineKind::bi:
    case LineKind::bs:
    case LineKind::be:
      read_velocity_line(fields, out);
      break;
    case LineKind::wd:
    case LineKind::bd:
      read_distance(fields, out);
      break;
  }
  return fields.refused();
}

}  // namespace fathom::codec::pd6
