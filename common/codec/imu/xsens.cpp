#include "codec/imu/xsens.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "base/bytes/big_endian.hpp"
#include "codec/framer.hpp"
#include "codec/satellite/pvt.hpp"
#include "codec/wrapping_clock.hpp"

namespace fathom::codec {

std::uint8_t xsens::checksum(std::span<const std::uint8_t> after_preamble) {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : after_preamble) sum = static_cast<std::uint8_t>(sum + byte);
  return static_cast<std::uint8_t>(0 - sum);
}

namespace {

using xsens::Item;

// Preamble, bus, message and length; its two bytes more where the data are longer than 254; checksum.
constexpr std::size_t kHeader = 4;
constexpr std::size_t kExtendedHeader = 6;
constexpr std::size_t kMaxData = 2048;
constexpr std::size_t kMaxMessage = kExtendedHeader + kMaxData + 1;

// Beyond every unit of the family (2000 deg/s, 20 g).
constexpr double kMaxXsensRate_rad_s = 50.0;
constexpr double kMaxXsensForce_m_s2 = 400.0;
constexpr double kMaxInterval_s = 1.0;
// A turn's quaternion has length 1 but for its rounding: 2^-21 in the coarsest format.
constexpr double kQuaternionTolerance = 1e-5;
constexpr double kColdest_degC = -100.0;
constexpr double kHottest_degC = 200.0;

constexpr unsigned kClipAccelBit = 8;  // of StatusWord: x, y, z of the accelerometer, then of the gyro
constexpr unsigned kClipGyroBit = 11;
constexpr std::uint8_t kUtcValid = 0x04;

constexpr double kDopUnit = 0.01;
constexpr std::uint16_t kNoDop = 9999;  // and beyond

using Vector3 = std::array<double, 3>;

/// What the receiver in the unit found.
struct XsensFix {
  std::optional<RejectReason> refused;
  GpsSample sample;
  DeviceTime time;
};

XsensFix read_gnss_pvt(Bytes data) {
  XsensFix fix;
  if (data.size() != xsens::kGnssPvtBytes) {
    fix.refused = RejectReason::structure;
    return fix;
  }
  Pvt pvt(data, std::endian::big);
  pvt.satellites = data[22];
  const auto dop = load_be<std::uint16_t>(data, 88);
  if (dop > 0 && dop < kNoDop) pvt.hdop = dop * kDopUnit;
  fix.refused = read_pvt(pvt, fix.sample, fix.time);
  return fix;
}

/// Numbers as the lowest two bits of an identifier say.
class Numbers {
 public:
  Numbers(std::uint16_t identifier, Bytes data) : format_(identifier & 3U), data_(data) {}

  [[nodiscard]] bool coarse() const { return format_ == kFixed12_20; }
  [[nodiscard]] bool are(std::size_t count) const { return data_.size() == count * size(); }
  [[nodiscard]] double at(std::size_t i) const {
    const std::size_t from = i * size();
    switch (format_) {
      case kFloat:
        return load_be<float>(data_, from);
      case kFixed12_20:
        return load_be<std::int32_t>(data_, from) / 1'048'576.0;
      case kFixed16_32:  // the fraction comes first
        return load_be<std::int16_t>(data_, from + 4) + load_be<std::uint32_t>(data_, from) / 4'294'967'296.0;
      default:
        return load_be<double>(data_, from);
    }
  }

