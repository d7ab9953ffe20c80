#include "codec/actuator/nmea_actuator.hpp"

#include <algorithm>
#include <string_view>

#include "base/units.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr double kMaxRpm = 1e5;
constexpr double kMaxDeflection_deg = 180.0;
constexpr int kPatience = 2;

bool same_word(std::string_view text, std::string_view upper_case) {
  return std::equal(text.begin(), text.end(), upper_case.begin(), upper_case.end(), [](char a, char b) {
    return (a >= 'a' && a <= 'z' ? static_cast<char>(a - 'a' + 'A') : a) == b;
  });
}

FinsSample sample_of(const FinsReport& report) {
  FinsSample sample;
  sample.rudder_rad = report.rudder_rad.value_or(kUnknown);
  sample.stern_rad = report.stern_rad.value_or(kUnknown);
  return sample;
}

}  // namespace

std::optional<RejectReason> ShaftFollower::parse(const Sentence& sentence, PropulsionSample& sample,
                                                 bool& followed) {
  followed = false;
  if (sentence.fields != 5) return RejectReason::structure;
  FieldReader fields(sentence);
  Source source;
  source.kind = fields.letter(0, "SE");
  const std::optional<std::uint32_t> number = parse_digits(fields.text(1));
  if (!number && !fields.text(1).empty()) fields.refuse(RejectReason::field);
  source.number = number.value_or(0);
  const double rpm = fields.number(2, -kMaxRpm, kMaxRpm);
  (void)fields.number(3, -100.0, 100.0);
  const char status = fields.letter(4, "AV");
  if (fields.refused()) return fields.refused();
  if (!source_ || (source_->kind != 'S' && source.kind == 'S')) source_ = source;
  if (*source_ != source) return std::nullopt;
  followed = true;
  sample = PropulsionSample{};
  if (status == 'A') sample.rpm = rpm;
  return std::nullopt;
}

std::optional<RejectReason> parse_rsa(const Sentence& sentence, FinsReport& report) {
  report = FinsReport{};
  if (sentence.fields != 2 && sentence.fields != 4) return RejectReason::structure;
  FieldReader fields(sentence);
  const double starboard_deg = fields.number(0, -kMaxDeflection_deg, kMaxDeflection_deg);
  const char status = fields.letter(1, "AV");
  (void)fields.number(2, -kMaxDeflection_deg, kMaxDeflection_deg);
  (void)fields.letter(3, "AV");
  report.rudder_rad = status == 'A' ? -starboard_deg * kRadPerDeg : kUnknown;
  return fields.refused();
}

std::optional<RejectReason> parse_xdr(const Sentence& sentence, FinsReport& report) {
  report = FinsReport{};
  if (sentence.fields == 0 || sentence.fields % 4 != 0 || sentence.fields > Sentence::kMaxFields) {
    return RejectReason::structure;
  }
  FieldReader fields(sentence);
  for (std::size_t i = 0; i < sentence.fields; i += 4) {
    const bool rudder = same_word(fields.text(i + 3), "RUDDER");
    if (!rudder && !same_word(fields.text(i + 3), "STERN")) continue;
    if (fields.text(i) != "A" || fields.text(i + 2) != "D") return RejectReason::field;
    const double value_rad = fields.number(i + 1, -kMaxDeflection_deg, kMaxDeflection_deg) * kRadPerDeg;
    (rudder ? report.rudder_rad : report.stern_rad) = value_rad;
  }
  return fields.refused();
}

FinsPairing::Result FinsPairing::add(const FinsReport& report, std::uint64_t offset, std::uint64_t length) {
  Result result;
  if (report.rudder_rad && report.stern_rad) {
    result.first = finish();
    result.second = Ready{sample_of(report), offset, length};
    return result;
  }
  if (waiting_ && waiting_->report.rudder_rad.has_value() != report.rudder_rad.has_value()) {
    FinsReport both = waiting_->report;
    (report.rudder_rad ? both.rudder_rad : both.stern_rad) =
        report.rudder_rad ? report.rudder_rad : report.stern_rad;
    const std::uint64_t first = waiting_->offset;
    result.first = Ready{sample_of(both), first, offset + length - first};
    waiting_.reset();
    alone_ = 0;
    return result;
  }
  if (waiting_) {
    result.first = finish();
    ++alone_;
    if (alone_ >= kPatience) {
      result.second = Ready{sample_of(report), offset, length};
      last_alone_is_rudder_ = report.rudder_rad.has_value();
      return result;
    }
  } else if (alone_ >= kPatience && last_alone_is_rudder_ == report.rudder_rad.has_value()) {
    result.first = Ready{sample_of(report), offset, length};
    return result;
  }
  waiting_ = Half{report, offset, length};
  return result;
}

std::optional<FinsPairing::Ready> FinsPairing::finish() {
  if (!waiting_) return std::nullopt;
  const Ready ready{sample_of(waiting_->report), waiting_->offset, waiting_->length};
  waiting_.reset();
  return ready;
}

}  // namespace fathom::codec
