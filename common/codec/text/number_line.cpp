#include "codec/text/number_line.hpp"

#include <algorithm>

#include "codec/text/nmea_sentence.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// What may follow the number: nothing, a separator, or letters to the end (a unit).
bool may_follow(std::string_view rest) {
  if (rest.empty() || std::string_view(" \t,;*").find(rest.front()) != std::string_view::npos) return true;
  return std::all_of(rest.begin(), rest.end(), is_letter);
}

bool checksum_right(std::string_view line) {
  if (line.front() != '$' || line.size() < 4 || line[line.size() - 3] != '*') return true;
  const std::optional<std::uint8_t> sent = parse_hex_byte(line[line.size() - 2], line[line.size() - 1]);
  return sent && *sent == nmea_checksum(line.substr(1, line.size() - 4));
}

}  // namespace

Probe probe_number_line(Bytes front) {
  if (is_line_end(static_cast<char>(front[0]))) return Probe::skip(1);
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (is_line_end(static_cast<char>(front[i]))) return Probe::frame(i);
    if (i == kMaxNumberLine) return Probe::bad(RejectReason::length, i, i);
  }
  return Probe::need();
}

Outcome NumberLines::decode(Bytes frame, std::uint64_t offset, Sink& sink) {
  const std::string_view line = text_of(frame);
  const auto refused = [&](RejectReason reason) { return Outcome::refused(reason, frame.size()); };
  if (!checksum_right(line)) return refused(RejectReason::checksum);
  if (!line.starts_with(prefix_)) return Outcome::ignored();
  const std::string_view text = trimmed(line.substr(prefix_.size()));
  const std::size_t length = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  const std::optional<double> number = parse_decimal(text.substr(0, length));
  if (!number || !may_follow(text.substr(length))) return refused(RejectReason::field);
  AnySample sample;
  if (const auto reason = read(*number, sample)) return refused(*reason);
  emit(sink, sample, {}, offset, frame.size());
  return Outcome::used();
}

}  // namespace fathom::codec
