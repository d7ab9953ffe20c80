#include "codec/imu/stim300.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "codec/crc32.hpp"
#include "codec/framer.hpp"

namespace fathom::codec {

namespace stim300 {
namespace {

constexpr std::size_t kTriad = 10;             // three numbers of three bytes, status
constexpr std::size_t kTemperatureTriad = 7;   // three numbers of two bytes, status
constexpr std::size_t kAuxiliary = 4;          // one number of three bytes, status
constexpr double kCountsPerDeg_s = 16'384.0;   // 2^14
constexpr double kCountsPerDeg = 2'097'152.0;  // 2^21
// Of accelerometers for 10 g: 2^19 and 2^22. Those of other ranges follow the full scale, in powers of 2.
constexpr double kCountsPerG = 524'288.0;
constexpr double kCountsPerM_s = 4'194'304.0;

/// Of the accelerometers' count against that of 10 g; unknown for a range that there is not.
double coarseness(double range_g) {
  constexpr std::array<std::array<double, 2>, 5> kOf{{{2, 0.25}, {5, 0.5}, {10, 1}, {30, 2}, {80, 8}}};
  for (const auto& [range, factor] : kOf) {
    if (range == range_g) return factor;
  }
  return kUnknown;
}

}  // namespace

std::size_t Triads::temperature_at() const {
  return kGyros + kTriad * (1U + (accelerometers ? 1U : 0U) + (inclinometers ? 1U : 0U));
}

std::size_t Triads::counter_at() const {
  return temperature_at() + kTemperatureTriad * temperatures + (auxiliary ? kAuxiliary : 0U);
}

std::optional<Triads> triads_of(std::uint8_t identifier) {
  Triads out;
  out.accelerometers = (identifier & 1U) != 0;
  out.inclinometers = (identifier & 2U) != 0;
  out.auxiliary = (identifier & 8U) != 0;
  const bool temperature = (identifier & 4U) != 0;
  const bool more = out.accelerometers || out.inclinometers;
  const std::size_t each = 1U + (out.accelerometers ? 1U : 0U) + (out.inclinometers ? 1U : 0U);
  switch (identifier & 0xF0U) {
    case 0x90U:  // of old units, where they hold more than gyros: they know the gyros' temperatures
      out.temperatures = temperature ? 1 : 0;
      return out;
    case 0xA0U:
      if (!temperature || !more) return std::nullopt;
      out.temperatures = each;
      return out;
    case 0xF0U:  // PPS in place of AUX
      if (out.auxiliary) return std::nullopt;
      out.auxiliary = true;
      out.temperatures = temperature ? each : 0;
      return out;
    default:
      return std::nullopt;
  }
}

double rate_unit_rad_s() {
  return kRadPerDeg / kCountsPerDeg_s;
}
double angle_unit_rad() {
  return kRadPerDeg / kCountsPerDeg;
}
double force_unit_m_s2(double range_g) {
  return coarseness(range_g) * kStandardGravity_m_s2 / kCountsPerG;
}
double velocity_unit_m_s(double range_g) {
  return coarseness(range_g) / kCountsPerM_s;
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  const std::size_t padded = (bytes.size() + 3) / 4 * 4;
  return crc32_mpeg2(bytes, padded - bytes.size());
}

}  // namespace stim300

namespace {

using stim300::Triads;
using StimVector = std::array<double, 3>;

constexpr std::size_t kMaxStimDatagram = 63;  // 0xAF, and 0xF7
constexpr std::size_t kStimCrc = 4;
constexpr DurationNs kStimTick_ns = 1'000;  // of the latency

// What a count of 24 bits can say as rate, and as acceleration: 1.6 times the accelerometers' range.
constexpr double kMaxStimRate_rad_s = 512.0 * kRadPerDeg;
constexpr double kStimCounts = 8'388'608.0;

/// Bytes of the datagram that the identifier begins, with CRC; 0 where it begins none.
std::size_t datagram_length(std::uint8_t identifier) {
  if (const auto triads = stim300::triads_of(identifier)) return triads->length();
  switch (identifier) {
    case 0xB1:  // part number
    case 0xB3:
    case 0xB5:  // serial number
    case 0xB7:
      return 20;
    case stim300::kConfiguration:
    case stim300::kConfigurationLine:
      return stim300::kConfigurationLength;
    case 0xBE:  // extended error information
    case 0xBF:
      return 21;
    case 0xD1:  // bias trim offsets
    case 0xD2:
      return 40;
    default:
      return 0;
  }
}

/// What the numbers mean.
struct Meaning {
  enum class Output : std::uint8_t { rate, increment, other };
  Output gyros = Output::rate;
  Output accelerometers = Output::rate;
  double range_g = 10.0;
  double interval_s = kUnknown;  ///< of increments

