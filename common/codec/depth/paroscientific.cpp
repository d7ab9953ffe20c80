#include "codec/depth/paroscientific.hpp"

#include <optional>
#include <string_view>

#include "codec/depth/depth_scale.hpp"
#include "codec/text/number_line.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr std::size_t kAddress = 5;  // `*DDSS`

class Paroscientific final : public Framer {
 public:
  explicit Paroscientific(const CodecOptions& options)
      : Framer(2 * kMaxNumberLine, LineEnds::belong_to_frames),
        scale_{.unit = options.pressure_unit_Pa,
               .value_is_depth = options.value_is_depth,
               .atmosphere_Pa = options.atmosphere_Pa,
               .latitude_rad = options.latitude_rad} {
    if (options.value_is_depth) scale_.unit = 1.0;
  }

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_number_line(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const std::string_view line = text_of(frame);
    const auto refused = [&](RejectReason reason) { return Outcome::refused(reason, frame.size()); };
    if (line.front() != '*' || line.find('*', 1) != std::string_view::npos) {
      return refused(RejectReason::structure);
    }
    if (line.size() <= kAddress || !parse_digits(line.substr(1, 4))) return refused(RejectReason::structure);
    if (line.substr(1, 2) != "00") return Outcome::ignored();

    std::string_view value = line.substr(kAddress);
    std::string_view temperature;
    if (value.size() > 3 && value[2] == '=') {
      // P1 to P4 ask for pressure, once or continuously.
      if (value[0] != 'P' || value[1] < '1' || value[1] > '4') return Outcome::ignored();
      value.remove_prefix(3);
      const std::size_t comma = value.find(',');
      if (comma != std::string_view::npos) temperature = value.substr(comma + 1);
      value = value.substr(0, comma);
    }
    DepthSample sample;
    const std::optional<double> number = parse_decimal(trimmed(value));
    if (!number) return refused(RejectReason::field);
    if (!temperature.empty()) {
      const std::optional<double> degrees = parse_decimal(trimmed(temperature));
      if (!degrees) return refused(RejectReason::field);
      if (*degrees < -100.0 || *degrees > 200.0) return refused(RejectReason::out_of_range);
      sample.temperature_degC = *degrees;
    }
    if (const auto reason = scale_.apply(*number, sample)) return refused(*reason);
    emit(sink, sample, {}, offset, frame.size());
    return Outcome::used();
  }

 private:
  DepthScale scale_;
};

}  // namespace

std::unique_ptr<Codec> make_paroscientific(const CodecOptions& options) {
  return std::make_unique<Paroscientific>(options);
}

}  // namespace fathom::codec
