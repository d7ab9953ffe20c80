#include "codec/satellite/novatel/novatel.hpp"

#include <optional>

#include "base/bytes/little_endian.hpp"
#include "codec/framer.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/fix_epochs.hpp"
#include "codec/satellite/novatel/logs.hpp"

namespace fathom::codec {

std::uint32_t novatel::crc32(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kPolynomial = 0xEDB8'8320U;
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kPolynomial : crc >> 1U;
  }
  return crc;
}

namespace {

/// Of a frame of which kShortHeader bytes are here; 0 where its header is too short.
std::size_t novatel_length(Bytes front) {
  if (front[2] == novatel::kShortSync3) return novatel::kShortHeader + front[3] + novatel::kCrc;
  if (front[3] < novatel::kHeader) return 0;
  return front[3] + load_le<std::uint16_t>(front, 8) + novatel::kCrc;
}

class Novatel final : public Framer {
 public:
  Novatel() : Framer(novatel::kMostFrame) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (const auto other = seek_sync(front, novatel::kSync1, novatel::kSync2)) return *other;
    if (front.size() < 3) return Probe::maybe();
    if (front[2] != novatel::kSync3 && front[2] != novatel::kShortSync3) return Probe::skip(1);
    if (front.size() < novatel::kShortHeader) return Probe::need(novatel::kShortHeader);
    const std::size_t length = novatel_length(front);
    if (length == 0 || length > novatel::kMostFrame)
      return Probe::bad(RejectReason::length, novatel::kShortHeader);
    if (front.size() < length) return Probe::need(length);
    const std::size_t crc_at = length - novatel::kCrc;
    if (novatel::crc32(front.first(crc_at)) != load_le<std::uint32_t>(front, crc_at))
      return Probe::bad(RejectReason::checksum, length);
    return Probe::frame(length);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    if (frame[2] == novatel::kShortSync3) return Outcome::ignored();
    const novatel::Header header = novatel::read_header(frame);
    if (!header.is_log_of_primary()) return Outcome::ignored();
    const Bytes message = frame.subspan(frame[3], frame.size() - frame[3] - novatel::kCrc);
    switch (header.message) {
      case novatel::best_position:
        return take_position(frame, header, message, offset, sink);
      case novatel::best_velocity:
        return take_velocity(header, message, sink);
      case novatel::heading2:
      case novatel::dual_antenna_heading:
        return take_heading(frame, header, message, offset, sink);
      case novatel::time_of_receiver:
        if (const auto why = novatel::read_time(message, ahead_of_utc_ns_)) return Outcome::refused(*why);
        return Outcome::ignored();
      default:
        return Outcome::ignored();
    }
  }

  void flush(Sink& sink) override { epochs_.finish(deliver_to(sink)); }

 private:
  /// A time that the header vouches for and cannot be.
  static std::optional<RejectReason> impossible_time(const novatel::Header& header) {
    if (!novatel::is_known(header.time_status)) return std::nullopt;
    const bool possible = gps_of_week(header.week, header.time_of_week_ms).has_value();
    return possible ? std::nullopt : std::optional(RejectReason::out_of_range);
  }

  Outcome take_position(Bytes frame, const novatel::Header& header, Bytes message, std::uint64_t offset,
                        Sink& sink) {
    GpsSample sample;
    if (const auto why = novatel::read_position(message, sample)) return Outcome::refused(*why);
    if (const auto why = impossible_time(header)) return Outcome::refused(*why);
    epochs_.add(header.time_of_week_ms, {sample, time_of(header), offset, frame.size()}, deliver_to(sink));
    return Outcome::used();
  }

  /// Without a position it is no sample.
  Outcome take_velocity(const novatel::Header& header, Bytes message, Sink& sink) {
    EpochVelocity velocity;
    if (const auto why = novatel::read_velocity(message, velocity)) return Outcome::refused(*why);
    if (const auto why = impossible_time(header)) return Outcome::refused(*why);
    const bool joined =
        epochs_.add_part(FixWithVelocity::kVelocity, header.time_of_week_ms, velocity, deliver_to(sink));
    return joined ? Outcome::used() : Outcome::ignored();
  }

  Outcome take_heading(Bytes frame, const novatel::Header& header, Bytes message, std::uint64_t offset,
                       Sink& sink) {
    novatel::Heading got;
    if (const auto why = novatel::read_heading(message, got)) return Outcome::refused(*why);
    if (const auto why = impossible_time(header)) return Outcome::refused(*why);
    if (got.to_another_vehicle) return Outcome::ignored();
    const bool has_heading = known(got.sample.heading_rad);
    const bool again = heading_at_ms_ == header.time_of_week_ms && heading_by_ != header.message;
    if (again && (heading_known_ || !has_heading)) return Outcome::ignored();
    heading_at_ms_ = header.time_of_week_ms;
    heading_by_ = header.message;
    heading_known_ = has_heading;
    emit(sink, got.sample, time_of(header), offset, frame.size());
    return Outcome::used();
  }

  [[nodiscard]] DeviceTime time_of(const novatel::Header& header) const {
    DeviceTime time;
    const auto gps_ns = gps_of_week(header.week, header.time_of_week_ms);
    if (gps_ns && novatel::is_known(header.time_status)) time.utc_ns = utc_of_gps(*gps_ns, ahead_of_utc_ns_);
    return time;
  }

  FixEpochs epochs_;
  DurationNs ahead_of_utc_ns_ = kGpsAheadOfUtc_ns;
  std::optional<std::uint32_t> heading_at_ms_;  ///< time of the week of the last one,
  std::uint16_t heading_by_ = 0;                ///< the log that it came in,
  bool heading_known_ = false;                  ///< and whether there was one
};

}  // namespace

std::unique_ptr<Codec> make_novatel(const CodecOptions& /*options*/) {
  return std::make_unique<Novatel>();
}

}  // namespace fathom::codec
