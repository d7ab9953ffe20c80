#include "codec/text/nmea.hpp"

#include <optional>

#include "codec/acoustic/psimssb.hpp"
#include "codec/acoustic/psonlld.hpp"
#include "codec/acoustic/ship_pose.hpp"
#include "codec/actuator/nmea_actuator.hpp"
#include "codec/altimeter/nmea_altimeter.hpp"
#include "codec/altimeter/valeport.hpp"
#include "codec/framer.hpp"
#include "codec/heading/nmea_heading.hpp"
#include "codec/satellite/nmea_epoch.hpp"
#include "codec/satellite/nmea_gps.hpp"
#include "codec/text/nmea_sentence.hpp"

namespace fathom::codec {
namespace {

constexpr double kPascalPerDecibar = 1e4;

/// Whose sentences give samples.
enum class Scope : std::uint8_t { everything, psimssb, psonlld };

class Nmea0183 final : public Framer {
 public:
  Nmea0183(const CodecOptions& options, Scope scope)
      : Framer(kMaxSentence, LineEnds::belong_to_frames),
        require_checksum_(options.require_checksum),
        usbl_sigma_floor_m_(options.usbl.sigma_floor_m),
        dbar_{.unit = kPascalPerDecibar,
              .atmosphere_Pa = options.atmosphere_Pa,
              .latitude_rad = options.latitude_rad},
        scope_(scope) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_sentence(front, require_checksum_); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const Sentence sentence = split_sentence(frame);
    if (scope_ != Scope::psonlld && sentence.type == "PSIMSSB")
      return decode_psimssb(sentence, frame.size(), offset, sink);
    if (scope_ != Scope::psimssb && sentence.type == "PSONLLD")
      return decode_psonlld(sentence, frame.size(), offset, sink);
    if (scope_ == Scope::psimssb) ship_.note(sentence);
    if (scope_ != Scope::everything) return Outcome::ignored();
    if (const std::optional<GpsSentence> type = gps_sentence(sentence)) {
      return decode_gps(*type, sentence, frame.size(), offset, sink);
    }
    if (is_heading(sentence)) return decode_heading(sentence, frame.size(), offset, sink);
    if (is_altimeter(sentence)) return decode_altimeter(sentence, frame.size(), offset, sink);
    if (sentence.type == "PRVAT") return decode_valeport(sentence, frame.size(), offset, sink);
    if (sentence.type == "RPM") return decode_rpm(sentence, frame.size(), offset, sink);
    if (sentence.type == "RSA" || sentence.type == "XDR") {
      return decode_fins(sentence, frame.size(), offset, sink);
    }
    return Outcome::ignored();
  }

  void flush(Sink& sink) override {
    epochs_.finish(deliver_to(sink));
    deliver(fins_.finish(), sink);
  }

 private:
  GpsEpochs::Deliver deliver_to(Sink& sink) {
    return [this, &sink](const GpsSample& sample, const DeviceTime& time, std::uint64_t offset,
                         std::uint64_t length) { emit(sink, sample, time, offset, length); };
  }

  void deliver(const std::optional<FinsPairing::Ready>& ready, Sink& sink) {
    if (ready) emit(sink, ready->sample, {}, ready->offset, ready->length);
  }

  Outcome decode_gps(GpsSentence type, const Sentence& sentence, std::size_t length, std::uint64_t offset,
                     Sink& sink) {
    GpsReport report;
    if (const auto reason = parse_gps(type, sentence, report)) return Outcome::refused(*reason);
    if (!epochs_.add(report, offset, length, deliver_to(sink)))
      return Outcome::refused(RejectReason::structure);
    return Outcome::used();
  }

  Outcome decode_heading(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    HeadingSample sample;
    if (const auto reason = parse_heading(sentence, sample)) return Outcome::refused(*reason);
    emit(sink, sample, {}, offset, length);
    return Outcome::used();
  }

  Outcome decode_altimeter(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    AltimeterSample sample;
    if (const auto reason = parse_altimeter(sentence, sample)) return Outcome::refused(*reason);
    emit(sink, sample, {}, offset, length);
    return Outcome::used();
  }

  Outcome decode_valeport(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    ValeportReport report;
    if (const auto reason = parse_valeport(sentence, dbar_, report)) return Outcome::refused(*reason);
    emit(sink, report.altimeter, {}, offset, length);
    if (report.depth) emit(sink, *report.depth, {}, offset, length);
    return Outcome::used();
  }

  Outcome decode_rpm(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    PropulsionSample sample;
    bool followed = false;
    if (const auto reason = shaft_.parse(sentence, sample, followed)) return Outcome::refused(*reason);
    if (!followed) return Outcome::ignored();
    emit(sink, sample, {}, offset, length);
    return Outcome::used();
  }

  Outcome decode_fins(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    FinsReport report;
    const auto reason = sentence.type == "RSA" ? parse_rsa(sentence, report) : parse_xdr(sentence, report);
    if (reason) return Outcome::refused(*reason);
    if (!report.rudder_rad && !report.stern_rad) return Outcome::ignored();
    const FinsPairing::Result result = fins_.add(report, offset, length);
    deliver(result.first, sink);
    deliver(result.second, sink);
    return Outcome::used();
  }

  Outcome decode_psimssb(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    UsblSample sample;
    DeviceTime time;
    bool usable = false;
    const auto reason = parse_psimssb(sentence, usbl_sigma_floor_m_, sample, time, usable);
    if (reason) return Outcome::refused(*reason);
    if (!usable) return Outcome::ignored();
    ship_.give(sample, time.time_of_day_ns);
    emit(sink, sample, time, offset, length);
    return Outcome::used();
  }

  Outcome decode_psonlld(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    UsblSample sample;
    DeviceTime time;
    if (const auto reason = parse_psonlld(sentence, usbl_sigma_floor_m_, sample, time))
      return Outcome::refused(*reason);
    emit(sink, sample, time, offset, length);
    return Outcome::used();
  }

  bool require_checksum_;
  double usbl_sigma_floor_m_;
  DepthScale dbar_;
  Scope scope_;
  ShipPose ship_;
  GpsEpochs epochs_;
  ShaftFollower shaft_;
  FinsPairing fins_;
};

}  // namespace

constinit const std::string_view kNmeaDescription =
    "NMEA 0183: GGA RMC VTG GST ZDA GNS, HDT HDM HDG THS, RPM RSA XDR, DPT DBT PRVAT, PSIMSSB PSONLLD; any "
    "talker";

std::unique_ptr<Codec> make_nmea0183(const CodecOptions& options) {
  return std::make_unique<Nmea0183>(options, Scope::everything);
}

std::unique_ptr<Codec> make_psimssb(const CodecOptions& options) {
  return std::make_unique<Nmea0183>(options, Scope::psimssb);
}

std::unique_ptr<Codec> make_psonlld(const CodecOptions& options) {
  return std::make_unique<Nmea0183>(options, Scope::psonlld);
}

}  // namespace fathom::codec
