#include "cli/decode/json.hpp"

#include <array>
#include <numbers>

#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;  // writes not-a-number as null

// Any calendar clock is past 1980, no count since start ever gets there.
constexpr TimeNs kCalendarFrom_ns = 315'532'800 * kNsPerSecond;

/// Degrees of radians; exact for the values that instruments send in decimal degrees.
double degrees(double radians) {
  return radians * (180.0 / std::numbers::pi);
}

std::string_view word(GpsFix fix) {
  constexpr std::array<std::string_view, 8> kWords{"none",   "time_only",    "dead_reckoning", "fix_2d",
                                                   "fix_3d", "differential", "rtk_float",      "rtk_fixed"};
  return kWords.at(static_cast<std::size_t>(fix));
}

// Where the receiver said nothing: null, as every unknown.
Json word(GpsJamming jamming) {
  constexpr std::array kWords{"", "none", "warning", "critical"};
  return jamming == GpsJamming::unknown ? Json() : Json(kWords.at(static_cast<std::size_t>(jamming)));
}

Json word(GpsSpoofing spoofing) {
  constexpr std::array kWords{"", "none", "indicated", "affirmed"};
  return spoofing == GpsSpoofing::unknown ? Json() : Json(kWords.at(static_cast<std::size_t>(spoofing)));
}

std::string_view word(DvlFrame frame) {
  constexpr std::array<std::string_view, 4> kWords{"beam", "instrument", "ship", "earth"};
  return kWords.at(static_cast<std::size_t>(frame));
}

std::string_view word(UsblFrame frame) {
  constexpr std::array<std::string_view, 4> kWords{"geodetic", "ned", "vessel_frd", "vehicle_frd"};
  return kWords.at(static_cast<std::size_t>(frame));
}

void add(Json& line, const ImuSample& s) {
  constexpr std::array kAxes{'x', 'y', 'z'};
  for (std::size_t i = 0; i < 3; ++i) line[std::string{'g', kAxes[i]} + "_rad_s"] = s.angular_rate_B_rad_s[i];
  for (std::size_t i = 0; i < 3; ++i) line[std::string{'a', kAxes[i]} + "_m_s2"] = s.specific_force_B_m_s2[i];
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("delta_angle_") + kAxes[i] + "_rad"] = s.delta_angle_B_rad[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("delta_velocity_") + kAxes[i] + "_m_s"] = s.delta_velocity_B_m_s[i];
  }
  line["delta_time_s"] = s.delta_time_s;
  line["temperature_degC"] = s.temperature_degC;
}

void add(Json& line, const DvlSample& s) {
  line["frame"] = word(s.recorded_frame);
  line["mode"] = s.mode == DvlMode::bottom ? "bottom" : "water";
  line["vx_m_s"] = s.velocity_D_m_s[0];
  line["vy_m_s"] = s.velocity_D_m_s[1];
  line["vz_m_s"] = s.velocity_D_m_s[2];
  line["valid"] = {known(s.velocity_D_m_s[0]), known(s.velocity_D_m_s[1]), known(s.velocity_D_m_s[2])};
  line["error_velocity_m_s"] = s.error_velocity_m_s;
  line["sigma_m_s"] = s.sigma_m_s;
  for (std::size_t i = 0; i < 4; ++i) line["b" + std::to_string(i + 1) + "_m_s"] = s.beam_velocity_m_s[i];
  for (std::size_t i = 0; i < 4; ++i) line["range" + std::to_string(i + 1) + "_m"] = s.beam_range_m[i];
  line["altitude_m"] = s.altitude_m;
  line["sound_speed_m_s"] = s.sound_speed_m_s;
  line["beam_angle_deg"] = degrees(s.beam_angle_rad);
  line["roll_deg"] = degrees(s.roll_rad);
  line["pitch_deg"] = degrees(s.pitch_rad);
  line["heading_deg"] = degrees(s.heading_rad);
}

void add(Json& line, const GpsSample& s) {
  line["fix"] = word(s.fix);
  line["satellites"] = s.satellites < 0 ? Json() : Json(s.satellites);
  line["hdop"] = s.hdop;
  line["lat_deg"] = degrees(s.latitude_rad);
  line["lon_deg"] = degrees(s.longitude_rad);
  line["alt_m"] = s.altitude_m;
  line["alt_msl_m"] = s.altitude_msl_m;
  constexpr std::array kAxes{'n', 'e', 'd'};
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("sigma_") + kAxes[i] + "_m"] = s.position_sigma_N_m[i];
  }
  for (std::size_t i = 0; i < 3; ++i) line[std::string{'v', kAxes[i]} + "_m_s"] = s.velocity_N_m_s[i];
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("sigma_v") + kAxes[i] + "_m_s"] = s.velocity_sigma_N_m_s[i];
  }
  line["course_deg"] = degrees(s.course_rad);
  line["jamming"] = word(s.jamming);
  line["spoofing"] = word(s.spoofing);
}

void add(Json& line, const DepthSample& s) {
  line["depth_m"] = s.depth_m;
  line["sigma_m"] = s.sigma_m;
  line["pressure_Pa"] = s.pressure_Pa;
  line["temperature_degC"] = s.temperature_degC;
}

