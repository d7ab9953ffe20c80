#include "codec/satellite/ubx.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/satellite/ubx_interference.hpp"

namespace fathom::codec {
namespace {

constexpr std::size_t kHeader = 6;    // sync, class, id, length
constexpr std::size_t kOverhead = 8;  // header and checksum
constexpr std::uint8_t kClassNav = 0x01;
constexpr std::uint8_t kIdPvt = 0x07;
constexpr std::size_t kPvtLength = 92;
constexpr std::size_t kPvtLengthGeneration7 = 84;
constexpr double kMilli = 1e-3;

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

/// The fields of NAV-PVT that are used, in their units on the wire.
struct Pvt {
  explicit Pvt(Bytes p)
      : civil{.year = load_le<std::uint16_t>(p, 4),
              .month = p[6],
              .day = p[7],
              .hour = p[8],
              .minute = p[9],
              .second = p[10],
              .nanosecond = load_le<std::int32_t>(p, 16)},
        valid(p[11]),
        fix_type(p[20]),
        flags(p[21]),
        satellites(p[23]),
        longitude_deg(load_le<std::int32_t>(p, 24) * 1e-7),
        latitude_deg(load_le<std::int32_t>(p, 28) * 1e-7),
        height_m(load_le<std::int32_t>(p, 32) * kMilli),
        height_msl_m(load_le<std::int32_t>(p, 36) * kMilli),
        horizontal_accuracy_m(load_le<std::uint32_t>(p, 40) * kMilli),
        vertical_accuracy_m(load_le<std::uint32_t>(p, 44) * kMilli),
        velocity_N_m_s{load_le<std::int32_t>(p, 48) * kMilli, load_le<std::int32_t>(p, 52) * kMilli,
                       load_le<std::int32_t>(p, 56) * kMilli},
        course_deg(load_le<std::int32_t>(p, 64) * 1e-5),
        speed_accuracy_m_s(load_le<std::uint32_t>(p, 68) * kMilli),
        // Generation 7 has no such flag: there these bytes are reserved.
        position_invalid(p.size() >= kPvtLength && (p[78] & 1U) != 0) {}

  [[nodiscard]] bool fix_ok() const { return (flags & 1U) != 0; }
  [[nodiscard]] bool corrected() const { return (flags & 2U) != 0; }
  [[nodiscard]] unsigned carrier() const { return flags >> 6U; }
  [[nodiscard]] bool time_resolved() const { return (valid & 7U) == 7U; }

  CivilTime civil;
  std::uint8_t valid;
  std::uint8_t fix_type;
  std::uint8_t flags;
  std::uint8_t satellites;
  double longitude_deg;
  double latitude_deg;
  double height_m;
  double height_msl_m;
  double horizontal_accuracy_m;
  double vertical_accuracy_m;
  std::array<double, 3> velocity_N_m_s;
  double course_deg;
  double speed_accuracy_m_s;
  bool position_invalid;
};

GpsFix fix_of(const Pvt& pvt) {
  if (!pvt.fix_ok() || pvt.position_invalid) return GpsFix::none;
  switch (pvt.fix_type) {
    case 1:
      return GpsFix::dead_reckoning;
    case 2:
      return GpsFix::fix_2d;
    case 3:
    case 4:
      if (pvt.carrier() == 2) return GpsFix::rtk_fixed;
      if (pvt.carrier() == 1) return GpsFix::rtk_float;
      return pvt.corrected() ? GpsFix::differential : GpsFix::fix_3d;
    case 5:
      return GpsFix::time_only;
    default:
      return GpsFix::none;
  }
}

std::optional<RejectReason> read_pvt(Bytes payload, GpsSample& sample, DeviceTime& time) {
  if (payload.size() != kPvtLength && payload.size() != kPvtLengthGeneration7) return RejectReason::length;
  const Pvt pvt(payload);
  if (pvt.fix_type > 5 || pvt.carrier() > 2) return RejectReason::field;
  if (pvt.time_resolved()) {
    time.utc_ns = from_civil(pvt.civil);
    if (!time.utc_ns) return RejectReason::out_of_range;
  }
  sample.fix = fix_of(pvt);
  sample.satellites = pvt.satellites;
  if (sample.fix < GpsFix::dead_reckoning) return std::nullopt;
  if (std::abs(pvt.latitude_deg) > 90.0 || std::abs(pvt.longitude_deg) > 180.0) {
    return RejectReason::out_of_range;
  }
  sample.latitude_rad = pvt.latitude_deg * kRadPerDeg;
  sample.longitude_rad = pvt.longitude_deg * kRadPerDeg;
  sample.altitude_m = pvt.height_m;
  sample.altitude_msl_m = pvt.height_msl_m;
  const double axis_m = pvt.horizontal_accuracy_m / std::numbers::sqrt2;
  sample.position_sigma_N_m = {axis_m, axis_m, pvt.vertical_accuracy_m};
  sample.velocity_N_m_s = pvt.velocity_N_m_s;
  sample.velocity_sigma_N_m_s.fill(pvt.speed_accuracy_m_s);
  sample.course_rad = pvt.course_deg * kRadPerDeg;
  return std::nullopt;
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
    if (frame[2] != kClassNav || frame[3] != kIdPvt) {
      const auto reason = interference_.read(frame[2], frame[3], payload);
      return reason ? Outcome::refused(*reason) : Outcome::ignored();
    }
    GpsSample sample;
    DeviceTime time;
    if (const auto reason = read_pvt(payload, sample, time)) return Outcome::refused(*reason);
    interference_.stamp(sample);
    emit(sink, sample, time, offset, frame.size());
    return Outcome::used();
  }

 private:
  UbxInterference interference_;
};

}  // namespace

std::unique_ptr<Codec> make_ubx(const CodecOptions& /*options*/) {
  return std::make_unique<Ubx>();
}

}  // namespace fathom::codec
