#include "codec/satellite/ubx.hpp"

#include <bit>
#include <optional>

#include "base/bytes/little_endian.hpp"
#include "codec/fletcher.hpp"
#include "codec/satellite/pvt.hpp"
#include "codec/satellite/ubx_heading.hpp"
#include "codec/satellite/ubx_interference.hpp"

namespace fathom::codec {
namespace {

constexpr std::size_t kHeader = 6;    // sync, class, id, length
constexpr std::size_t kOverhead = 8;  // header and checksum
constexpr std::uint8_t kClassNav = 0x01;
constexpr std::uint8_t kIdPvt = 0x07;
constexpr std::size_t kPvtLength = 92;
constexpr std::size_t kPvtLengthGeneration7 = 84;

Probe probe_ubx(Bytes front) {
  if (const auto other = seek_sync(front, kUbxSync1, kUbxSync2)) return *other;
  if (front.size() < kHeader) return Probe::need(kHeader);
  const std::size_t payload = load_le<std::uint16_t>(front, 4);
  if (payload > kUbxMaxPayload) return Probe::bad(RejectReason::length, kHeader);
  const std::size_t total = payload + kOverhead;
  if (front.size() < total) return Probe::need(total);
  const auto [a, b] = fletcher8(front.subspan(2, payload + 4));
  if (front[total - 2] != a || front[total - 1] != b) return Probe::bad(RejectReason::checksum, total);
  return Probe::frame(total);
}

std::optional<RejectReason> read_nav_pvt(Bytes payload, GpsSample& sample, DeviceTime& time) {
  if (payload.size() != kPvtLength && payload.size() != kPvtLengthGeneration7) return RejectReason::length;
  Pvt pvt(payload, std::endian::little);
  pvt.satellites = payload[23];
  // Generation 7 has no such flag: there these bytes are reserved.
  pvt.position_invalid = payload.size() >= kPvtLength && (payload[78] & 1U) != 0;
  return read_pvt(pvt, sample, time);
}

class Ubx final : public Framer {
 public:
  Ubx() : Framer(kUbxMaxPayload + kOverhead) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_ubx(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    // An empty payload asks the receiver for the message.
    if (frame.size() == kOverhead) return Outcome::ignored();
    const Bytes payload = frame.subspan(kHeader, frame.size() - kOverhead);
    if (frame[2] == kClassNav && frame[3] == kUbxRelposned) return take_heading(frame, offset, sink);
    if (frame[2] != kClassNav || frame[3] != kIdPvt) {
      const auto reason = interference_.read(frame[2], frame[3], payload);
      return reason ? Outcome::refused(*reason) : Outcome::ignored();
    }
    GpsSample sample;
    DeviceTime time;
    if (const auto reason = read_nav_pvt(payload, sample, time)) return Outcome::refused(*reason);
    heading_.note(load_le<std::uint32_t>(payload, 0), time.utc_ns);
    interference_.stamp(sample);
    emit(sink, sample, time, offset, frame.size());
    return Outcome::used();
  }

 private:
  Outcome take_heading(Bytes frame, std::uint64_t offset, Sink& sink) {
    const auto found = heading_.read(frame.subspan(kHeader, frame.size() - kOverhead));
    if (!found) return Outcome::ignored();
    if (found->refused) return Outcome::refused(*found->refused);
    emit(sink, found->sample, found->time, offset, frame.size());
    return Outcome::used();
  }

  UbxInterference interference_;
  UbxHeading heading_;
};

}  // namespace

std::unique_ptr<Codec> make_ubx(const CodecOptions& /*options*/) {
  return std::make_unique<Ubx>();
}

}  // namespace fathom::codec
