#include "codec/range/micromodem.hpp"

#include <array>
#include <string_view>

#include "base/time.hpp"
#include "codec/framer.hpp"
#include "codec/text/nmea_sentence.hpp"

namespace fathom::codec {
namespace {

constexpr double kLongestTravel_s = 20.0;  // 30 km
constexpr double kHighestAddress = 127.0;
constexpr std::size_t kTransponders = 4;
constexpr std::array<std::string_view, kTransponders> kTransponderNames{"A", "B", "C", "D"};

class Micromodem final : public Framer {
 public:
  explicit Micromodem(const CodecOptions& options)
      : Framer(kMaxSentence, LineEnds::belong_to_frames),
        require_checksum_(options.require_checksum),
        beacons_(options.beacons) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_sentence(front, require_checksum_); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const Sentence sentence = split_sentence(frame);
    if (sentence.talker == "CA" && sentence.type == "MPR") return ping(sentence, frame.size(), offset, sink);
    if (sentence.talker == "SN" && sentence.type == "TTA") {
      return transponders(sentence, frame.size(), offset, sink);
    }
    return Outcome::ignored();
  }

 private:
  Outcome ping(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    if (sentence.fields != 3) return Outcome::refused(RejectReason::structure);
    FieldReader fields(sentence);
    (void)fields.number(0, 0.0, kHighestAddress);
    (void)fields.number(1, 0.0, kHighestAddress);
    const double travel_s = fields.number(2, 0.0, kLongestTravel_s);
    if (fields.refused()) return Outcome::refused(*fields.refused());
    if (sentence.field[0].empty()) return Outcome::refused(RejectReason::incomplete);
    if (!known(travel_s)) return Outcome::ignored();  // the other modem did not answer
    deliver(sentence.field[0], travel_s, length, offset, sink);
    return Outcome::used();
  }

  Outcome transponders(const Sentence& sentence, std::size_t length, std::uint64_t offset, Sink& sink) {
    if (sentence.fields != kTransponders + 1) return Outcome::refused(RejectReason::structure);
    FieldReader fields(sentence);
    std::array<double, kTransponders> travel_s{};
    for (std::size_t i = 0; i < kTransponders; ++i) travel_s[i] = fields.number(i, 0.0, kLongestTravel_s);
    (void)fields.time_of_day(kTransponders);
    if (fields.refused()) return Outcome::refused(*fields.refused());
    bool heard = false;
    for (std::size_t i = 0; i < kTransponders; ++i) {
      if (!(travel_s[i] > 0.0)) continue;
      deliver(kTransponderNames[i], travel_s[i], length, offset, sink);
      heard = true;
    }
    return heard ? Outcome::used() : Outcome::ignored();
  }

  void deliver(std::string_view address, double travel_s, std::size_t length, std::uint64_t offset,
               Sink& sink) {
    RangeSample sample;
    sample.beacon = address;
    sample.travel_time_s = travel_s;
    sample.range_m = travel_s * beacons_.sound_speed_m_s;
    if (const BeaconPlace* beacon = beacons_.find(address)) {
      sample.beacon_latitude_rad = beacon->latitude_rad;
      sample.beacon_longitude_rad = beacon->longitude_rad;
      sample.beacon_depth_m = beacon->depth_m;
    }
    DeviceTime time;
    time.age_ns = from_seconds(travel_s);
    emit(sink, sample, time, offset, length);
  }

  bool require_checksum_;
  BeaconOptions beacons_;
};

}  // namespace

std::unique_ptr<Codec> make_micromodem(const CodecOptions& options) {
  return std::make_unique<Micromodem>(options);
}

}  // namespace fathom::codec
