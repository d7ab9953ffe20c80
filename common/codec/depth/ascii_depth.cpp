#include "codec/depth/ascii_depth.hpp"

#include "codec/depth/depth_scale.hpp"
#include "codec/text/number_line.hpp"

namespace fathom::codec {
namespace {

class AsciiDepth final : public NumberLines {
 public:
  explicit AsciiDepth(const CodecOptions& options)
      : NumberLines(options.ascii_prefix),
        scale_{.unit = options.ascii_scale,
               .offset = options.ascii_offset,
               .value_is_depth = options.value_is_depth,
               .atmosphere_Pa = options.atmosphere_Pa,
               .latitude_rad = options.latitude_rad} {}

 protected:
  std::optional<RejectReason> read(double number, AnySample& sample) const override {
    DepthSample out;
    if (const auto reason = scale_.apply(number, out)) return reason;
    sample = out;
    return std::nullopt;
  }

 private:
  DepthScale scale_;
};

}  // namespace

std::unique_ptr<Codec> make_ascii_depth(const CodecOptions& options) {
  return std::make_unique<AsciiDepth>(options);
}

}  // namespace fathom::codec
