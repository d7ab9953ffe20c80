#include "codec/imu/sbg.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "base/bytes/little_endian.hpp"
#include "base/unknown.hpp"
#include "codec/framer.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/inner_receiver.hpp"
#include "codec/imu/sbg_gnss.hpp"
#include "codec/wrapping_clock.hpp"

namespace fathom::codec {

std::uint16_t sbg::crc16(std::span<const std::uint8_t> bytes) {
  constexpr unsigned kPolynomial = 0x8408U;
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kPolynomial : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

namespace {

// Two synchronisation bytes, message, class, length; CRC and end.
constexpr std::size_t kSbgHeader = 6;
constexpr std::size_t kSbgTrailer = 3;
constexpr std::size_t kMaxSbgFrame = kSbgHeader + sbg::kMostData + kSbgTrailer;

// Logs only grow at their end.
constexpr std::size_t kUtcTimeData = 21;
constexpr std::size_t kImuDataData = 58;
constexpr std::size_t kImuShortData = 32;

// Beyond every unit of the family (2000 deg/s, 40 g).
constexpr double kMaxSbgRate_rad_s = 100.0;
constexpr double kMaxSbgForce_m_s2 = 1'000.0;
constexpr double kColdestSbg_degC = -100.0;
constexpr double kHottestSbg_degC = 200.0;

constexpr TimeNs kSbgTick_ns = 1'000;
constexpr DurationNs kUtcHolds_ns = 10 * kNsPerSecond;
constexpr DurationNs kShortHolds_ns = kNsPerSecond;
constexpr DurationNs kStampAgrees_ns = kNsPerSecond;

using SbgVector = std::array<double, 3>;

/// Axes that the status calls good.
std::array<bool, 3> good_sbg_axes(unsigned status, unsigned first_axis, unsigned in_range) {
  const unsigned all = sbg::link | sbg::self_test | in_range;
  const bool well = (status & all) == all;
  return {well && (status & first_axis) != 0, well && (status & first_axis << 1U) != 0,
          well && (status & first_axis << 2U) != 0};
}

/// Axes that are not good become unknown. Why the triad is refused; nothing when it is good.
std::optional<RejectReason> check_triad(SbgVector& values, const std::array<bool, 3>& good, double most) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!good[i]) {
      values[i] = kUnknown;
      continue;
    }
    if (!std::isfinite(values[i])) return RejectReason::field;
    if (std::abs(values[i]) > most) return RejectReason::out_of_range;
  }
  return std::nullopt;
}

std::optional<RejectReason> check_sample(ImuSample& s, unsigned status) {
  const auto accelerometers = good_sbg_axes(status, sbg::accelerometer_x, sbg::accelerometers_in_range);
  const auto gyros = good_sbg_axes(status, sbg::gyro_x, sbg::gyros_in_range);
  if (const auto why = check_triad(s.specific_force_B_m_s2, accelerometers, kMaxSbgForce_m_s2)) return why;
  if (const auto why = check_triad(s.angular_rate_B_rad_s, gyros, kMaxSbgRate_rad_s)) return why;
  if (!std::isfinite(s.temperature_degC)) return RejectReason::field;
  if (s.temperature_degC < kColdestSbg_degC || s.temperature_degC > kHottestSbg_degC)
    return RejectReason::out_of_range;
  return std::nullopt;
}

ImuSample sample_of_imu_data(Bytes data) {
  ImuSample s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.specific_force_B_m_s2[i] = load_le<float>(data, 6 + 4 * i);
    s.angular_rate_B_rad_s[i] = load_le<float>(data, 18 + 4 * i);
  }
  s.temperature_degC = load_le<float>(data, 30);
  return s;
}

ImuSample sample_of_imu_short(Bytes data, unsigned status) {
  const double rate_counts = (status & sbg::high_rate_scale) != 0 ? sbg::kHighRateCounts : sbg::kRateCounts;
  ImuSample s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.specific_force_B_m_s2[i] = load_le<std::int32_t>(data, 6 + 4 * i) / sbg::kForceCounts;
    s.angular_rate_B_rad_s[i] = load_le<std::int32_t>(data, 18 + 4 * i) / rate_counts;
  }
  s.temperature_degC = load_le<std::int16_t>(data, 30) / sbg::kTemperatureCounts;
  return s;
}

