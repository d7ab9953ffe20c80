#include "codec/depth/ascii_depth.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "codec/depth/depth_line.hpp"
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

class AsciiDepth final : public Framer {
 public:
  explicit AsciiDepth(const CodecOptions& options)
      : Framer(2 * kMaxDepthLine, LineEnds::belong_to_frames),
        prefix_(options.ascii_prefix),
        scale_{.unit = options.ascii_scale,
               .offset = options.ascii_offset,
               .value_is_depth = options.value_is_depth,
               .atmosphere_Pa = options.atmosphere_Pa,
               .latitude_rad = options.latitude_rad} {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_depth_line(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const std::string_view line = text_of(frame);
    const auto refused = [&](RejectReason reason) { return Outcome::refused(reason, frame.size()); };
    if (!checksum_right(line)) return refused(RejectReason::checksum);
    if (!line.starts_with(prefix_)) return Outcome::ignored();
    const std::string_view text = trimmed(line.substr(prefix_.size()));
    const std::size_t length = std::min(text.find_first_not_of("+-.0123456789"), text.size());
    const std::optional<double> number = parse_decimal(text.substr(0, length));
    if (!number || !may_follow(text.substr(length))) return refused(RejectReason::field);
    DepthSample sample;
    if (const auto reason = scale_.apply(*number, sample)) return refused(*reason);
    emit(sink, sample, {}, offset, frame.size());
    return Outcome::used();
  }

 private:
  std::string prefix_;
  DepthScale scale_;
};

}  // namespace

std::unique_ptr<Codec> make_ascii_depth(const CodecOptions& options) {
  return std::make_unique<AsciiDepth>(options);
}

}  // namespace fathom::codec