 private:
  static constexpr unsigned kFloat = 0;
  static constexpr unsigned kFixed12_20 = 1;
  static constexpr unsigned kFixed16_32 = 2;
  [[nodiscard]] std::size_t size() const {
    constexpr std::array<std::size_t, 4> kSizes{4, 4, 6, 8};
    return kSizes[format_];
  }
  unsigned format_;
  Bytes data_;
};

/// What one MTData2 message has, in the axes of the unit.
struct Contents {
  std::optional<Vector3> rate_S_rad_s, rate_hr_S_rad_s;
  std::optional<Vector3> force_S_m_s2, force_hr_S_m_s2;
  std::optional<Vector3> turn_S_rad, delta_v_S_m_s;
  std::optional<double> temperature_degC;
  std::optional<std::uint32_t> fine_ticks;
  std::optional<std::uint16_t> counter;
  std::optional<TimeNs> utc_ns;
  std::optional<XsensFix> fix;
  std::optional<RejectReason> refused;  ///< why the inertial part is, the first reason
  std::uint32_t status = 0;
  bool coarse_turn = false;  ///< in steps of 2^-20, which are 40 deg/h at 100 Hz

  [[nodiscard]] const std::optional<Vector3>& rate() const {
    return rate_hr_S_rad_s ? rate_hr_S_rad_s : rate_S_rad_s;
  }
  [[nodiscard]] const std::optional<Vector3>& force() const {
    return force_hr_S_m_s2 ? force_hr_S_m_s2 : force_S_m_s2;
  }
  [[nodiscard]] bool has_increments() const {
    return turn_S_rad && delta_v_S_m_s && !(coarse_turn && rate());
  }

  void take(std::uint16_t identifier, Bytes data);

