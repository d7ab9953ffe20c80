#include "codec/autopilot/mavlink.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "base/units.hpp"
#include "codec/depth/depth_scale.hpp"
#include "codec/framer.hpp"
#include "mavlink/frame.hpp"
#include "mavlink/messages.hpp"

namespace fathom::codec {
namespace {

using mavlink::Look;

constexpr double kMilli = 1e-3;
constexpr double kCenti = 1e-2;
constexpr double kPascalPerHectopascal = 100.0;
constexpr std::uint8_t kAutopilot = 1;   // MAV_COMP_ID_AUTOPILOT1
constexpr std::uint8_t kLooksDown = 25;  // MAV_SENSOR_ROTATION_PITCH_270
constexpr std::uint16_t kUnknown16 = 65'535;
constexpr std::uint8_t kUnknown8 = 255;
constexpr std::uint8_t kBadSignal = 1;
/// Above it microseconds are since the epoch and not since start.
constexpr std::uint64_t kYear2001_us = 1'000'000'000'000'000;

DeviceTime since_start(std::uint32_t milliseconds) {
  DeviceTime time;
  time.clock_ns = static_cast<TimeNs>(milliseconds) * kNsPerMillisecond;
  return time;
}

GpsFix fix_of(std::uint8_t type) {
  switch (type) {
    case 2:
      return GpsFix::fix_2d;
    case 3:
      return GpsFix::fix_3d;
    case 4:
      return GpsFix::differential;
    case 5:
      return GpsFix::rtk_float;
    case 6:
    case 7:
      return GpsFix::rtk_fixed;
    case 8:
      return GpsFix::differential;  // precise point positioning
    default:
      return GpsFix::none;
  }
}

/// Zero is what an older sender does not say.
double accuracy(std::uint32_t value) {
  return value == 0 ? kUnknown : kMilli * value;
}

class Mavlink final : public Framer {
 public:
  explicit Mavlink(const CodecOptions& options)
      : Framer(mavlink::kMostFrame),
        pressure_{.unit = kPascalPerHectopascal,
                  .value_is_depth = false,
                  .atmosphere_Pa = options.atmosphere_Pa,
                  .latitude_rad = options.latitude_rad} {
    if (options.mavlink_system > 0) system_ = static_cast<std::uint8_t>(options.mavlink_system);
  }

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    const Look look = mavlink::look_at(front);
    switch (look.kind) {
      case Look::Kind::skip:
        return Probe::skip(look.length);
      case Look::Kind::need:
        return Probe::need(look.length);
      case Look::Kind::frame:
        return Probe::frame(look.length);
      case Look::Kind::checksum:
        return Probe::bad(RejectReason::checksum, look.length);
      case Look::Kind::length:
        break;
    }
    return Probe::bad(RejectReason::length, look.length);
  }

  Outcome decode(Bytes bytes, std::uint64_t offset, Sink& sink) override {
    const mavlink::Frame frame = mavlink::look_at(bytes).frame;
    if (frame.component != kAutopilot || (system_ && *system_ != frame.system)) return Outcome::ignored();
    AnySample sample;
    DeviceTime time;
    std::optional<RejectReason> wrong;
    switch (frame.id) {
      case mavlink::Attitude::kId:
        wrong = take(mavlink::message_of<mavlink::Attitude>(frame.payload), sample, time);
        break;
      case mavlink::ScaledImu::kId:
        take(mavlink::message_of<mavlink::ScaledImu>(frame.payload), sample, time);
        break;
      case mavlink::GpsRawInt::kId:
        wrong = take(mavlink::message_of<mavlink::GpsRawInt>(frame.payload), sample, time);
        break;
      case mavlink::ScaledPressure2::kId:
        wrong = take(mavlink::message_of<mavlink::ScaledPressure2>(frame.payload), sample, time);
        break;
      case mavlink::DistanceSensor::kId:
        if (!take(mavlink::message_of<mavlink::DistanceSensor>(frame.payload), sample, time))
          return Outcome::ignored();
        break;
      default:
        return Outcome::ignored();
    }
    if (wrong) return Outcome::refused(*wrong);
    system_ = frame.system;
    emit(sink, sample, time, offset, bytes.size());
    return Outcome::used();
  }

