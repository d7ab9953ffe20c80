#include "codec/imu/vectornav.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/crc16.hpp"
#include "codec/framer.hpp"
#include "codec/gps_time.hpp"
#include "codec/imu/known3.hpp"
#include "codec/imu/vectornav_fix.hpp"
#include "codec/imu/vectornav_layout.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {

std::uint16_t vectornav_crc16(std::span<const std::uint8_t> bytes) {
  return crc16_ccitt(bytes);
}

namespace {

using vectornav::Group;
using vectornav::Layout;
using vectornav::read_layout;
namespace common_field = vectornav::common_field;
namespace time_field = vectornav::time_field;
namespace imu_field = vectornav::imu_field;

constexpr std::size_t kMaxFrame = 2048;
constexpr std::size_t kMaxLine = 256;
constexpr std::string_view kTextStart = "$VN";

// Beyond every instrument of the family (2000 deg/s, 16 g and their high-range variants).
constexpr double kMaxRate_rad_s = 100.0;
constexpr double kMaxForce_m_s2 = 2000.0;

std::array<double, 3> vector3(Bytes frame, std::size_t at, double factor = 1.0) {
  std::array<double, 3> v{};
  for (std::size_t i = 0; i < 3; ++i) v[i] = factor * load_le<float>(frame, at + 4 * i);
  return v;
}

void set_from_increments(ImuSample& s) {
  if (!(s.delta_time_s > 0.0)) return;
  const bool no_rate = !known3(s.angular_rate_B_rad_s);
  const bool no_force = !known3(s.specific_force_B_m_s2);
  for (std::size_t i = 0; i < 3; ++i) {
    if (no_rate) s.angular_rate_B_rad_s[i] = s.delta_angle_B_rad[i] / s.delta_time_s;
    if (no_force) s.specific_force_B_m_s2[i] = s.delta_velocity_B_m_s[i] / s.delta_time_s;
  }
}

/// Nothing when the sample is good.
std::optional<RejectReason> refusal(const ImuSample& s) {
  for (const double v : s.angular_rate_B_rad_s) {
    if (std::abs(v) > kMaxRate_rad_s) return RejectReason::out_of_range;
  }
  for (const double v : s.specific_force_B_m_s2) {
    if (std::abs(v) > kMaxForce_m_s2) return RejectReason::out_of_range;
  }
  return std::nullopt;
}

/// Whether any field that was sent holds an infinity or not-a-number.
bool finite3(Bytes frame, std::size_t at) {
  const auto v = vector3(frame, at);
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

DeviceTime device_time(Bytes frame, const Layout& layout) {
  DeviceTime time;
  const auto& common = layout.at[Group::common];
  const auto& clock = layout.at[Group::time];
  const std::size_t startup =
      clock[time_field::startup] ? clock[time_field::startup] : common[common_field::time_startup];
  if (startup) {
    const auto ns = load_le<std::uint64_t>(frame, startup);
    if (ns < 1ULL << 62) time.clock_ns = static_cast<TimeNs>(ns);
  }
  if (!clock[time_field::status]) return time;
  const std::uint8_t status = frame[clock[time_field::status]];
  using enum vectornav::TimeStatus;
  const std::size_t gps = clock[time_field::gps] ? clock[time_field::gps] : common[common_field::time_gps];
  if (gps && (status & time_ok) && (status & date_ok)) {
    const auto ns = load_le<std::uint64_t>(frame, gps);
    if (ns < 1ULL << 62) time.utc_ns = utc_of_gps(static_cast<DurationNs>(ns));
  } else if (const std::size_t utc = clock[time_field::utc]; utc && (status & utc_ok)) {
    time.utc_ns = vectornav::utc_of_civil(frame, utc);
  }
  return time;
}

/// What a frame says of rates and forces.
struct Inertial {
  bool sent = false;
  std::optional<RejectReason> refused;
  ImuSample sample;
};

Inertial read_inertial(Bytes frame, const Layout& layout) {
  const auto& common = layout.at[Group::common];
  const auto& imu = layout.at[Group::imu];
  Inertial out;
  ImuSample& s = out.sample;
  bool finite = true;
  const auto take = [&](std::array<double, 3>& into, std::size_t at, double factor = 1.0) {
    out.sent = true;
    finite = finite && finite3(frame, at);
    into = vector3(frame, at, factor);
  };

  if (const auto at = imu[imu_field::uncomp_gyro]) {
    take(s.angular_rate_B_rad_s, at);
  } else if (const auto both = common[common_field::imu]) {
    take(s.angular_rate_B_rad_s, both + 12);
  } else if (const auto compensated = imu[imu_field::angular_rate]) {
    take(s.angular_rate_B_rad_s, compensated);
  } else if (const auto in_common = common[common_field::angular_rate]) {
    take(s.angular_rate_B_rad_s, in_common);
  }
  if (const auto at = imu[imu_field::uncomp_accel]) {
    take(s.specific_force_B_m_s2, at);
  } else if (const auto both = common[common_field::imu]) {
    take(s.specific_force_B_m_s2, both);
  } else if (const auto compensated = imu[imu_field::accel]) {
    take(s.specific_force_B_m_s2, compensated);
  } else if (const auto in_common = common[common_field::accel]) {
    take(s.specific_force_B_m_s2, in_common);
  }
  if (const auto at = common[common_field::deltas]) {
    s.delta_time_s = load_le<float>(frame, at);
    take(s.delta_angle_B_rad, at + 4, kRadPerDeg);
    take(s.delta_velocity_B_m_s, at + 16);
  }
  if (const auto at = imu[imu_field::delta_theta]) {
    s.delta_time_s = load_le<float>(frame, at);
    take(s.delta_angle_B_rad, at + 4, kRadPerDeg);
  }
  if (const auto at = imu[imu_field::delta_velocity]) take(s.delta_velocity_B_m_s, at);
  if (!finite || std::isinf(s.delta_time_s)) {
    out.refused = RejectReason::field;
    return out;
  }
  set_from_increments(s);
  if (const auto at = imu[imu_field::temperature]) {
    s.temperature_degC = load_le<float>(frame, at);
  } else if (const auto mag_pres = common[common_field::mag_pres]) {
    s.temperature_degC = load_le<float>(frame, mag_pres + 12);
  }
  out.refused = refusal(s);
  return out;
}

class VectorNav : public Framer {
 public:
  VectorNav() : Framer(kMaxFrame, LineEnds::belong_to_frames) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (front[0] == vectornav::kSync) return probe_binary(front);
    if (front[0] == '$') return probe_text(front);
    std::size_t n = 1;
    while (n < front.size() && front[n] != vectornav::kSync && front[n] != '$') ++n;
    return Probe::skip(n);
  }

  static Probe probe_binary(Bytes front) {
    const Layout layout = read_layout(front);
    switch (layout.state) {
      case Layout::State::unknown_field:
        return Probe::bad(RejectReason::structure, layout.length);
      case Layout::State::more_needed:
        return Probe::need(layout.length);
      case Layout::State::complete:
        break;
    }
    if (vectornav_crc16(front.subspan(1, layout.length - 1)) != 0) {
      return Probe::bad(RejectReason::checksum, layout.length);
    }
    return Probe::frame(layout.length);
  }

  static Probe probe_text(Bytes front) {
    for (std::size_t i = 1; i < kTextStart.size(); ++i) {
      if (i >= front.size()) return Probe::maybe();
      if (front[i] != static_cast<std::uint8_t>(kTextStart[i])) return Probe::skip(i);
    }
    std::uint8_t xor8 = 0;
    for (std::size_t i = 1; i < std::min(front.size(), kMaxLine); ++i) {
      const std::uint8_t c = front[i];
      if (c == '*') return probe_sum(front, i, xor8);
      if (c == '$' || c < 0x20 || c > 0x7E) return Probe::bad(RejectReason::structure, i, i);
      xor8 ^= c;
    }
    if (front.size() >= kMaxLine) return Probe::bad(RejectReason::length, kMaxLine);
    return Probe::need();
  }

  /// Two digits of exclusive-or, or four of CRC-16, as the instrument is configured.
  static Probe probe_sum(Bytes front, std::size_t star, std::uint8_t xor8) {
    std::uint32_t sum = 0;
    for (std::size_t digits = 0; digits < 4; ++digits) {
      const std::size_t at = star + 1 + digits;
      if (at >= front.size()) return Probe::need(at + 1);
      const std::uint8_t c = front[at];
      const int value = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                               : -1;
      if (value < 0) {
        return Probe::bad(digits == 0 ? RejectReason::no_checksum : RejectReason::checksum, at, at);
      }
      sum = sum * 16 + static_cast<std::uint32_t>(value);
      if (digits == 1 && sum == xor8) return Probe::frame(at + 1);
    }
    const bool good = sum == vectornav_crc16(front.subspan(1, star - 1));
    return good ? Probe::frame(star + 5) : Probe::bad(RejectReason::checksum, star + 5);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    return frame[0] == vectornav::kSync ? decode_binary(frame, offset, sink)
                                        : decode_text(frame, offset, sink);
  }

  Outcome decode_binary(Bytes frame, std::uint64_t offset, Sink& sink) {
    const Layout layout = read_layout(frame);
    const Inertial inertial = read_inertial(frame, layout);
    const auto fix = fixes_.take(frame, layout);
    const bool has_sample = inertial.sent && !inertial.refused;
    if (has_sample) emit(sink, inertial.sample, device_time(frame, layout), offset, frame.size());
    if (fix && (!fix->refused || has_sample)) {
      // Beside rates and forces that are good an impossible fix is none, so that it does not pass unseen.
      emit(sink, fix->refused ? GpsSample{} : fix->sample, fix->time, offset, frame.size());
      return Outcome::used();
    }
    if (has_sample) return Outcome::used();
    if (inertial.refused) return Outcome::refused(*inertial.refused);
    return fix ? Outcome::refused(*fix->refused) : Outcome::ignored();
  }

  Outcome decode_text(Bytes frame, std::uint64_t offset, Sink& sink) {
    const std::string_view whole = text_of(frame);
    const std::string_view line = whole.substr(0, whole.find('*'));
    const std::string_view tag = line.substr(0, line.find(','));
    const bool attitude_first = tag == "$VNYMR";  // yaw pitch roll, magnetic, accel, rate
    if (!attitude_first && tag != "$VNIMU") return Outcome::ignored();
    const std::size_t wanted = attitude_first ? 12 : 11;  // $VNIMU: magnetic, accel, rate, degC, kPa
    std::array<double, 12> values{};
    std::size_t count = 0;
    for (std::size_t at = tag.size(); at < line.size(); ++count) {
      if (count == wanted) return Outcome::refused(RejectReason::structure);
      const std::size_t end = std::min(line.find(',', at + 1), line.size());
      const std::optional<double> value = parse_decimal(line.substr(at + 1, end - at - 1));
      if (!value) return Outcome::refused(RejectReason::field);
      values[count] = *value;
      at = end;
    }
    if (count != wanted) return Outcome::refused(RejectReason::structure);
    const std::size_t accel = attitude_first ? 6 : 3;
    ImuSample s;
    for (std::size_t i = 0; i < 3; ++i) {
      s.specific_force_B_m_s2[i] = values[accel + i];
      s.angular_rate_B_rad_s[i] = values[accel + 3 + i];
    }
    if (!attitude_first) s.temperature_degC = values[9];
    if (const auto reason = refusal(s)) return Outcome::refused(*reason);
    emit(sink, s, DeviceTime{}, offset, frame.size());
    return Outcome::used();
  }

  vectornav::Fixes fixes_;
};

}  // namespace

std::unique_ptr<Codec> make_vectornav(const CodecOptions& /*options*/) {
  return std::make_unique<VectorNav>();
}

}  // namespace fathom::codec
