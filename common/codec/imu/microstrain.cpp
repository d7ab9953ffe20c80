#include "codec/imu/microstrain.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/framer.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/inner_receiver.hpp"
#include "codec/imu/microstrain_gnss.hpp"

namespace fathom::codec {

namespace {

using microstrain::Field;
using microstrain::GnssData;
using microstrain::GpsTime;

// Sync, descriptor set and length of the fields; at the end two bytes of checksum. A field begins with its
// length, which counts these two bytes, and its descriptor.
constexpr std::size_t kMipHeader = 4;
constexpr std::size_t kMipChecksum = 2;
constexpr std::size_t kMipFieldHeader = 2;
constexpr std::size_t kMaxMipPacket = kMipHeader + 255 + kMipChecksum;

// Beyond every unit of the family (900 deg/s, 40 g).
constexpr double kMaxMipRate_rad_s = 50.0;
constexpr double kMaxMipForce_m_s2 = 1000.0;
constexpr double kMaxMipInterval_s = 1.0;

constexpr unsigned kAccelOverrangeBit = 0;  // x, y, z of the accelerometer, then of the gyro
constexpr unsigned kGyroOverrangeBit = 4;

using Triad = std::array<double, 3>;

bool is_valid_sensor(std::uint16_t flags) {
  constexpr unsigned kPulseAndTimeSet = 0x0005;
  constexpr unsigned kTimeOfWeekAndWeek = 0x0018;  // older units have neither of them
  const unsigned parts = flags & kTimeOfWeekAndWeek;
  return (flags & kPulseAndTimeSet) == kPulseAndTimeSet && (parts == 0 || parts == kTimeOfWeekAndWeek);
}

/// What one packet of sensor data has.
struct SensorData {
  std::optional<Triad> rate_B_rad_s, force_B_m_s2;
  std::optional<Triad> turn_B_rad, delta_v_B_m_s;
  std::optional<GpsTime> sensor_gps, shared_gps;
  std::optional<DurationNs> reference_ns;
  std::optional<double> reference_delta_s, delta_s;
  std::uint16_t overrange = 0;
  std::uint8_t event = 0;  ///< 0: as scheduled

  [[nodiscard]] bool has_increments() const { return turn_B_rad && delta_v_B_m_s; }
  [[nodiscard]] const std::optional<GpsTime>& gps() const { return shared_gps ? shared_gps : sensor_gps; }
  [[nodiscard]] bool has_deltas() const { return reference_delta_s || delta_s; }

  /// Why the field is refused; nothing when it is good or one that nobody reads.
  [[nodiscard]] std::optional<RejectReason> take(std::uint8_t descriptor, Bytes data);

