#include "codec/air/ascii_air_data.hpp"

#include <optional>
#include <string_view>

#include "codec/framer.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr std::size_t kMaxLine = 256;

/// Cuts the next column off `rest`; nothing when there is none.
std::optional<std::string_view> next_column(std::string_view& rest, char separator, bool& more) {
  if (!more) return std::nullopt;
  if (separator == ' ') rest = trimmed(rest);
  const std::size_t end = rest.find(separator);
  more = end != std::string_view::npos;
  const std::string_view column = trimmed(rest.substr(0, end));
  rest = more ? rest.substr(end + 1) : std::string_view();
  return column;
}

class AsciiAirData final : public Framer {
 public:
  explicit AsciiAirData(const CodecOptions& options)
      : Framer(2 * kMaxLine, LineEnds::belong_to_frames),
        require_checksum_(options.require_checksum),
        options_(options.air_data) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (is_line_end(static_cast<char>(front[0]))) return Probe::skip(1);
    for (std::size_t i = 0; i < front.size(); ++i) {
      if (is_line_end(static_cast<char>(front[i]))) return Probe::frame(i);
      if (i == kMaxLine) return Probe::bad(RejectReason::length, i, i);
    }
    return Probe::need();
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    std::string_view line = text_of(frame);
    const auto refused = [&](RejectReason reason) { return Outcome::refused(reason, frame.size()); };
    if (const auto reason = take_checksum(line)) return refused(*reason);
    if (!line.starts_with(options_.prefix.view())) return Outcome::ignored();
    line.remove_prefix(options_.prefix.view().size());
    AirReport report;
    if (const auto reason = read(line, report)) return refused(*reason);
    AirspeedSample sample;
    if (const auto reason = resolve(report, options_.wanted, sample)) return refused(*reason);
    emit(sink, sample, {}, offset, frame.size());
    return Outcome::used();
  }

 private:
  /// Checks it and cuts it off.
  [[nodiscard]] std::optional<RejectReason> take_checksum(std::string_view& line) const {
    line = trimmed(line);
    const std::size_t star = line.rfind('*');
    if (star == std::string_view::npos)
      return require_checksum_ ? std::optional(RejectReason::no_checksum) : std::nullopt;
    if (star + 3 != line.size()) return RejectReason::checksum;
    const std::optional<std::uint8_t> sent = parse_hex_byte(line[star + 1], line[star + 2]);
    line = line.substr(0, star);
    const std::string_view summed = line.starts_with('$') ? line.substr(1) : line;
    if (!sent || *sent != nmea_checksum(summed)) return RejectReason::checksum;
    return std::nullopt;
  }

  [[nodiscard]] std::optional<RejectReason> read(std::string_view rest, AirReport& report) const {
    bool more = true;
    for (std::size_t i = 0; i < options_.count; ++i) {
      const auto text = next_column(rest, options_.separator, more);
      if (!text) return RejectReason::structure;
      const AirColumn& column = options_.columns[i];
      if (column.quantity == AirQuantity::ignored || text->empty()) continue;
      const std::optional<double> number = parse_decimal(*text);
      if (!number) return RejectReason::field;
      if (const auto reason = report.set(column.quantity, to_si(*number, column.unit))) return reason;
    }
    return more ? std::optional(RejectReason::structure) : std::nullopt;
  }

  bool require_checksum_;
  AirDataOptions options_;
};

}  // namespace

std::unique_ptr<Codec> make_ascii_air_data(const CodecOptions& options) {
  return std::make_unique<AsciiAirData>(options);
}

}  // namespace fathom::codec
