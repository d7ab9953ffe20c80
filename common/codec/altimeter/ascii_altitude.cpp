#include "codec/altimeter/ascii_altitude.hpp"

#include "codec/altimeter/deepest.hpp"
#include "codec/text/number_line.hpp"

namespace fathom::codec {
namespace {

class AsciiAltitude final : public NumberLines {
 public:
  explicit AsciiAltitude(const CodecOptions& options)
      : NumberLines(options.ascii_prefix), scale_m_(options.ascii_scale), offset_m_(options.ascii_offset) {}

 protected:
  std::optional<RejectReason> read(double number, AnySample& sample) const override {
    AltimeterSample out;
    if (number != 0.0) out.altitude_m = number * scale_m_ + offset_m_;
    if (out.altitude_m < 0.0 || out.altitude_m > kDeepestBottom_m) return RejectReason::out_of_range;
    sample = out;
    return std::nullopt;
  }

 private:
  double scale_m_;
  double offset_m_;
};

}  // namespace

std::unique_ptr<Codec> make_ascii_altitude(const CodecOptions& options) {
  return std::make_unique<AsciiAltitude>(options);
}

}  // namespace fathom::codec
