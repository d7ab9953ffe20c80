#include "codec/heading/nmea_attitude.hpp"

#include <algorithm>
#include <string_view>

#include "base/units.hpp"
#include "codec/framer.hpp"
#include "codec/heading/nmea_heading.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr double kMostPitch_deg = 90.0;
constexpr double kMostRoll_deg = 180.0;
constexpr double kMostHeave_m = 100.0;
constexpr double kMostAccuracy_deg = 360.0;
constexpr double kSaysNothing_deg = 180.0;
constexpr double kMostOfAnything = 1e9;
constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kStatuses = "NMOLPCHV";
constexpr std::string_view kInOrder = "NMO";

/// Preferred ones first.
enum class Form : std::uint8_t { pashr, psat, ptnthpr, ohpr, tagged, prdid };

struct Attitude {
  Form form = Form::pashr;
  HeadingSample sample;
  DeviceTime time;
};

/// Nothing where it is none of these sentences.
std::optional<Form> form_of(const Sentence& sentence) {
  const std::string_view first = sentence.fields > 0 ? sentence.field[0] : std::string_view();
  // Ashtech's own begin with a word.
  if (sentence.type == "PASHR" && sentence.fields > 0 && (first.empty() || is_digit(first.front())))
    return Form::pashr;
  if (sentence.type == "PSAT" && first == "HPR") return Form::psat;
  if (sentence.type == "PTNTHPR") return Form::ptnthpr;
  if (sentence.type == "OHPR") return Form::ohpr;
  if (sentence.type == "PRDID") return Form::prdid;
  return std::nullopt;
}

/// Some pad their numbers.
void trim(Sentence& sentence) {
  for (std::size_t i = 0; i < std::min(sentence.fields, Sentence::kMaxFields); ++i)
    sentence.field[i] = trimmed(sentence.field[i]);
}

void check_pitch_and_roll(FieldReader& fields, std::size_t pitch_at, std::size_t roll_at) {
  (void)fields.number(pitch_at, -kMostPitch_deg, kMostPitch_deg);
  (void)fields.number(roll_at, -kMostRoll_deg, kMostRoll_deg);
}

std::optional<RejectReason> parse_pashr(const Sentence& sentence, Attitude& out) {
  if (sentence.fields != 10 && sentence.fields != 11) return RejectReason::structure;
  FieldReader fields(sentence);
  out.time.time_of_day_ns = fields.time_of_day(0);
  const double heading_rad = read_heading(fields, 1);
  (void)fields.letter(2, "T");
  check_pitch_and_roll(fields, 4, 3);
  (void)fields.number(5, -kMostHeave_m, kMostHeave_m);
  (void)fields.number(6, 0.0, kMostAccuracy_deg);
  (void)fields.number(7, 0.0, kMostAccuracy_deg);
  const double accuracy_deg = fields.number(8, 0.0, kMostAccuracy_deg);
  const char gnss = fields.letter(9, kDigits);
  const char ins = fields.letter(10, kDigits);
  const bool told = accuracy_deg > 0.0;
  const bool aligned = ins != '0' && ins != '\0';
  const bool none = (gnss == '0' && !aligned) || (ins == '0' && !told) || accuracy_deg >= kSaysNothing_deg;
  if (!none) {
    out.sample.heading_rad = heading_rad;
    if (told && known(heading_rad)) out.sample.sigma_rad = accuracy_deg * kRadPerDeg;
  }
  return fields.refused();
}

std::optional<RejectReason> parse_psat(const Sentence& sentence, Attitude& out) {
  if (sentence.fields != 6) return RejectReason::structure;
  FieldReader fields(sentence);
  out.time.time_of_day_ns = fields.time_of_day(1);
  out.sample.heading_rad = read_heading(fields, 2);
  check_pitch_and_roll(fields, 3, 4);
  (void)fields.letter(5, "NG");
  return fields.refused();
}

std::optional<RejectReason> parse_ptnthpr(const Sentence& sentence, Attitude& out) {
  if (sentence.fields != 6) return RejectReason::structure;
  FieldReader fields(sentence);
  const double heading_rad = read_heading(fields, 0);
  check_pitch_and_roll(fields, 2, 4);
  bool alarm = false;
  for (const std::size_t at : {std::size_t{1}, std::size_t{3}, std::size_t{5}}) {
    const char status = fields.letter(at, kStatuses);
    if (status != '\0' && kInOrder.find(status) == std::string_view::npos) alarm = true;
  }
  if (!alarm) out.sample.heading_rad = heading_rad;
  return fields.refused();
}

std::optional<RejectReason> parse_ohpr(const Sentence& sentence, Attitude& out) {
  if (sentence.fields < 3 || sentence.fields > Sentence::kMaxFields) return RejectReason::structure;
  FieldReader fields(sentence);
  out.sample.heading_rad = read_heading(fields, 0);
  check_pitch_and_roll(fields, 1, 2);
  for (std::size_t i = 3; i < sentence.fields; ++i) (void)fields.number(i, -kMostOfAnything, kMostOfAnything);
  return fields.refused();
}

