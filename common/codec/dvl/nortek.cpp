#include "codec/dvl/nortek.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "base/bytes/little_endian.hpp"
#include "codec/dvl/nortek_layout.hpp"
#include "codec/framer.hpp"

namespace fathom::codec::nortek {

std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0xB58C;
  std::size_t i = 0;
  for (; i + 1 < bytes.size(); i += 2) sum += load_le<std::uint16_t>(bytes, i);
  if (i < bytes.size()) sum += static_cast<std::uint32_t>(bytes[i]) << 8U;
  return static_cast<std::uint16_t>(sum);
}

namespace {

using Four = std::array<double, 4>;
constexpr Four kNone{kUnknown, kUnknown, kUnknown, kUnknown};

// The profilers' records of echo sounding and their text are longer than anything of a DVL. The header has a
// checksum of its own, so a damaged length holds nothing back.
constexpr std::size_t kMaxRecord = std::size_t{16} * 1024;

// Beyond every instrument of the family.
constexpr double kFastest_m_s = 50.0;
constexpr double kFarthest_m = 12'000.0;
constexpr double kLongest_s = 60.0;

/// How four numbers of a record are checked.
struct Group {
  std::size_t at;
  unsigned bits;
  float none;
  double least, most;
};
constexpr Group kBeamVelocities{group::kBeamVelocity, valid::kBeamVelocity, kNoVelocity, -kFastest_m_s,
                                kFastest_m_s};
constexpr Group kBeamDistances{group::kBeamDistance, valid::kBeamDistance, kNoDistance, 0.0, kFarthest_m};
constexpr Group kAxisVelocities{group::kAxisVelocity, valid::kAxisVelocity, kNoVelocity, -kFastest_m_s,
                                kFastest_m_s};
constexpr Group kAxisFigures{group::kAxisFigure, valid::kAxisFigure, kNoFigure, 0.0, kNoFigure};

struct Times {
  double since_trigger_s = 0.0;
  double before_output_s = 0.0;  ///< negative
};

/// The data of a bottom or water track record, and the first thing that is wrong with them.
class Track {
 public:
  explicit Track(Bytes record)
      : data_(record.subspan(record[record::kOffsetOfData])),
        status_(load_le<std::uint32_t>(record, record::kStatus)),
        beams_(take(kBeamVelocities)),
        ranges_(take(kBeamDistances)),
        axes_(take(kAxisVelocities)),
        figures_(take(kAxisFigures)),
        times_(take_times()) {}

  [[nodiscard]] std::optional<RejectReason> fault() const { return fault_; }
  [[nodiscard]] const std::optional<Times>& times() const { return times_; }

  void fill(DvlSample& sample) const {
    const auto [x, y, z1, z2] = axes_;
    const bool both = known(z1) && known(z2);
    sample.velocity_D_m_s = {x, y, both ? 0.5 * (z1 + z2) : known(z1) ? z1 : z2};
    sample.error_velocity_m_s = kErrorPerDifference * (z1 - z2);
    sample.beam_velocity_m_s = beams_;
    const double sigma = std::sqrt(0.5 * (figures_[0] * figures_[0] + figures_[1] * figures_[1]));
    if (sigma > 0.0) sample.sigma_m_s = sigma;
    if (sample.mode == DvlMode::water) return;
    sample.beam_range_m = ranges_;
    double sum = 0.0;
    int count = 0;
    for (const double range : ranges_) {
      if (!known(range)) continue;
      sum += range;
      ++count;
    }
    if (count > 0) sample.altitude_m = sum / count;
  }

 private:
  [[nodiscard]] double number(std::size_t at, std::size_t i) const {
    return load_le<float>(data_, at + sizeof(float) * i);
  }

  Four take(const Group& group) {
    Four out = kNone;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if ((status_ >> (group.bits + i) & 1U) == 0) continue;
      const double value = number(group.at, i);
      if (value == group.none) continue;
      if (!std::isfinite(value)) {
        refuse(RejectReason::field);
      } else if (value < group.least || value > group.most) {
        refuse(RejectReason::out_of_range);
      } else {
        out[i] = value;
      }
    }
    return out;
  }

