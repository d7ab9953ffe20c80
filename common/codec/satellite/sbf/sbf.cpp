#include "codec/satellite/sbf/sbf.hpp"

#include <optional>

#include "base/bytes/little_endian.hpp"
#include "codec/crc16.hpp"
#include "codec/framer.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/sbf/blocks.hpp"
#include "codec/satellite/sbf/epochs.hpp"
#include "codec/satellite/sbf/interference.hpp"

namespace fathom::codec {
namespace {

using sbf::FixWithSigmas;
using sbf::GpsInstant;
using sbf::HeadingWithSigma;

Probe probe_sbf(Bytes front) {
  if (const auto other = seek_sync(front, sbf::kSync1, sbf::kSync2)) return *other;
  if (front.size() < sbf::kHeader) return Probe::need(sbf::kHeader);
  const std::size_t length = load_le<std::uint16_t>(front, 6);
  if (length < sbf::kHeader || length > sbf::kMostLength || length % 4 != 0)
    return Probe::bad(RejectReason::length, sbf::kHeader);
  if (front.size() < length) return Probe::need(length);
  const Bytes summed = front.subspan(sbf::kSummedFrom, length - sbf::kSummedFrom);
  if (crc16_ccitt(summed) != load_le<std::uint16_t>(front, 2))
    return Probe::bad(RejectReason::checksum, length);
  return Probe::frame(length);
}

class Sbf final : public Framer {
 public:
  Sbf() : Framer(sbf::kMostLength) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_sbf(front); }

  Outcome decode(Bytes block, std::uint64_t offset, Sink& sink) override {
    constexpr unsigned kNumberBits = 13;
    const unsigned id = load_le<std::uint16_t>(block, 4);
    switch (id & ((1U << kNumberBits) - 1U)) {
      case sbf::pvt_geodetic:
        return take_fix(block, id >> kNumberBits, offset, sink);
      case sbf::position_covariance:
        return take_sigmas(block, FixWithSigmas::kPosition, sink);
      case sbf::velocity_covariance:
        return take_sigmas(block, FixWithSigmas::kVelocity, sink);
      case sbf::rf_status:
        return take_interference(block);
      case sbf::receiver_time:
        return take_leap_seconds(block);
      case sbf::att_euler:
        return take_heading(block, offset, sink);
      case sbf::att_covariance:
        return take_heading_sigma(block, sink);
      case sbf::end_of_pvt:
      case sbf::end_of_att:
        return take_end(block, id & ((1U << kNumberBits) - 1U), sink);
      default:
        return Outcome::ignored();
    }
  }

  void flush(Sink& sink) override {
    fixes_.finish(deliver_to(sink));
    headings_.finish(deliver_to(sink));
  }

  Outcome take_fix(Bytes block, unsigned revision, std::uint64_t offset, Sink& sink) {
    GpsInstant at;
    sbf::Pvt got;
    if (const auto why = sbf::read_instant(block, at)) return Outcome::refused(*why);
    if (const auto why = sbf::read_pvt(block, revision, got)) return Outcome::refused(*why);
    headings_.pass(at, deliver_to(sink));
    if (fixes_.is_at(at)) return Outcome::ignored();
    interference_.stamp(got.sample, at);
    DeviceTime time = time_of(at);
    time.age_ns = got.age_ns;
    fixes_.add(at, {got.sample, time, offset, block.size()}, deliver_to(sink));
    return Outcome::used();
  }

  Outcome take_sigmas(Bytes block, std::size_t which, Sink& sink) {
    GpsInstant at;
    sbf::Sigmas sigmas{};
    if (const auto why = sbf::read_instant(block, at)) return Outcome::refused(*why);
    const auto why = which == FixWithSigmas::kPosition ? sbf::read_position_covariance(block, sigmas)
                                                       : sbf::read_velocity_covariance(block, sigmas);
    if (why) return Outcome::refused(*why);
    headings_.pass(at, deliver_to(sink));
    return fixes_.add_part(which, at, sigmas, deliver_to(sink)) ? Outcome::used() : Outcome::ignored();
  }

  Outcome take_heading(Bytes block, std::uint64_t offset, Sink& sink) {
    GpsInstant at;
    HeadingSample sample;
    if (const auto why = sbf::read_instant(block, at)) return Outcome::refused(*why);
    if (const auto why = sbf::read_att_euler(block, sample)) return Outcome::refused(*why);
    fixes_.pass(at, deliver_to(sink));
    if (headings_.is_at(at)) return Outcome::ignored();
    headings_.add(at, {sample, time_of(at), offset, block.size()}, deliver_to(sink));
    return Outcome::used();
  }

  Outcome take_heading_sigma(Bytes block, Sink& sink) {
    GpsInstant at;
    double sigma_rad = kUnknown;
    if (const auto why = sbf::read_instant(block, at)) return Outcome::refused(*why);
    if (const auto why = sbf::read_att_covariance(block, sigma_rad)) return Outcome::refused(*why);
    fixes_.pass(at, deliver_to(sink));
    const bool joined = headings_.add_part(HeadingWithSigma::kSigma, at, sigma_rad, deliver_to(sink));
    return joined ? Outcome::used() : Outcome::ignored();
  }

  Outcome take_end(Bytes block, unsigned number, Sink& sink) {
    GpsInstant at;
    if (const auto why = sbf::read_instant(block, at)) return Outcome::refused(*why);
    if (number == sbf::end_of_pvt) {
      fixes_.end(at, deliver_to(sink));
    } else {
      headings_.end(at, deliver_to(sink));
    }
    return Outcome::ignored();
  }

  Outcome take_interference(Bytes block) {
    if (const auto why = interference_.read(block)) return Outcome::refused(*why);
    return Outcome::ignored();
  }

  Outcome take_leap_seconds(Bytes block) {
    if (const auto why = sbf::read_leap_seconds(block, ahead_of_utc_ns_)) return Outcome::refused(*why);
    return Outcome::ignored();
  }

  [[nodiscard]] DeviceTime time_of(const GpsInstant& at) const {
    DeviceTime time;
    if (at) time.utc_ns = utc_of_gps(*at, ahead_of_utc_ns_);
    return time;
  }

  Epochs<sbf::FixWithSigmas> fixes_;
  Epochs<sbf::HeadingWithSigma> headings_;
  sbf::SbfInterference interference_;
  DurationNs ahead_of_utc_ns_ = kGpsAheadOfUtc_ns;
};

}  // namespace

std::unique_ptr<Codec> make_sbf(const CodecOptions& /*options*/) {
  return std::make_unique<Sbf>();
}

}  // namespace fathom::codec