class Sbg : public Framer {
 public:
  Sbg() : Framer(kMaxSbgFrame) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (const auto other = seek_sync(front, sbg::kSync1, sbg::kSync2)) return *other;
    if (front.size() < kSbgHeader) return Probe::need(kSbgHeader);
    const std::size_t data = load_le<std::uint16_t>(front, 4);
    if (data > sbg::kMostData) return Probe::bad(RejectReason::length, kSbgHeader);
    const std::size_t length = kSbgHeader + data + kSbgTrailer;
    if (front.size() < length) return Probe::need(length);
    const std::size_t crc_at = length - kSbgTrailer;
    if (sbg::crc16(front.subspan(2, crc_at - 2)) != load_le<std::uint16_t>(front, crc_at))
      return Probe::bad(RejectReason::checksum, length);
    if (front[length - 1] != sbg::kEnd) return Probe::bad(RejectReason::structure, length);
    return Probe::frame(length);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    constexpr std::uint8_t kLogs = 0;
    if (frame[3] != kLogs) return Outcome::ignored();
    const Bytes data = frame.subspan(kSbgHeader, frame.size() - kSbgHeader - kSbgTrailer);
    switch (frame[2]) {
      case sbg::utc_time:
        return take_utc(data);
      case sbg::imu_data:
      case sbg::imu_short:
        return take_imu(frame, data, offset, sink);
      case sbg::gps1_position:
      case sbg::gps2_position:
        return take_position(frame, data, offset, sink);
      case sbg::gps1_velocity:
      case sbg::gps2_velocity:
        return take_velocity(frame, data, sink);
      case sbg::gps1_heading:
      case sbg::gps2_heading:
        return take_heading(frame, data, offset, sink);
      default:
        return Outcome::ignored();
    }
  }

  void flush(Sink& sink) override {
    for (FixEpochs& epochs : epochs_) epochs.finish(deliver_to(sink));
  }

  Outcome take_imu(Bytes frame, Bytes data, std::uint64_t offset, Sink& sink) {
    const bool is_short = frame[2] == sbg::imu_short;
    if (data.size() < (is_short ? kImuShortData : kImuDataData))
      return Outcome::refused(RejectReason::length);
    const unsigned status = load_le<std::uint16_t>(data, 4);
    ImuSample sample = is_short ? sample_of_imu_short(data, status) : sample_of_imu_data(data);
    if (const auto why = check_sample(sample, status)) return Outcome::refused(*why);
    DeviceTime time;
    time.clock_ns = clock_of(load_le<std::uint32_t>(data, 0));
    if (is_short) {
      short_at_ns_ = time.clock_ns;
    } else if (is_near(short_at_ns_, *time.clock_ns, kShortHolds_ns)) {
      return Outcome::ignored();
    }
    if (is_near(utc_at_ns_, *time.clock_ns, kUtcHolds_ns)) time.utc_ns = *time.clock_ns + utc_less_clock_ns_;
    emit(sink, sample, time, offset, frame.size());
    return Outcome::used();
  }

  Outcome take_position(Bytes frame, Bytes data, std::uint64_t offset, Sink& sink) {
    const bool of_second = frame[2] == sbg::gps2_position;
    sbg::Position got;
    if (const auto why = sbg::read_position(data, got)) return Outcome::refused(*why);
    if (!receiver_.takes(of_second)) return Outcome::ignored();
    if (!of_second) epochs_[1].finish(deliver_to(sink));
    DeviceTime time;
    time.clock_ns = clock_of(got.stamp_us);
    if (got.sample.fix != GpsFix::none) time.utc_ns = utc_of_week(got.time_of_week_ms, *time.clock_ns);
    epochs_[of_second ? 1 : 0].add(got.time_of_week_ms, {got.sample, time, offset, frame.size()},
                                   deliver_to(sink));
    return Outcome::used();
  }

  /// Without a position it is no sample.
  Outcome take_velocity(Bytes frame, Bytes data, Sink& sink) {
    const bool of_second = frame[2] == sbg::gps2_velocity;
    EpochVelocity got;
    if (const auto why = sbg::read_velocity(data, got)) return Outcome::refused(*why);
    if (of_second && receiver_.first_heard()) return Outcome::ignored();
    const bool joined = epochs_[of_second ? 1 : 0].add_part(FixWithVelocity::kVelocity, got.time_of_week_ms,
                                                            got, deliver_to(sink));
    return joined ? Outcome::used() : Outcome::ignored();
  }

  Outcome take_heading(Bytes frame, Bytes data, std::uint64_t offset, Sink& sink) {
    sbg::Heading got;
    if (const auto why = sbg::read_heading(data, got)) return Outcome::refused(*why);
    if (!heading_receiver_.takes(frame[2] == sbg::gps2_heading)) return Outcome::ignored();
    DeviceTime time;
    time.clock_ns = clock_of(got.stamp_us);
    if (known(got.sample.heading_rad)) time.utc_ns = utc_of_week(got.time_of_week_ms, *time.clock_ns);
    emit(sink, got.sample, time, offset, frame.size());
    return Outcome::used();
  }

  /// UTC of a time of the week, which UTC_TIME has told beside UTC, in the week of the unit's clock.
  [[nodiscard]] std::optional<TimeNs> utc_of_week(std::uint32_t time_of_week_ms, TimeNs clock_ns) const {
    if (!is_near(utc_at_ns_, clock_ns, kUtcHolds_ns)) return std::nullopt;
    const TimeNs by_clock_ns = clock_ns + utc_less_clock_ns_;
    const TimeNs in_its_week_ns = utc_less_week_ns_ + time_of_week_ms * kNsPerMillisecond;
    const DurationNs apart_ns = remainder_of(in_its_week_ns - by_clock_ns, kGpsWeek_ns);
    if (std::abs(apart_ns) > kStampAgrees_ns) return std::nullopt;
    return by_clock_ns + apart_ns;
  }

  /// What the unit's clock and the GPS week have to do with UTC.
  Outcome take_utc(Bytes data) {
    if (data.size() < kUtcTimeData) return Outcome::refused(RejectReason::length);
    const unsigned status = load_le<std::uint16_t>(data, 4);
    const bool valid =
        (status >> 1U & 0xFU) == sbg::kClockValid && (status >> 6U & 0xFU) == sbg::kUtcInitialized;
    CivilTime civil;
    civil.year = load_le<std::uint16_t>(data, 6);
    civil.month = data[8];
    civil.day = data[9];
    civil.hour = data[10];
    civil.minute = data[11];
    civil.second = data[12];
    civil.nanosecond = load_le<std::int32_t>(data, 13);
    constexpr int kLeapSecond = 60;
    if (!valid || civil.second == kLeapSecond) {
      if (!valid) utc_at_ns_.reset();
      return Outcome::ignored();
    }
    const bool fraction = civil.nanosecond >= 0 && civil.nanosecond < kNsPerSecond;
    const std::optional<TimeNs> utc_ns = fraction ? from_civil(civil) : std::nullopt;
    if (!utc_ns) return Outcome::refused(RejectReason::out_of_range);
    utc_at_ns_ = clock_of(load_le<std::uint32_t>(data, 0));
    utc_less_clock_ns_ = *utc_ns - *utc_at_ns_;
    // Whole milliseconds; below a second GPS time and UTC are the same.
    const DurationNs week_ns = load_le<std::uint32_t>(data, 17) * kNsPerMillisecond;
    utc_less_week_ns_ = *utc_ns - week_ns - remainder_of(civil.nanosecond - week_ns, kNsPerSecond);
    return Outcome::ignored();
  }

  TimeNs clock_of(std::uint32_t stamp_us) { return clock_us_.follow(stamp_us) * kSbgTick_ns; }

  static bool is_near(const std::optional<TimeNs>& one, TimeNs other, DurationNs most) {
    return one && std::abs(other - *one) <= most;
  }

  WrappingClock clock_us_;
  std::optional<TimeNs> short_at_ns_;  ///< of the last IMU_SHORT, on the unit's clock
  std::optional<TimeNs> utc_at_ns_;    ///< of the last UTC_TIME that was valid, on the unit's clock
  DurationNs utc_less_clock_ns_ = 0;
  DurationNs utc_less_week_ns_ = 0;  ///< UTC less the time of the GPS week
  FirstReceiver receiver_;
  FirstReceiver heading_receiver_;
  std::array<FixEpochs, 2> epochs_;  ///< of the first and the second receiver
};

}  // namespace

std::unique_ptr<Codec> make_sbg(const CodecOptions& /*options*/) {
  return std::make_unique<Sbg>();
}

}  // namespace fathom::codec