  /// Of the first number that is known; of X where none is, and then they need not make sense.
  std::optional<Times> take_times() {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if (known(axes_[i])) return times_at(group::kAxisSinceTrigger, group::kAxisBeforeOutput, i, true);
    }
    for (std::size_t i = 0; i < beams_.size(); ++i) {
      if (known(beams_[i])) return times_at(group::kBeamSinceTrigger, group::kBeamBeforeOutput, i, true);
    }
    return times_at(group::kAxisSinceTrigger, group::kAxisBeforeOutput, 0, false);
  }

  std::optional<Times> times_at(std::size_t since, std::size_t before, std::size_t i, bool needed) {
    const Times times{number(since, i), number(before, i)};
    const bool finite = std::isfinite(times.since_trigger_s) && std::isfinite(times.before_output_s);
    if (finite && times.since_trigger_s >= 0.0 && times.since_trigger_s <= kLongest_s &&
        std::abs(times.before_output_s) <= kLongest_s) {
      return times;
    }
    if (needed) refuse(finite ? RejectReason::out_of_range : RejectReason::field);
    return std::nullopt;
  }

  void refuse(RejectReason reason) {
    if (!fault_) fault_ = reason;
  }

  std::optional<RejectReason> fault_;
  Bytes data_;
  std::uint32_t status_;
  Four beams_, ranges_, axes_, figures_;
  std::optional<Times> times_;
};

/// The trigger on the instrument's clock; nothing where it shows no date.
std::optional<TimeNs> trigger_of(Bytes record) {
  const auto fraction = load_le<std::uint16_t>(record, record::kHundredMicroseconds);
  if (fraction > 9'999) return std::nullopt;
  CivilTime civil;
  civil.year = 1900 + record[record::kYear];
  civil.month = 1 + record[record::kYear + 1];
  civil.day = record[record::kYear + 2];
  civil.hour = record[record::kYear + 3];
  civil.minute = record[record::kYear + 4];
  civil.second = record[record::kYear + 5];
  civil.nanosecond = std::int64_t{fraction} * 100'000;
  return from_civil(civil);
}

DeviceTime validity_of(Bytes record, const std::optional<Times>& times) {
  DeviceTime time;
  if (!times) return time;
  if (const auto trigger_ns = trigger_of(record)) {
    time.clock_ns = *trigger_ns + from_seconds(times->since_trigger_s);
  }
  time.age_ns = -from_seconds(times->before_output_s);
  return time;
}

class Nortek : public Framer {
 public:
  Nortek() : Framer(kMaxRecord) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    std::size_t n = 0;
    while (n < front.size() && front[n] != kSync) ++n;
    if (n > 0) return Probe::skip(n);
    if (front.size() < 2) return Probe::maybe();
    const std::size_t head = front[header::kLength];
    if (head != header::kShort && head != header::kLong) return Probe::skip(1);
    if (front.size() < head) return Probe::need(head);
    if (checksum(front.first(head - header::kSumBack)) !=
        load_le<std::uint16_t>(front, head - header::kSumBack)) {
      return Probe::bad(RejectReason::checksum, head);
    }
    const std::size_t size = head == header::kShort ? load_le<std::uint16_t>(front, header::kDataSize)
                                                    : load_le<std::uint32_t>(front, header::kDataSize);
    if (size > kMaxRecord - head) return Probe::bad(RejectReason::length, head);
    if (front.size() < head + size) return Probe::need(head + size);
    if (checksum(front.subspan(head, size)) != load_le<std::uint16_t>(front, head - header::kDataSumBack)) {
      return Probe::bad(RejectReason::checksum, head + size);
    }
    return Probe::frame(head + size);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const std::uint8_t kind = frame[header::kRecord];
    if (frame[header::kFamilyAt] != kFamily || (kind != kBottomTrack && kind != kWaterTrack)) {
      return Outcome::ignored();
    }
    const Bytes record = frame.subspan(frame[header::kLength]);
    if (record.size() < record::kData || record[record::kVersion] != record::kKnownVersion ||
        record[record::kOffsetOfData] < record::kData ||
        record.size() < record[record::kOffsetOfData] + group::kAll ||
        load_le<std::uint16_t>(record, record::kBeams) != 4) {
      return Outcome::refused(RejectReason::structure);
    }
    const Track track(record);
    if (const auto fault = track.fault()) return Outcome::refused(*fault);

    DvlSample sample;
    sample.mode = kind == kBottomTrack ? DvlMode::bottom : DvlMode::water;
    sample.recorded_frame = DvlFrame::instrument;
    const double sound_speed = load_le<float>(record, record::kSoundSpeed);
    if (sound_speed >= 1'300.0 && sound_speed <= 1'700.0) sample.sound_speed_m_s = sound_speed;
    track.fill(sample);
    emit(sink, sample, validity_of(record, track.times()), offset, frame.size());
    return Outcome::used();
  }
};

}  // namespace
}  // namespace fathom::codec::nortek

namespace fathom::codec {

std::unique_ptr<Codec> make_nortek(const CodecOptions& /*options*/) {
  return std::make_unique<nortek::Nortek>();
}

}  // namespace fathom::codec
