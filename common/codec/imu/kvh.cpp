#include "codec/imu/kvh.hpp"

#include <array>
#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "codec/byte_sum.hpp"
#include "codec/crc32.hpp"
#include "codec/framer.hpp"
#include "codec/wrapping_clock.hpp"

namespace fathom::codec {

double kvh::rotation_unit_rad_s(const KvhOptions& options) {
  const double angle = options.degrees ? kRadPerDeg : 1.0;
  return options.increments_hz > 0.0 ? angle * options.increments_hz : angle;
}

double kvh::to_degC(double reading, KvhTemperature unit) {
  const bool hundredths = unit == KvhTemperature::celsius_100 || unit == KvhTemperature::fahrenheit_100;
  const bool fahrenheit = unit == KvhTemperature::fahrenheit || unit == KvhTemperature::fahrenheit_100;
  const double degrees = hundredths ? reading / 100.0 : reading;
  return fahrenheit ? (degrees - 32.0) / 1.8 : degrees;
}

double kvh::from_degC(double temperature_degC, KvhTemperature unit) {
  const double zero = to_degC(0.0, unit);
  return (temperature_degC - zero) / (to_degC(1.0, unit) - zero);
}

namespace {

using KvhVector = std::array<double, 3>;

constexpr std::size_t kKvhHeader = 4;
constexpr std::size_t kKvhCrc = 4;
constexpr std::size_t kMaxKvhMessage = 40;  // format B
constexpr std::size_t kShortKvhTest = 11;
constexpr std::size_t kLongKvhTest = 13;
constexpr unsigned kKvhZeroBits = 0x88;  // of the status

// Beyond every unit of the family (490 deg/s, 30 g).
constexpr double kMaxKvhRate_rad_s = 1'000.0 * kRadPerDeg;
constexpr double kMaxKvhForce_m_s2 = 50.0 * kStandardGravity_m_s2;
constexpr TimeNs kKvhTick_ns = 1'000;
constexpr double kColdestKvh_degC = -100.0;
constexpr double kHottestKvh_degC = 200.0;

/// Bytes of the message that the header begins, with CRC or sum; 0 where it begins none.
std::size_t kvh_length(Bytes header) {
  if (header[2] == kvh::kTest) {
    if (header[3] == kvh::kShortTest) return kShortKvhTest;
    return header[3] == kvh::kLongTest ? kLongKvhTest : 0;
  }
  if (header[2] != kvh::kData) return 0;
  switch (static_cast<kvh::Format>(header[3])) {
    case kvh::Format::a:
      return 36;
    case kvh::Format::b:
      return kMaxKvhMessage;
    case kvh::Format::c:
      return 38;
  }
  return 0;
}

bool kvh_intact(Bytes message) {
  if (message[2] == kvh::kTest) {
    const Bytes summed = message.first(message.size() - 1);
    return static_cast<std::uint8_t>(byte_sum(summed)) == message.back();
  }
  const Bytes summed = message.first(message.size() - kKvhCrc);
  return crc32_mpeg2(summed) == load_be<std::uint32_t>(message, summed.size());
}

/// False for what is no number, too.
bool within(const KvhVector& v, unsigned valid, double most) {
  for (unsigned i = 0; i < 3; ++i) {
    if ((valid >> i & 1U) != 0 && !(std::abs(v[i]) <= most)) return false;
  }
  return true;
}

class Kvh : public Framer {
 public:
  explicit Kvh(const KvhOptions& options) : Framer(kMaxKvhMessage), options_(options) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (const auto sought = seek_sync(front, kvh::kFirst, kvh::kSecond)) return *sought;
    if (front.size() < kKvhHeader) return Probe::maybe();
    const std::size_t length = kvh_length(front);
    if (length == 0) return Probe::skip(1);
    if (front.size() < length) return Probe::need(length);
    if (!kvh_intact(front.first(length))) return Probe::bad(RejectReason::checksum, length);
    return Probe::frame(length);
  }

  Outcome decode(Bytes message, std::uint64_t offset, Sink& sink) override {
    if (message[2] == kvh::kTest) return Outcome::ignored();
    const auto format = static_cast<kvh::Format>(message[3]);
    const std::size_t status_at = kvh::kRest + (format == kvh::Format::a ? 0 : 4);
    const unsigned status = message[status_at];
    const std::uint8_t sequence = message[status_at + 1];
    if ((status & kKvhZeroBits) != 0 || sequence >= kvh::kSequences)
      return Outcome::refused(RejectReason::structure);

    ImuSample s;
    s.angular_rate_B_rad_s = triad(message, kvh::kRotation, kvh::rotation_unit_rad_s(options_), status);
    s.specific_force_B_m_s2 =
        triad(message, kvh::kAcceleration, kStandardGravity_m_s2, status >> kvh::kFirstAccelerometer);
    s.temperature_degC = temperature(message, format, status_at);
    if (!within(s.angular_rate_B_rad_s, status, kMaxKvhRate_rad_s) ||
        !within(s.specific_force_B_m_s2, status >> kvh::kFirstAccelerometer, kMaxKvhForce_m_s2))
      return Outcome::refused(RejectReason::out_of_range);
    DeviceTime time;
    if (format == kvh::Format::b)
      time.clock_ns = clock_us_.follow(load_be<std::uint32_t>(message, kvh::kRest)) * kKvhTick_ns;
    emit(sink, s, time, offset, message.size());
    return Outcome::used();
  }

  /// Three numbers in their unit; axes that `valid` does not call so, from bit 0 on, are unknown.
  [[nodiscard]] static KvhVector triad(Bytes message, std::size_t at, double unit, unsigned valid) {
    KvhVector out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = (valid >> i & 1U) != 0 ? unit * load_be<float>(message, at + 4 * i) : kUnknown;
    return out;
  }

  /// Unknown where the message has none, and where it cannot be: it is no reason to lose the rest.
  [[nodiscard]] double temperature(Bytes message, kvh::Format format, std::size_t status_at) const {
    if (!kvh::has_temperature(format, message[status_at + 1])) return kUnknown;
    const double reading = format == kvh::Format::c ? load_be<float>(message, kvh::kRest)
                                                    : load_be<std::int16_t>(message, status_at + 2);
    const double degC = kvh::to_degC(reading, options_.temperature);
    return degC >= kColdestKvh_degC && degC <= kHottestKvh_degC ? degC : kUnknown;
  }

  KvhOptions options_;
  WrappingClock clock_us_;
};

}  // namespace

std::unique_ptr<Codec> make_kvh(const CodecOptions& options) {
  return std::make_unique<Kvh>(options.kvh);
}

}  // namespace fathom::codec