void add(Json& line, const HeadingSample& s) {
  line["heading_deg"] = degrees(s.heading_rad);
  line["sigma_deg"] = degrees(s.sigma_rad);
  line["north"] = s.north == North::true_north ? "true" : "magnetic";
  line["variation_deg"] = degrees(s.variation_rad);
  line["deviation_deg"] = degrees(s.deviation_rad);
}

void add(Json& line, const UsblSample& s) {
  line["transponder"] = s.transponder.view();
  line["frame"] = word(s.frame);
  line["lat_deg"] = degrees(s.latitude_rad);
  line["lon_deg"] = degrees(s.longitude_rad);
  line["depth_m"] = s.depth_m;
  constexpr std::array<std::array<const char*, 3>, 4> kKeys{{{"x_m", "y_m", "z_m"},
                                                             {"north_m", "east_m", "down_m"},
                                                             {"forward_m", "right_m", "down_m"},
                                                             {"forward_m", "right_m", "down_m"}}};
  if (s.frame != UsblFrame::geodetic) {
    const auto& keys = kKeys.at(static_cast<std::size_t>(s.frame));
    for (std::size_t i = 0; i < 3; ++i) line[keys[i]] = s.relative_m[i];
    line["range_m"] = s.range_m;
    line["bearing_deg"] = degrees(s.bearing_rad);
    line["depression_deg"] = degrees(s.depression_rad);
    line["sigma_deg"] = degrees(s.sigma_rad);
    line["station_lat_deg"] = degrees(s.station_latitude_rad);
    line["station_lon_deg"] = degrees(s.station_longitude_rad);
    line["station_depth_m"] = s.station_depth_m;
    line["station_yaw_deg"] = degrees(s.station_rpy_rad[2]);
  }
  line["sigma_m"] = s.sigma_m;
  line["travel_time_s"] = s.travel_time_s;
}

void add(Json& line, const PropulsionSample& s) {
  line["rpm"] = s.rpm;
}

void add(Json& line, const FinsSample& s) {
  line["rudder_rad"] = s.rudder_rad;
  line["stern_rad"] = s.stern_rad;
}

void add(Json& line, const AirspeedSample& s) {
  line["airspeed_m_s"] = s.airspeed_m_s;
  line["true_airspeed_m_s"] = s.true_airspeed_m_s;
  line["baro_alt_m"] = s.baro_altitude_m;
}

/// Names come from the device: bytes that are not UTF-8 are replaced.
std::string text(const Json& line) {
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string_view kind_of(const codec::AnySample& sample) {
  struct Kind {
    std::string_view operator()(const ImuSample& /*s*/) const { return "imu"; }
    std::string_view operator()(const DvlSample& /*s*/) const { return "dvl"; }
    std::string_view operator()(const GpsSample& /*s*/) const { return "gps"; }
    std::string_view operator()(const DepthSample& /*s*/) const { return "depth"; }
    std::string_view operator()(const HeadingSample& /*s*/) const { return "heading"; }
    std::string_view operator()(const UsblSample& /*s*/) const { return "usbl"; }
    std::string_view operator()(const PropulsionSample& /*s*/) const { return "propulsion"; }
    std::string_view operator()(const FinsSample& /*s*/) const { return "fins"; }
    std::string_view operator()(const AirspeedSample& /*s*/) const { return "airspeed"; }
  };
  return std::visit(Kind{}, sample);
}

TimeNs utc_of(const codec::DeviceTime& time) {
  if (time.utc_ns) return *time.utc_ns;
  if (time.clock_ns && *time.clock_ns >= kCalendarFrom_ns) return *time.clock_ns;
  return 0;
}

std::string to_json(const codec::Decoded& decoded) {
  Json line;
  line["kind"] = kind_of(decoded.sample);
  const TimeNs utc = utc_of(decoded.time);
  line["stamp_utc"] = utc != 0 ? Json(to_iso8601(utc, 6)) : Json();
  line["offset"] = decoded.offset;
  line["length"] = decoded.length;
  std::visit([&](const auto& sample) { add(line, sample); }, decoded.sample);
  const auto optional = [](const std::optional<std::int64_t>& ns) { return ns ? Json(*ns) : Json(); };
  line["device_utc_ns"] = optional(decoded.time.utc_ns);
  line["device_clock_ns"] = optional(decoded.time.clock_ns);
  line["device_time_of_day_ns"] = optional(decoded.time.time_of_day_ns);
  line["device_age_ns"] = optional(decoded.time.age_ns);
  return text(line);
}

std::string to_json(const RejectionRun& run) {
  Json line;
  line["rejected"] = codec::to_string(run.first.reason);
  line["offset"] = run.first.offset;
  line["length"] = run.first.length;
  if (run.count > 1) line["count"] = run.count;
  return text(line);
}

std::string to_json(const codec::Totals& totals) {
  Json sums;
  sums["bytes"] = totals.bytes;
  sums["samples"] = totals.samples;
  sums["rejected"] = totals.rejected;
  sums["skipped_bytes"] = totals.skipped_bytes;
  sums["frames_ignored"] = totals.frames_ignored;
  Json line;
  line["totals"] = std::move(sums);
  return text(line);
}

}  // namespace fathom::cli
