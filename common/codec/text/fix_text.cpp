#include "codec/text/fix_text.hpp"

#include <string>

#include "base/iso8601.hpp"
#include "base/units.hpp"
#include "codec/framer.hpp"
#include "codec/text/nmea_sentence.hpp"

namespace fathom::codec {
namespace {

constexpr double kLeastSigma_m = 0.01;
constexpr double kMostSigma_m = 1e5;
constexpr double kHighest_m = -50.0;
constexpr double kDeepest_m = 12'000.0;
constexpr std::size_t kFewestFields = 4;
constexpr std::size_t kMostFields = 6;

class FixText final : public Framer {
 public:
  explicit FixText(const CodecOptions& options)
      : Framer(kMaxSentence, LineEnds::belong_to_frames), require_checksum_(options.require_checksum) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_sentence(front, require_checksum_); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const Sentence sentence = split_sentence(frame);
    if (!sentence.talker.empty() || sentence.type != "PFTHX") return Outcome::ignored();
    if (sentence.fields < kFewestFields || sentence.fields > kMostFields)
      return Outcome::refused(RejectReason::structure);
    FieldReader fields(sentence);
    DeviceTime time;
    if (const std::string instant(fields.text(0)); !instant.empty()) {
      time.utc_ns = from_iso8601(instant);
      if (!time.utc_ns) return Outcome::refused(RejectReason::field);
    }
    FixSample sample;
    sample.latitude_rad = kRadPerDeg * fields.number(1, -90.0, 90.0);
    sample.longitude_rad = kRadPerDeg * fields.number(2, -180.0, 180.0);
    sample.sigma_m = fields.number(3, kLeastSigma_m, kMostSigma_m);
    sample.depth_m = fields.number(4, kHighest_m, kDeepest_m);
    sample.depth_sigma_m = fields.number(5, kLeastSigma_m, kMostSigma_m);
    if (fields.refused()) return Outcome::refused(*fields.refused());
    if (!known(sample.latitude_rad) || !known(sample.longitude_rad) || !known(sample.sigma_m))
      return Outcome::refused(RejectReason::incomplete);
    emit(sink, sample, time, offset, frame.size());
    return Outcome::used();
  }

 private:
  bool require_checksum_;
};

}  // namespace

std::unique_ptr<Codec> make_fix_text(const CodecOptions& options) {
  return std::make_unique<FixText>(options);
}

}  // namespace fathom::codec