 private:
  /// Why the item is refused; nothing when it is good or one that nobody reads.
  [[nodiscard]] std::optional<RejectReason> take_inertial(std::uint16_t identifier, Bytes data);
  static std::optional<RejectReason> take3(const Numbers& numbers, double most, std::optional<Vector3>& into);
  std::optional<RejectReason> take_turn(const Numbers& numbers);
  std::optional<RejectReason> take_utc(Bytes data);
};

std::optional<RejectReason> Contents::take3(const Numbers& numbers, double most,
                                            std::optional<Vector3>& into) {
  if (!numbers.are(3)) return RejectReason::structure;
  const Vector3 v{numbers.at(0), numbers.at(1), numbers.at(2)};
  for (const double x : v) {
    if (!std::isfinite(x)) return RejectReason::field;
    if (std::abs(x) > most) return RejectReason::out_of_range;
  }
  into = v;
  return std::nullopt;
}

std::optional<RejectReason> Contents::take_turn(const Numbers& numbers) {
  if (!numbers.are(4)) return RejectReason::structure;
  const double w = numbers.at(0);
  const Vector3 v{numbers.at(1), numbers.at(2), numbers.at(3)};
  const double sine = std::hypot(v[0], v[1], v[2]);
  const double length = std::hypot(w, sine);
  if (!std::isfinite(length)) return RejectReason::field;
  if (std::abs(length - 1.0) > kQuaternionTolerance) return RejectReason::out_of_range;
  // The shorter of the two ways; both quaternions mean it.
  const double angle = 2.0 * std::atan2(sine, std::abs(w));
  const double factor = (w < 0.0 ? -1.0 : 1.0) * (sine > 0.0 ? angle / sine : 2.0);
  coarse_turn = numbers.coarse();
  turn_S_rad = {factor * v[0], factor * v[1], factor * v[2]};
  return std::nullopt;
}

std::optional<RejectReason> Contents::take_utc(Bytes data) {
  if (data.size() != 12) return RejectReason::structure;
  if ((data[11] & kUtcValid) == 0) return std::nullopt;
  CivilTime civil;
  const auto nanosecond = load_be<std::uint32_t>(data, 0);
  if (nanosecond >= static_cast<std::uint32_t>(kNsPerSecond)) return RejectReason::out_of_range;
  civil.nanosecond = static_cast<int>(nanosecond);
  civil.year = load_be<std::uint16_t>(data, 4);
  civil.month = data[6];
  civil.day = data[7];
  civil.hour = data[8];
  civil.minute = data[9];
  civil.second = data[10];
  utc_ns = from_civil(civil);
  return utc_ns ? std::nullopt : std::optional(RejectReason::out_of_range);
}

void Contents::take(std::uint16_t identifier, Bytes data) {
  if ((identifier & 0xFFF0U) == Item::gnss_pvt) {
    fix = read_gnss_pvt(data);
  } else if (const auto reason = take_inertial(identifier, data); reason && !refused) {
    refused = reason;
  }
}

std::optional<RejectReason> Contents::take_inertial(std::uint16_t identifier, Bytes data) {
  const Numbers numbers(identifier, data);
  switch (static_cast<Item>(identifier & 0xFFF0U)) {
    case Item::rate_of_turn:
      return take3(numbers, kMaxXsensRate_rad_s, rate_S_rad_s);
    case Item::rate_of_turn_hr:
      return take3(numbers, kMaxXsensRate_rad_s, rate_hr_S_rad_s);
    case Item::acceleration:
      return take3(numbers, kMaxXsensForce_m_s2, force_S_m_s2);
    case Item::acceleration_hr:
      return take3(numbers, kMaxXsensForce_m_s2, force_hr_S_m_s2);
    case Item::delta_v:
      return take3(numbers, kMaxXsensForce_m_s2 * kMaxInterval_s, delta_v_S_m_s);
    case Item::delta_q:
      return take_turn(numbers);
    case Item::utc_time:
      return take_utc(data);
    case Item::temperature:
      if (!numbers.are(1)) return RejectReason::structure;
      temperature_degC = numbers.at(0);
      if (!std::isfinite(*temperature_degC)) return RejectReason::field;
      return *temperature_degC > kColdest_degC && *temperature_degC < kHottest_degC
                 ? std::nullopt
                 : std::optional(RejectReason::out_of_range);
    case Item::packet_counter:
      if (data.size() != 2) return RejectReason::structure;
      counter = load_be<std::uint16_t>(data, 0);
      return std::nullopt;
    case Item::sample_time_fine:
      if (data.size() != 4) return RejectReason::structure;
      fine_ticks = load_be<std::uint32_t>(data, 0);
      return std::nullopt;
    case Item::status_word:
      if (data.size() != 4) return RejectReason::structure;
      status = load_be<std::uint32_t>(data, 0);
      return std::nullopt;
    case Item::gnss_pvt:
      break;  // is no inertial one
  }
  return std::nullopt;
}

/// Forward, left, up into forward, right, down; axes that were clipped are unknown.
Vector3 frd_of(const Vector3& v_S, std::uint32_t status, unsigned first_clip_bit) {
  Vector3 out{v_S[0], -v_S[1], -v_S[2]};
  for (unsigned i = 0; i < 3; ++i) {
    if ((status >> (first_clip_bit + i) & 1U) != 0) out[i] = kUnknown;
  }
  return out;
}

class Xsens : public Framer {
 public:
  Xsens() : Framer(kMaxMessage) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (const auto other = seek_sync(front, xsens::kPreamble, xsens::kMaster)) return *other;
    if (front.size() < kHeader) return Probe::need(kHeader);
    std::size_t header = kHeader;
    std::size_t data = front[3];
    if (front[3] == xsens::kExtendedLength) {
      header = kExtendedHeader;
      if (front.size() < header) return Probe::need(header);
      data = load_be<std::uint16_t>(front, kHeader);
      if (data > kMaxData) return Probe::bad(RejectReason::length, header);
    }
    const std::size_t length = header + data + 1;
    if (front.size() < length) return Probe::need(length);
    if (xsens::checksum(front.subspan(1, length - 2)) != front[length - 1]) {
      return Probe::bad(RejectReason::checksum, length);
    }
    return Probe::frame(length);
  }