  static std::optional<RejectReason> take(const mavlink::Attitude& in, AnySample& sample, DeviceTime& time) {
    if (!(std::abs(in.yaw) <= 2.0 * std::numbers::pi + kMilli)) return RejectReason::out_of_range;
    HeadingSample out;
    const double yaw = in.yaw;
    out.heading_rad = yaw < 0.0 ? yaw + 2.0 * std::numbers::pi : yaw;
    if (out.heading_rad >= 2.0 * std::numbers::pi) out.heading_rad -= 2.0 * std::numbers::pi;
    sample = out;
    time = since_start(in.time_boot_ms);
    return std::nullopt;
  }

  static void take(const mavlink::ScaledImu& in, AnySample& sample, DeviceTime& time) {
    ImuSample out;
    out.angular_rate_B_rad_s = {kMilli * in.xgyro, kMilli * in.ygyro, kMilli * in.zgyro};
    out.specific_force_B_m_s2 = {kMilliG_m_s2 * in.xacc, kMilliG_m_s2 * in.yacc, kMilliG_m_s2 * in.zacc};
    if (in.temperature != 0) out.temperature_degC = kCenti * in.temperature;
    sample = out;
    time = since_start(in.time_boot_ms);
  }

  static std::optional<RejectReason> take(const mavlink::GpsRawInt& in, AnySample& sample, DeviceTime& time) {
    GpsSample out;
    out.fix = fix_of(in.fix_type);
    if (in.satellites_visible != kUnknown8) out.satellites = in.satellites_visible;
    if (in.time_usec >= kYear2001_us) {
      if (in.time_usec > 4 * kYear2001_us) return RejectReason::out_of_range;
      time.utc_ns = static_cast<TimeNs>(in.time_usec) * 1000;
    } else {
      time.clock_ns = static_cast<TimeNs>(in.time_usec) * 1000;
    }
    if (out.fix != GpsFix::none) {
      out.latitude_rad = 1e-7 * in.lat * kRadPerDeg;
      out.longitude_rad = 1e-7 * in.lon * kRadPerDeg;
      if (std::abs(out.latitude_rad) > 90.0 * kRadPerDeg || std::abs(out.longitude_rad) > 180.0 * kRadPerDeg)
        return RejectReason::out_of_range;
      out.altitude_msl_m = kMilli * in.alt;
      if (in.alt_ellipsoid != 0) out.altitude_m = kMilli * in.alt_ellipsoid;
      if (in.eph != kUnknown16) out.hdop = kCenti * in.eph;
      const double axis_m = accuracy(in.h_acc) / std::numbers::sqrt2;
      out.position_sigma_N_m = {axis_m, axis_m, accuracy(in.v_acc)};
      if (in.vel != kUnknown16 && (in.cog != kUnknown16 || in.vel == 0)) {
        const double course_rad = in.cog != kUnknown16 ? kCenti * in.cog * kRadPerDeg : 0.0;
        if (in.cog != kUnknown16) out.course_rad = course_rad;
        out.velocity_N_m_s = {kCenti * in.vel * std::cos(course_rad), kCenti * in.vel * std::sin(course_rad),
                              kUnknown};
        const double speed_sigma_m_s = accuracy(in.vel_acc);
        out.velocity_sigma_N_m_s = {speed_sigma_m_s, speed_sigma_m_s, kUnknown};
      }
    }
    sample = out;
    return std::nullopt;
  }

  [[nodiscard]] std::optional<RejectReason> take(const mavlink::ScaledPressure2& in, AnySample& sample,
                                                 DeviceTime& time) const {
    DepthSample out;
    if (const auto wrong = pressure_.apply(in.press_abs, out)) return wrong;
    out.temperature_degC = kCenti * in.temperature;
    sample = out;
    time = since_start(in.time_boot_ms);
    return std::nullopt;
  }

  /// False where it says nothing of the bottom.
  static bool take(const mavlink::DistanceSensor& in, AnySample& sample, DeviceTime& time) {
    if (in.orientation != kLooksDown || in.signal_quality == kBadSignal) return false;
    if (in.current_distance < in.min_distance || in.current_distance > in.max_distance) return false;
    AltimeterSample out;
    out.altitude_m = kCenti * in.current_distance;
    if (in.covariance != kUnknown8 && in.covariance != 0)
      out.sigma_m = kCenti * std::sqrt(static_cast<double>(in.covariance));
    sample = out;
    time = since_start(in.time_boot_ms);
    return true;
  }

  DepthScale pressure_;
  std::optional<std::uint8_t> system_;  ///< that counts; none: the first that is heard
};

}  // namespace

std::unique_ptr<Codec> make_mavlink(const CodecOptions& options) {
  return std::make_unique<Mavlink>(options);
}

}  // namespace fathom::codec
