#include "codec/satellite/gpsd.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/iso8601.hpp"
#include "base/units.hpp"
#include "codec/framer.hpp"
#include "codec/text/json_members.hpp"
#include "codec/text/json_object.hpp"

namespace fathom::codec {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostOfReport = 16 * 1024;  // gpsd's own limit is 10 kB
constexpr double kMostAltitude_m = 50'000.0;
constexpr double kMostSpeed_m_s = 600.0;
constexpr double kMostSpeedSigma_m_s = 5.0;
constexpr DurationNs kGstLasts_ns = kNsPerSecond;

std::string text(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return "";
  if (!found->is_string()) throw WrongType{};
  return found->get<std::string>();
}

double above_zero(double value) {
  return value > 0.0 ? value : kUnknown;
}

/// Where the receiver gives none, gpsd makes it of the errors of two positions: tens of m/s, of which the
/// velocity of the same receiver knows nothing.
double of_velocity(double sigma_m_s) {
  return sigma_m_s > 0.0 && sigma_m_s < kMostSpeedSigma_m_s ? sigma_m_s : kUnknown;
}

/// gpsd's "mode" says how many dimensions, its "status" how they were found.
GpsFix fix_of(double mode, double status) {
  constexpr double kDifferential = 2, kRtkFixed = 3, kRtkFloat = 4, kReckoned = 5, kTimeOnly = 7,
                   kSimulated = 8;
  if (status == kTimeOnly) return GpsFix::time_only;
  if (!(mode >= 2.0)) return GpsFix::none;
  if (status == kReckoned || status == kSimulated) return GpsFix::dead_reckoning;
  if (mode < 3.0) return GpsFix::fix_2d;
  if (status == kRtkFixed) return GpsFix::rtk_fixed;
  if (status == kRtkFloat) return GpsFix::rtk_float;
  return status == kDifferential ? GpsFix::differential : GpsFix::fix_3d;
}

void read_velocity(const Json& report, GpsSample& out) {
  const double course_rad = number_in(report, "track") * kRadPerDeg;
  const double speed_m_s = number_in(report, "speed");
  out.velocity_N_m_s = {number_in(report, "velN"), number_in(report, "velE"), -number_in(report, "climb")};
  if (!known(out.velocity_N_m_s[0]) || !known(out.velocity_N_m_s[1])) {
    // A receiver that stands has no course, and needs none.
    const bool stands = speed_m_s == 0.0;
    out.velocity_N_m_s[0] = stands ? 0.0 : speed_m_s * std::cos(course_rad);
    out.velocity_N_m_s[1] = stands ? 0.0 : speed_m_s * std::sin(course_rad);
  }
  out.course_rad = course_rad;
  const double speed_sigma_m_s = of_velocity(number_in(report, "eps"));
  out.velocity_sigma_N_m_s = {speed_sigma_m_s, speed_sigma_m_s, of_velocity(number_in(report, "epc"))};
}

bool in_range(const GpsSample& s) {
  if (!(std::abs(s.latitude_rad) <= 90.0 * kRadPerDeg) || !(std::abs(s.longitude_rad) <= 180.0 * kRadPerDeg))
    return false;
  if (std::abs(s.altitude_m) > kMostAltitude_m || std::abs(s.altitude_msl_m) > kMostAltitude_m) return false;
  for (const double v : s.velocity_N_m_s)
    if (std::abs(v) > kMostSpeed_m_s) return false;
  return true;
}

class Gpsd final : public Framer {
 public:
  Gpsd() : Framer(kMostOfReport, LineEnds::belong_to_frames) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_json_object(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const Json report = Json::parse(frame.begin(), frame.end(), nullptr, false);
    if (!report.is_object()) return Outcome::refused(RejectReason::structure);
    try {
      const std::string type = text(report, "class");
      if (type.empty()) return Outcome::refused(RejectReason::structure);
      if (type != "TPV" && type != "SKY" && type != "GST") return Outcome::ignored();
      const std::string device = text(report, "device");
      if (!device_) device_ = device;
      if (*device_ != device) return Outcome::ignored();
      if (type == "SKY") return take_sky(report);
      if (type == "GST") return take_gst(report);
      return take_tpv(report, offset, frame.size(), sink);
    } catch (const WrongType&) {
      return Outcome::refused(RejectReason::field);
    }
  }

  Outcome take_sky(const Json& report) {
    const double used = number_in(report, "uSat");
    satellites_ = used >= 0.0 && used < 256.0 ? static_cast<std::int32_t>(used) : -1;
    hdop_ = above_zero(number_in(report, "hdop"));
    return Outcome::ignored();  // on its own it is no sample
  }

  Outcome take_gst(const Json& report) {
    const auto time_ns = from_iso8601(text(report, "time"));
    if (!time_ns) return Outcome::ignored();
    gst_ns_ = *time_ns;
    gst_sigma_N_m_ = {above_zero(number_in(report, "lat")), above_zero(number_in(report, "lon")),
                      above_zero(number_in(report, "alt"))};
    return Outcome::ignored();
  }

  Outcome take_tpv(const Json& report, std::uint64_t offset, std::uint64_t length, Sink& sink) {
    GpsSample s;
    const double mode = number_in(report, "mode");
    s.fix = fix_of(mode, number_in(report, "status"));
    DeviceTime time;
    if (report.contains("time")) {
      time.utc_ns = from_iso8601(text(report, "time"));
      if (!time.utc_ns) return Outcome::refused(RejectReason::field);
    }
    // Several reports of one instant repeat each other.
    if (time.utc_ns && time.utc_ns == said_ns_) return Outcome::ignored();
    // A report without an instant of its own says that there is no fix.
    if (!time.utc_ns && s.fix > GpsFix::time_only) return Outcome::ignored();
    s.satellites = satellites_;
    s.hdop = hdop_;
    if (s.fix >= GpsFix::dead_reckoning) {
      s.latitude_rad = number_in(report, "lat") * kRadPerDeg;
      s.longitude_rad = number_in(report, "lon") * kRadPerDeg;
      if (!known(s.latitude_rad) || !known(s.longitude_rad))
        return Outcome::refused(RejectReason::incomplete);
      s.altitude_m = number_in(report, "altHAE");
      s.altitude_msl_m = number_in(report, "altMSL");
      s.position_sigma_N_m = {above_zero(number_in(report, "epy")), above_zero(number_in(report, "epx")),
                              above_zero(number_in(report, "epv"))};
      if (gst_ns_ && *time.utc_ns - *gst_ns_ >= 0 && *time.utc_ns - *gst_ns_ <= kGstLasts_ns) {
        for (std::size_t i = 0; i < 3; ++i)
          if (known(gst_sigma_N_m_[i])) s.position_sigma_N_m[i] = gst_sigma_N_m_[i];
      }
      read_velocity(report, s);
      if (!in_range(s)) return Outcome::refused(RejectReason::out_of_range);
    }
    said_ns_ = time.utc_ns;
    emit(sink, s, time, offset, length);
    return Outcome::used();
  }

  std::optional<std::string> device_;
  std::optional<TimeNs> said_ns_;
  std::optional<TimeNs> gst_ns_;
  std::array<double, 3> gst_sigma_N_m_{kUnknown, kUnknown, kUnknown};
  std::int32_t satellites_ = -1;
  double hdop_ = kUnknown;
};

}  // namespace

std::unique_ptr<Codec> make_gpsd(const CodecOptions& /*options*/) {
  return std::make_unique<Gpsd>();
}

}  // namespace fathom::codec