  [[nodiscard]] bool readable() const {
    if (gyros == Output::other || accelerometers == Output::other) return false;
    return known(interval_s) || (gyros == Output::rate && accelerometers == Output::rate);
  }
};

Meaning meaning_of(const Stim300Options& options) {
  Meaning out;
  out.range_g = options.accel_range_g;
  if (options.increments_hz > 0.0) {
    out.gyros = Meaning::Output::increment;
    out.accelerometers = Meaning::Output::increment;
    out.interval_s = 1.0 / options.increments_hz;
  }
  return out;
}

/// Output units 0 and 2 are sampled and averaged, 1 is incremental, the others are integrated.
Meaning::Output output_of(unsigned unit) {
  return unit == 0 || unit == 2 ? Meaning::Output::rate
         : unit == 1            ? Meaning::Output::increment
                                : Meaning::Output::other;
}

Meaning meaning_of(Bytes configuration) {
  constexpr unsigned kFastest = 4;  // 125 Hz, doubled so many times; above it the external trigger
  constexpr unsigned kDelayed =
      0xCU;  // either bit: the same units, the gyros delayed as the accelerometers are
  Meaning out;
  const unsigned rate = configuration[3] >> 5U;
  if (rate <= kFastest) out.interval_s = 1.0 / (125.0 * static_cast<double>(1U << rate));
  out.gyros = output_of(configuration[5] & 0xFU & ~kDelayed);
  out.accelerometers = output_of(configuration[8] & 0xFU);
  switch (configuration[17] >> 4U) {  // of x; a unit has one range
    case 0:
      out.range_g = 10.0;
      break;
    case 2:
      out.range_g = 2.0;
      break;
    case 3:
      out.range_g = 5.0;
      break;
    case 4:
      out.range_g = 30.0;
      break;
    case 6:
      out.range_g = 80.0;
      break;
    default:
      out.range_g = kUnknown;
  }
  return out;
}

/// Axes that the status of their triad calls good.
std::array<bool, 3> good_axes(unsigned status) {
  constexpr unsigned kAxes = 7;
  unsigned bad = status & kAxes;
  if ((status & (stim300::start_up | stim300::integrity_error)) != 0) bad = kAxes;
  if (bad == 0 && (status & (stim300::overload | stim300::channel_error)) != 0) bad = kAxes;
  return {(bad & 1U) == 0, (bad & 2U) == 0, (bad & 4U) == 0};
}

/// The triad of numbers in its unit; axes that are not good are unknown.
StimVector triad(Bytes datagram, std::size_t at, double unit) {
  const auto good = good_axes(datagram[at + 9]);
  StimVector out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t from = at + 3 * i;
    const int counts = load_be<std::int16_t>(datagram, from) * 256 + datagram[from + 2];
    out[i] = good[i] ? unit * counts : kUnknown;
  }
  return out;
}

/// Mean temperature of the gyros whose is good.
double gyro_temperature_degC(Bytes datagram, const Triads& triads) {
  if (triads.temperatures == 0) return kUnknown;
  const std::size_t at = triads.temperature_at();
  const auto good = good_axes(datagram[at + 6]);
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!good[i]) continue;
    sum += stim300::kTemperatureUnit_degC * load_be<std::int16_t>(datagram, at + 2 * i);
    ++count;
  }
  return count > 0 ? sum / count : kUnknown;
}

bool any_beyond(const StimVector& v, double most) {
  return std::any_of(v.begin(), v.end(), [&](double x) { return std::abs(x) > most; });
}

class Stim300 : public Framer {
 public:
  explicit Stim300(const Stim300Options& options)
      : Framer(kMaxStimDatagram, LineEnds::belong_to_frames), meaning_(meaning_of(options)) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    const std::size_t length = datagram_length(front[0]);
    if (length == 0) {
      const auto begins = [](std::uint8_t byte) { return datagram_length(byte) != 0; };
      const auto next = std::find_if(front.begin(), front.end(), begins);
      return Probe::skip(static_cast<std::size_t>(next - front.begin()));
    }
    if (front.size() < length) return Probe::need(length);
    const Bytes summed = front.first(length - kStimCrc);
    if (stim300::crc32(summed) != load_be<std::uint32_t>(front, summed.size()))
      return Probe::bad(RejectReason::checksum, length);
    return Probe::frame(length);
  }

  Outcome decode(Bytes datagram, std::uint64_t offset, Sink& sink) override {
    const auto triads = stim300::triads_of(datagram[0]);
    if (!triads) {
      const bool configuration =
          datagram[0] == stim300::kConfiguration || datagram[0] == stim300::kConfigurationLine;
      if (configuration) meaning_ = meaning_of(datagram);
      return Outcome::ignored();
    }
    if (!triads->accelerometers || !meaning_.readable()) return Outcome::ignored();
    const ImuSample sample = sample_of(datagram, *triads);
    if (any_beyond(sample.angular_rate_B_rad_s, kMaxStimRate_rad_s) ||
        any_beyond(sample.specific_force_B_m_s2, kStimCounts * stim300::force_unit_m_s2(meaning_.range_g)))
      return Outcome::refused(RejectReason::out_of_range);
    DeviceTime time;
    time.age_ns = load_be<std::uint16_t>(datagram, triads->latency_at()) * kStimTick_ns;
    emit(sink, sample, time, offset, datagram.size());
    return Outcome::used();
  }

  [[nodiscard]] ImuSample sample_of(Bytes datagram, const Triads& triads) const {
    using Output = Meaning::Output;
    ImuSample s;
    const bool angles = meaning_.gyros == Output::increment;
    const bool velocities = meaning_.accelerometers == Output::increment;
    const StimVector turn =
        triad(datagram, stim300::kGyros, angles ? stim300::angle_unit_rad() : stim300::rate_unit_rad_s());
    const StimVector push = triad(datagram, stim300::kAccelerometers,
                                  velocities ? stim300::velocity_unit_m_s(meaning_.range_g)
                                             : stim300::force_unit_m_s2(meaning_.range_g));
    if (angles && velocities) {
      s.delta_angle_B_rad = turn;
      s.delta_velocity_B_m_s = push;
      s.delta_time_s = meaning_.interval_s;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      s.angular_rate_B_rad_s[i] = angles ? turn[i] / meaning_.interval_s : turn[i];
      s.specific_force_B_m_s2[i] = velocities ? push[i] / meaning_.interval_s : push[i];
    }
    s.temperature_degC = gyro_temperature_degC(datagram, triads);
    return s;
  }

  Meaning meaning_;
};

}  // namespace

std::unique_ptr<Codec> make_stim300(const CodecOptions& options) {
  return std::make_unique<Stim300>(options.stim300);
}

}  // namespace fathom::codec
