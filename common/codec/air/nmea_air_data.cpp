#include "codec/air/nmea_air_data.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "codec/framer.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

using Q = AirQuantity;
using U = AirUnit;
using Reason = std::optional<RejectReason>;

bool same_name(std::string_view a, std::string_view b) {
  const auto upper = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return upper(x) == upper(y); });
}

std::optional<U> speed_unit(std::string_view letter) {
  if (letter == "K") return U::km_h;
  if (letter == "M") return U::m_s;
  if (letter == "N") return U::kn;
  if (letter == "S") return U::mph;
  return std::nullopt;
}

/// The unit of a transducer of this type, nothing where the two do not belong together.
std::optional<U> unit_of(std::string_view type, std::string_view letter) {
  if (type == "S" || type == "G") return speed_unit(letter);
  if (type == "P") {
    if (letter == "B") return U::bar;
    if (letter == "P") return U::Pa;
    if (letter == "H") return U::hPa;
    if (letter == "I") return U::inHg;
    if (letter == "M") return U::mmHg;
  }
  if (type == "C") {
    if (letter == "C") return U::degC;
    if (letter == "F") return U::degF;
    if (letter == "K") return U::K;
  }
  if (type == "D") {
    if (letter == "M") return U::m;
    if (letter == "F") return U::ft;
  }
  return std::nullopt;
}

/// Sets a value that may be blank.
Reason set(AirReport& report, Q quantity, std::string_view text, U unit) {
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = parse_decimal(text);
  if (!value) return RejectReason::field;
  return report.set(quantity, to_si(*value, unit));
}

Reason parse_xdr(const Sentence& sentence, const AirDataOptions& options, AirReport& report, bool& ours) {
  if (sentence.fields == 0 || sentence.fields % 4 != 0 || sentence.fields > Sentence::kMaxFields)
    return RejectReason::structure;
  for (std::size_t i = 0; i < sentence.fields; i += 4) {
    for (std::size_t q = 0; q < kAirQuantities; ++q) {
      const std::string_view name = options.transducer[q].view();
      if (name.empty() || !same_name(sentence.field[i + 3], name)) continue;
      const auto quantity = static_cast<Q>(q);
      const auto unit = unit_of(sentence.field[i], sentence.field[i + 2]);
      if (!unit || !fits(quantity, *unit)) return RejectReason::field;
      if (const Reason reason = set(report, quantity, sentence.field[i + 1], *unit)) return reason;
      ours = true;
    }
  }
  return std::nullopt;
}

Reason parse_pov(const Sentence& sentence, AirReport& report, bool& ours) {
  if (sentence.fields > 0 && sentence.field[0] == "C") return std::nullopt;  // a command
  if (sentence.fields == 0 || sentence.fields % 2 != 0 || sentence.fields > Sentence::kMaxFields)
    return RejectReason::structure;
  constexpr struct {
    std::string_view type;
    Q quantity;
    U unit;
  } kTypes[] = {{"P", Q::static_pressure, U::hPa},
                {"R", Q::total_pressure, U::hPa},
                {"Q", Q::impact_pressure, U::Pa},
                {"S", Q::true_airspeed, U::km_h},
                {"T", Q::static_temperature, U::degC}};
  for (std::size_t i = 0; i < sentence.fields; i += 2) {
    for (const auto& type : kTypes) {
      if (sentence.field[i] != type.type) continue;
      if (const Reason reason = set(report, type.quantity, sentence.field[i + 1], type.unit)) return reason;
      ours = true;
    }
  }
  return std::nullopt;
}

/// Angle, R or T, speed, unit, A or V.
Reason parse_mwv(const Sentence& sentence, AirReport& report, bool& ours) {
  if (sentence.fields != 5) return RejectReason::structure;
  FieldReader fields(sentence);
  (void)fields.number(0, 0.0, 360.0);
  const char reference = fields.letter(1, "RT");
  const char status = fields.letter(4, "AV");
  if (fields.refused()) return fields.refused();
  if (reference != 'R' || status != 'A') return std::nullopt;
  const auto unit = speed_unit(sentence.field[3]);
  if (!unit) return RejectReason::field;
  ours = true;
  return set(report, Q::true_airspeed, sentence.field[2], *unit);
}

/// Angle, L or R, then the speed in knots, m/s and km/h with their letters N, M, K.
Reason parse_vwr(const Sentence& sentence, AirReport& report, bool& ours) {
  if (sentence.fields != 8) return RejectReason::structure;
  FieldReader fields(sentence);
  (void)fields.number(0, 0.0, 180.0);
  (void)fields.letter(1, "LR");
  (void)fields.letter(3, "N");
  (void)fields.letter(5, "M");
  (void)fields.letter(7, "K");
  if (fields.refused()) return fields.refused();
  ours = true;
  // The finest of the three that is there.
  for (const auto& [at, unit] : {std::pair{4U, U::m_s}, std::pair{6U, U::km_h}, std::pair{2U, U::kn}}) {
    if (!sentence.field[at].empty()) return set(report, Q::true_airspeed, sentence.field[at], unit);
  }
  return std::nullopt;
}

class NmeaAirData final : public Framer {
 public:
  explicit NmeaAirData(const CodecOptions& options)
      : Framer(kMaxSentence, LineEnds::belong_to_frames),
        require_checksum_(options.require_checksum),
        options_(options.air_data) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_sentence(front, require_checksum_); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const Sentence sentence = split_sentence(frame);
    AirReport report;
    bool ours = false;
    if (const Reason reason = parse(sentence, report, ours)) return Outcome::refused(*reason);
    if (!ours) return Outcome::ignored();
    if (!memory_.complete(report)) return Outcome::used();
    AirspeedSample sample;
    if (const Reason reason = resolve(report, options_.wanted, sample)) return Outcome::refused(*reason);
    emit(sink, sample, {}, offset, frame.size());
    return Outcome::used();
  }

 private:
  Reason parse(const Sentence& sentence, AirReport& report, bool& ours) const {
    if (sentence.type == "XDR") return parse_xdr(sentence, options_, report, ours);
    if (sentence.type == "POV") return parse_pov(sentence, report, ours);
    if (sentence.type == "MWV") return parse_mwv(sentence, report, ours);
    if (sentence.type == "VWR") return parse_vwr(sentence, report, ours);
    return std::nullopt;
  }

  bool require_checksum_;
  AirDataOptions options_;
  AirMemory memory_;
};

}  // namespace

std::unique_ptr<Codec> make_nmea_air_data(const CodecOptions& options) {
  return std::make_unique<NmeaAirData>(options);
}

}  // namespace fathom::codec
