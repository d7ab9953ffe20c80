#include "codec/altimeter/ascii_altitude.hpp"

#include <string>

#include "codec/text/number_line.hpp"

namespace fathom::codec {
namespace {

constexpr double kDeepestBottom_m = 12'000.0;

class AsciiAltitude final : public Framer {
 public:
  explicit AsciiAltitude(const CodecOptions& options)
      : Framer(2 * kMaxNumberLine, LineEnds::belong_to_frames),
        prefix_(options.ascii_prefix),
        scale_m_(options.ascii_scale),
        offset_m_(options.ascii_offset) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_number_line(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const auto refused = [&](RejectReason reason) { return Outcome::refused(reason, frame.size()); };
    const LineNumber number = number_of_line(text_of(frame), prefix_);
    if (number.refused) return refused(*number.refused);
    if (!number.value) return Outcome::ignored();
    AltimeterSample sample;
    if (*number.value != 0.0) sample.altitude_m = *number.value * scale_m_ + offset_m_;
    if (sample.altitude_m < 0.0 || sample.altitude_m > kDeepestBottom_m)
      return refused(RejectReason::out_of_range);
    emit(sink, sample, {}, offset, frame.size());
    return Outcome::used();
  }

 private:
  std::string prefix_;
  double scale_m_;
  double offset_m_;
};

}  // namespace

std::unique_ptr<Codec> make_ascii_altitude(const CodecOptions& options) {
  return std::make_unique<AsciiAltitude>(options);
}

}  // namespace fathom::codec