  Outcome decode(Bytes message, std::uint64_t offset, Sink& sink) override {
    if (message[2] != xsens::kMtData2) return Outcome::ignored();
    const std::size_t header = message[3] == xsens::kExtendedLength ? kExtendedHeader : kHeader;
    Bytes items = message.subspan(header, message.size() - header - 1);
    Contents got;
    while (!items.empty()) {
      if (items.size() < 3 || items.size() - 3 < items[2]) return Outcome::refused(RejectReason::structure);
      const std::size_t size = items[2];
      got.take(load_be<std::uint16_t>(items, 0), items.subspan(3, size));
      items = items.subspan(3 + size);
    }
    const bool inertial = !got.refused && emit_inertial(got, message, offset, sink);
    if (got.fix && (!got.fix->refused || inertial)) {
      // Beside rates and forces that are good an impossible fix is none, so that it does not pass unseen.
      emit(sink, got.fix->refused ? GpsSample{} : got.fix->sample, got.fix->time, offset, message.size());
      return Outcome::used();
    }
    if (inertial) return Outcome::used();
    if (got.refused) return Outcome::refused(*got.refused);
    return got.fix ? Outcome::refused(*got.fix->refused) : Outcome::ignored();
  }

  /// Whether there was a sample.
  bool emit_inertial(const Contents& got, Bytes message, std::uint64_t offset, Sink& sink) {
    const std::optional<double> interval_s = count(got);
    const std::optional<ImuSample> sample = sample_of(got, interval_s);
    if (!sample) return false;
    DeviceTime time;
    time.utc_ns = got.utc_ns;
    if (got.fine_ticks) time.clock_ns = clock_ticks_.last() * static_cast<TimeNs>(xsens::kTick_ns);
    emit(sink, *sample, time, offset, message.size());
    return true;
  }

  /// Follows counter and clock. The interval of the message's increments, where it is known.
  std::optional<double> count(const Contents& got) {
    const bool follows = got.counter && counter_ && *got.counter == static_cast<std::uint16_t>(*counter_ + 1);
    counter_ = got.counter;
    if (!follows) increments_until_.reset();
    if (got.fine_ticks) clock_ticks_.follow(*got.fine_ticks);
    if (!got.has_increments()) return std::nullopt;
    const std::optional<std::int64_t> since = increments_until_;
    increments_until_ = got.fine_ticks ? std::optional(clock_ticks_.last()) : std::nullopt;
    if (!since || !increments_until_) return std::nullopt;
    const double interval_s = static_cast<double>(clock_ticks_.last() - *since) * (1e-9 * xsens::kTick_ns);
    return interval_s > 0.0 && interval_s <= kMaxInterval_s ? std::optional(interval_s) : std::nullopt;
  }

  static std::optional<ImuSample> sample_of(const Contents& got, std::optional<double> interval_s) {
    std::optional<Vector3> rate_S = got.rate();
    std::optional<Vector3> force_S = got.force();
    ImuSample s;
    if (interval_s) {
      s.delta_time_s = *interval_s;
      s.delta_angle_B_rad = frd_of(*got.turn_S_rad, got.status, kClipGyroBit);
      s.delta_velocity_B_m_s = frd_of(*got.delta_v_S_m_s, got.status, kClipAccelBit);
      const auto over_interval = [&](Vector3 v) {
        for (double& x : v) x /= *interval_s;
        return v;
      };
      if (!rate_S) rate_S = over_interval(*got.turn_S_rad);
      if (!force_S) force_S = over_interval(*got.delta_v_S_m_s);
    }
    if (!rate_S || !force_S) return std::nullopt;
    s.angular_rate_B_rad_s = frd_of(*rate_S, got.status, kClipGyroBit);
    s.specific_force_B_m_s2 = frd_of(*force_S, got.status, kClipAccelBit);
    if (got.temperature_degC) s.temperature_degC = *got.temperature_degC;
    return s;
  }

  std::optional<std::uint16_t> counter_;          ///< of the message before
  std::optional<std::int64_t> increments_until_;  ///< on its clock; nothing after a message was lost
  WrappingClock clock_ticks_;                     ///< SampleTimeFine
};

}  // namespace

std::unique_ptr<Codec> make_xsens(const CodecOptions& /*options*/) {
  return std::make_unique<Xsens>();
}

}  // namespace fathom::codec