 private:
  static std::optional<RejectReason> take3(Bytes data, double unit, double most, std::optional<Triad>& into);
  std::optional<RejectReason> take_delta(Bytes data);
};

std::optional<RejectReason> SensorData::take3(Bytes data, double unit, double most,
                                              std::optional<Triad>& into) {
  if (data.size() != 12) return RejectReason::structure;
  Triad v{};
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = unit * load_be<float>(data, 4 * i);
    if (!std::isfinite(v[i])) return RejectReason::field;
    if (std::abs(v[i]) > most) return RejectReason::out_of_range;
  }
  into = v;
  return std::nullopt;
}

/// In the time of the synchronized clock, which jumps when it is set, and then there is no interval.
std::optional<RejectReason> SensorData::take_delta(Bytes data) {
  if (data.size() != 8) return RejectReason::structure;
  const auto seconds = load_be<double>(data, 0);
  if (!std::isfinite(seconds)) return RejectReason::field;
  delta_s = seconds;
  return std::nullopt;
}

std::optional<RejectReason> SensorData::take(std::uint8_t descriptor, Bytes data) {
  constexpr double kG = kStandardGravity_m_s2;
  switch (static_cast<Field>(descriptor)) {
    case Field::scaled_accel:
      return take3(data, kG, kMaxMipForce_m_s2, force_B_m_s2);
    case Field::scaled_gyro:
      return take3(data, 1.0, kMaxMipRate_rad_s, rate_B_rad_s);
    case Field::delta_theta:
      return take3(data, 1.0, kMaxMipRate_rad_s * kMaxMipInterval_s, turn_B_rad);
    case Field::delta_velocity:
      return take3(data, kG, kMaxMipForce_m_s2 * kMaxMipInterval_s, delta_v_B_m_s);
    case Field::gps_timestamp:
      return microstrain::read_gps_time(data, is_valid_sensor, sensor_gps);
    case Field::shared_gps_timestamp:
      return microstrain::read_gps_time(data, microstrain::week_and_time_valid, shared_gps);
    case Field::delta_time:
      return take_delta(data);
    case Field::overrange_status:
      if (data.size() != 2) return RejectReason::structure;
      overrange = load_be<std::uint16_t>(data, 0);
      return std::nullopt;
    case Field::event_source:
      if (data.size() != 1) return RejectReason::structure;
      event = data[0];
      return std::nullopt;
    case Field::reference_time:
    case Field::reference_time_delta: {
      if (data.size() != 8) return RejectReason::structure;
      const auto ns = load_be<std::uint64_t>(data, 0);
      if (ns >= 1ULL << 62) return RejectReason::out_of_range;
      if (descriptor == Field::reference_time) {
        reference_ns = static_cast<DurationNs>(ns);
      } else {
        reference_delta_s = to_seconds(static_cast<DurationNs>(ns));
      }
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Increments come at a steady rate.
class SteadyInterval {
 public:
  /// Whether it is like the shortest of those before.
  bool agrees(double interval_s) {
    const auto end = last_s_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, last_s_.size()));
    const auto shortest_s = std::min_element(last_s_.begin(), end);
    const bool like = shortest_s != end && std::abs(interval_s - *shortest_s) <= 0.1 * *shortest_s;
    last_s_[count_++ % last_s_.size()] = interval_s;
    return like;
  }

 private:
  std::array<double, 8> last_s_{};
  std::size_t count_ = 0;
};

Triad in_range(Triad v, std::uint16_t overrange, unsigned first_bit) {
  for (unsigned i = 0; i < 3; ++i) {
    if ((static_cast<unsigned>(overrange) >> (first_bit + i) & 1U) != 0) v[i] = kUnknown;
  }
  return v;
}

Triad over(Triad increment, double interval_s) {
  for (double& x : increment) x /= interval_s;
  return increment;
}

class MicroStrain : public Framer {
 public:
  MicroStrain() : Framer(kMaxMipPacket) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    constexpr auto kSync = microstrain::kSync;
    if (const auto other = seek_sync(front, kSync[0], kSync[1])) return *other;
    if (front.size() < kMipHeader) return Probe::need(kMipHeader);
    const std::size_t summed = kMipHeader + front[3];
    const std::size_t length = summed + kMipChecksum;
    if (front.size() < length) return Probe::need(length);
    const auto sum = fletcher8(front.first(summed));
    if (!std::equal(sum.begin(), sum.end(), front.begin() + static_cast<std::ptrdiff_t>(summed))) {
      return Probe::bad(RejectReason::checksum, length);
    }
    return Probe::frame(length);
  }

  Outcome decode(Bytes packet, std::uint64_t offset, Sink& sink) override {
    switch (packet[2]) {
      case microstrain::kSensorData:
        return decode_sensor(packet, offset, sink);
      case microstrain::kGnss:
      case microstrain::kGnss1:
      case microstrain::kGnss2:
        return decode_gnss(packet, offset, sink);
      default:
        return Outcome::ignored();
    }
  }

  template <class Data>
  static std::optional<RejectReason> read_fields(Bytes packet, Data& into) {
    Bytes fields = packet.subspan(kMipHeader, packet.size() - kMipHeader - kMipChecksum);
    while (!fields.empty()) {
      const std::size_t size = fields[0];
      if (size < kMipFieldHeader || size > fields.size()) return RejectReason::structure;
      if (const auto reason = into.take(fields[1], fields.subspan(kMipFieldHeader, size - kMipFieldHeader)))
        return reason;
      fields = fields.subspan(size);
    }
    return std::nullopt;
  }

  Outcome decode_gnss(Bytes packet, std::uint64_t offset, Sink& sink) {
    GnssData got;
    if (const auto reason = read_fields(packet, got)) return Outcome::refused(*reason);
    if (!got.scheduled() || !got.has_position()) return Outcome::ignored();
    if (!receiver_.takes(packet[2] == microstrain::kGnss2)) return Outcome::ignored();
    emit(sink, got.sample(), got.time(), offset, packet.size());
    return Outcome::used();
  }

  Outcome decode_sensor(Bytes packet, std::uint64_t offset, Sink& sink) {
    SensorData got;
    if (const auto reason = read_fields(packet, got)) return Outcome::refused(*reason);
    if (got.event != 0) return Outcome::ignored();
    DeviceTime time;
    time.clock_ns = clock_of(got);
    if (got.gps() && got.gps()->valid) time.utc_ns = utc_of_gps(got.gps()->since_epoch_ns);
    const std::optional<ImuSample> sample = sample_of(got, interval_of(got, time.clock_ns));
    if (!sample) return Outcome::ignored();
    emit(sink, *sample, time, offset, packet.size());
    return Outcome::used();
  }

  /// One clock for all packets: where a unit has a reference time, its GPS time is not mixed with it.
  std::optional<TimeNs> clock_of(const SensorData& got) {
    has_reference_ = has_reference_ || got.reference_ns;
    if (has_reference_) return got.reference_ns;
    return got.gps() ? std::optional(got.gps()->since_epoch_ns) : std::nullopt;
  }

  /// Of the packet's increments, where it is known.
  std::optional<double> interval_of(const SensorData& got, std::optional<TimeNs> clock_ns) {
    if (!got.has_increments()) {
      others_have_deltas_ = others_have_deltas_ || got.has_deltas();
      return std::nullopt;
    }
    const bool first = !had_increments_;
    const std::optional<TimeNs> before_ns = increments_until_ns_;
    had_increments_ = true;
    increments_until_ns_ = clock_ns;
    if (got.reference_delta_s && !others_have_deltas_) {
      const double interval_s = *got.reference_delta_s;
      return !first && possible(interval_s) ? std::optional(interval_s) : std::nullopt;
    }
    double interval_s = kUnknown;
    if (got.delta_s && !others_have_deltas_) {
      interval_s = *got.delta_s;
    } else if (before_ns && clock_ns) {
      interval_s = to_seconds(*clock_ns - *before_ns);
    }
    return possible(interval_s) && steady_.agrees(interval_s) ? std::optional(interval_s) : std::nullopt;
  }
  static bool possible(double interval_s) { return interval_s > 0.0 && interval_s <= kMaxMipInterval_s; }

  static std::optional<ImuSample> sample_of(const SensorData& got, std::optional<double> interval_s) {
    std::optional<Triad> rate_B_rad_s = got.rate_B_rad_s;
    std::optional<Triad> force_B_m_s2 = got.force_B_m_s2;
    ImuSample s;
    if (interval_s) {
      s.delta_time_s = *interval_s;
      s.delta_angle_B_rad = in_range(*got.turn_B_rad, got.overrange, kGyroOverrangeBit);
      s.delta_velocity_B_m_s = in_range(*got.delta_v_B_m_s, got.overrange, kAccelOverrangeBit);
      if (!rate_B_rad_s) rate_B_rad_s = over(*got.turn_B_rad, *interval_s);
      if (!force_B_m_s2) force_B_m_s2 = over(*got.delta_v_B_m_s, *interval_s);
    }
    if (!rate_B_rad_s || !force_B_m_s2) return std::nullopt;
    s.angular_rate_B_rad_s = in_range(*rate_B_rad_s, got.overrange, kGyroOverrangeBit);
    s.specific_force_B_m_s2 = in_range(*force_B_m_s2, got.overrange, kAccelOverrangeBit);
    return s;
  }

  FirstReceiver receiver_;
  bool has_reference_ = false;
  /// Packets without increments have them as well: a delta is not all of the interval.
  bool others_have_deltas_ = false;
  bool had_increments_ = false;
  std::optional<TimeNs> increments_until_ns_;  ///< on the unit's clock
  SteadyInterval steady_;
};

}  // namespace

std::unique_ptr<Codec> make_microstrain(const CodecOptions& /*options*/) {
  return std::make_unique<MicroStrain>();
}

}  // namespace fathom::codec