std::optional<RejectReason> parse_prdid(const Sentence& sentence, Attitude& out) {
  if (sentence.fields != 3) return RejectReason::structure;
  FieldReader fields(sentence);
  check_pitch_and_roll(fields, 0, 1);
  out.sample.heading_rad = read_heading(fields, 2);
  return fields.refused();
}

bool begins_tagged(Bytes front) {
  return front.size() > 2 && front[0] == '$' && front[1] == 'C' && is_digit(static_cast<char>(front[2]));
}

/// `$C320.5P0.2R-18.3T19.0`: tags of one capital and small letters, each with its number, cut into the fields
/// of an OHPR whose further ones stay where they are.
std::optional<RejectReason> parse_tagged(std::string_view text, Attitude& out) {
  constexpr std::string_view kNumber = "+-.0123456789";
  Sentence sentence;
  sentence.fields = 3;
  text = text.substr(1, text.find('*') - 1);
  while (!text.empty()) {
    const std::size_t number = std::min(text.find_first_of(kNumber), text.size());
    const std::size_t end = std::min(text.find_first_not_of(kNumber, number), text.size());
    const std::string_view tag = text.substr(0, number);
    const std::string_view value = text.substr(number, end - number);
    if (tag.empty() || value.empty() || tag.front() < 'A' || tag.front() > 'Z')
      return RejectReason::structure;
    const std::size_t at = tag.size() == 1 ? std::string_view("CPR").find(tag) : std::string_view::npos;
    std::string_view& field = at < 3 ? sentence.field[at] : sentence.field[sentence.fields];
    if (!field.empty() || sentence.fields == Sentence::kMaxFields - 1) return RejectReason::structure;
    field = value;
    if (at >= 3) ++sentence.fields;
    text.remove_prefix(end);
  }
  return parse_ohpr(sentence, out);
}

std::optional<RejectReason> parse(const Sentence& sentence, Attitude& out) {
  switch (out.form) {
    case Form::pashr:
      return parse_pashr(sentence, out);
    case Form::psat:
      return parse_psat(sentence, out);
    case Form::ptnthpr:
      return parse_ptnthpr(sentence, out);
    case Form::ohpr:
      return parse_ohpr(sentence, out);
    case Form::prdid:
      return parse_prdid(sentence, out);
    case Form::tagged:
      break;
  }
  return RejectReason::structure;
}

North usual_north(Form form) {
  const bool compass = form == Form::ptnthpr || form == Form::ohpr || form == Form::tagged;
  return compass ? North::magnetic : North::true_north;
}
bool says_its_north(Form form) {
  return form == Form::pashr || form == Form::psat;
}

/// Which of several sentences of one line is followed.
class FormFollower {
 public:
  bool follows(const Attitude& attitude) {
    const bool says = known(attitude.sample.heading_rad);
    if (!form_ || (says && attitude.form < *form_)) form_ = attitude.form;
    if (attitude.form == *form_) {
      if (says) others_ = 0;
      return true;
    }
    if (!says || ++others_ < kPatience) return false;
    form_ = attitude.form;
    others_ = 0;
    return true;
  }

 private:
  // More than the slowest of two sentences lets pass of the quickest.
  static constexpr int kPatience = 100;
  std::optional<Form> form_;
  int others_ = 0;  // headings since the last one of form_
};

class NmeaAttitude final : public Framer {
 public:
  explicit NmeaAttitude(const CodecOptions& options)
      : Framer(kMaxSentence, LineEnds::belong_to_frames),
        require_checksum_(options.require_checksum),
        untold_north_(options.untold_north) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override {
    constexpr std::size_t kTag = 2;  // `$C`
    return begins_tagged(front) ? probe_fields(front, kTag, require_checksum_)
                                : probe_sentence(front, require_checksum_);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    Attitude attitude;
    std::optional<RejectReason> refused;
    if (begins_tagged(frame)) {
      attitude.form = Form::tagged;
      refused = parse_tagged(text_of(frame), attitude);
    } else {
      Sentence sentence = split_sentence(frame);
      trim(sentence);
      const std::optional<Form> form = form_of(sentence);
      if (!form) return Outcome::ignored();
      attitude.form = *form;
      refused = parse(sentence, attitude);
    }
    if (refused) return Outcome::refused(*refused);
    if (!follower_.follows(attitude)) return Outcome::ignored();
    const North usual = usual_north(attitude.form);
    attitude.sample.north = says_its_north(attitude.form) ? usual : untold_north_.value_or(usual);
    emit(sink, attitude.sample, attitude.time, offset, frame.size());
    return Outcome::used();
  }

 private:
  bool require_checksum_;
  std::optional<North> untold_north_;
  FormFollower follower_;
};

}  // namespace

std::unique_ptr<Codec> make_nmea_attitude(const CodecOptions& options) {
  return std::make_unique<NmeaAttitude>(options);
}

}  // namespace fathom::codec
