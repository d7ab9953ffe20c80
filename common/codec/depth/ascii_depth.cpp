#include "codec/depth/ascii_depth.hpp"

#include <string>

#include "codec/depth/depth_scale.hpp"
#include "codec/text/number_line.hpp"

namespace fathom::codec {
namespace {

class AsciiDepth final : public Framer {
 public:
  explicit AsciiDepth(const CodecOptions& options)
      : Framer(2 * kMaxNumberLine, LineEnds::belong_to_frames),
        prefix_(options.ascii_prefix),
        scale_{.unit = options.ascii_scale,
               .offset = options.ascii_offset,
               .value_is_depth = options.value_is_depth,
               .atmosphere_Pa = options.atmosphere_Pa,
               .latitude_rad = options.latitude_rad} {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_number_line(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const auto refused = [&](RejectReason reason) { return Outcome::refused(reason, frame.size()); };
    const LineNumber number = number_of_line(text_of(frame), prefix_);
    if (number.refused) return refused(*number.refused);
    if (!number.value) return Outcome::ignored();
    DepthSample sample;
    if (const auto reason = scale_.apply(*number.value, sample)) return refused(*reason);
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
