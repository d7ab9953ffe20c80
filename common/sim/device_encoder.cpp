#include "sim/device_encoder.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "codec/registry.hpp"
#include "sim/encode/air_data.hpp"
#include "sim/encode/depth.hpp"
#include "sim/encode/nmea.hpp"
#include "sim/encode/pd0.hpp"
#include "sim/encode/ubx.hpp"
#include "sim/encode/vectornav.hpp"
#include "sim/encode/waterlinked.hpp"

namespace fathom::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

/// The registry's own name of a protocol given by name or alias.
std::string_view canonical(std::string_view protocol) {
  const codec::Protocol* found = codec::find_protocol(protocol);
  return found == nullptr ? std::string_view{} : found->name;
}

constexpr std::array<std::pair<SourceKind, std::string_view>, 13> kOutputs{{
    {SourceKind::imu, "vectornav"},
    {SourceKind::gps, "nmea0183"},
    {SourceKind::gps, "ubx"},
    {SourceKind::dvl, "pd0"},
    {SourceKind::dvl, "waterlinked"},
    {SourceKind::depth, "paroscientific"},
    {SourceKind::depth, "ascii_depth"},
    {SourceKind::heading, "nmea0183"},
    {SourceKind::usbl, "psimssb"},
    {SourceKind::propulsion, "nmea0183"},
    {SourceKind::fins, "nmea0183"},
    {SourceKind::airspeed, "ascii_air_data"},
    {SourceKind::airspeed, "nmea_air_data"},
}};

}  // namespace

std::array<std::pair<SourceKind, const SensorCommon*>, kSourceKinds> sensors_of(const SensorSuite& suite) {
  return {{{SourceKind::imu, &suite.imu},
           {SourceKind::gps, &suite.gps},
           {SourceKind::dvl, &suite.dvl},
           {SourceKind::depth, &suite.depth},
           {SourceKind::heading, &suite.heading},
           {SourceKind::usbl, &suite.usbl},
           {SourceKind::airspeed, &suite.airspeed},
           {SourceKind::propulsion, &suite.propulsion},
           {SourceKind::fins, &suite.fins}}};
}

const SensorCommon* find_sensor(const SensorSuite& suite, std::string_view kind) {
  for (const auto& [source, sensor] : sensors_of(suite)) {
    if (to_string(source) == kind) return sensor;
  }
  return nullptr;
}

bool can_encode(SourceKind kind, std::string_view protocol) {
  const auto name = canonical(protocol);
  return std::any_of(kOutputs.begin(), kOutputs.end(),
                     [&](const auto& output) { return output.first == kind && output.second == name; });
}

bool can_encode(std::string_view kind, std::string_view protocol) {
  const std::optional<SourceKind> source = kind_named(kind);
  return source && can_encode(*source, protocol);
}

DeviceEncoder::DeviceEncoder(const Scenario& scenario, TimeNs power_on_ns)
    : scenario_(scenario), power_on_ns_(power_on_ns) {}

Bytes DeviceEncoder::encode(const Measurement& measurement) {
  const SensorSuite& sensors = scenario_.sensors;
  const TimeNs valid_ns = header_of(measurement).stamp_ns;
  const TimeNs sent_ns = header_of(measurement).received_ns;

  if (const auto* imu = std::get_if<ImuSample>(&measurement);
      imu != nullptr && !sensors.imu.protocol.empty()) {
    return encode::vectornav(*imu, valid_ns - power_on_ns_);
  }
  if (const auto* gps = std::get_if<GpsSample>(&measurement);
      gps != nullptr && !sensors.gps.protocol.empty()) {
    if (canonical(sensors.gps.protocol) == "ubx") return encode::ubx_nav_pvt(*gps, valid_ns);
    return bytes_of(encode::nmea_gps(*gps, valid_ns));
  }
  if (const auto* dvl = std::get_if<DvlSample>(&measurement);
      dvl != nullptr && !sensors.dvl.protocol.empty()) {
    if (canonical(sensors.dvl.protocol) == "waterlinked") {
      if (dvl->mode == DvlMode::water) return {};  // it has no word for it
      const double since_ms = last_dvl_ns_ == 0 ? kUnknown : to_seconds(valid_ns - last_dvl_ns_) * 1e3;
      last_dvl_ns_ = valid_ns;
      return bytes_of(encode::waterlinked(*dvl, {valid_ns, sent_ns, since_ms}));
    }
    return pd0(*dvl);
  }
  if (const auto* depth = std::get_if<DepthSample>(&measurement);
      depth != nullptr && !sensors.depth.protocol.empty()) {
    codec::CodecOptions options;
    options.latitude_rad = scenario_.start.latitude_rad;
    if (canonical(sensors.depth.protocol) == "ascii_depth")
      return bytes_of(encode::ascii_depth(*depth, options));
    return bytes_of(encode::paroscientific(*depth, options));
  }
  if (const auto* heading = std::get_if<HeadingSample>(&measurement);
      heading != nullptr && !sensors.heading.protocol.empty()) {
    return bytes_of(encode::nmea_heading(*heading));
  }
  if (const auto* usbl = std::get_if<UsblSample>(&measurement);
      usbl != nullptr && !sensors.usbl.protocol.empty()) {
    return bytes_of(encode::psimssb(*usbl, valid_ns));
  }
  if (const auto* propulsion = std::get_if<PropulsionSample>(&measurement);
      propulsion != nullptr && !sensors.propulsion.protocol.empty()) {
    return bytes_of(encode::nmea_rpm(*propulsion));
  }
  if (const auto* fins = std::get_if<FinsSample>(&measurement);
      fins != nullptr && !sensors.fins.protocol.empty()) {
    return bytes_of(encode::nmea_fins(*fins));
  }
  if (const auto* air = std::get_if<AirspeedSample>(&measurement);
      air != nullptr && !sensors.airspeed.protocol.empty()) {
    if (canonical(sensors.airspeed.protocol) == "nmea_air_data")
      return bytes_of(encode::nmea_air_data(*air, {}));
    return bytes_of(encode::ascii_air_data(*air, {}));
  }
  return {};
}

Bytes DeviceEncoder::pd0(const DvlSample& sample) {
  const TimeNs valid_ns = sample.header.stamp_ns;
  if (sample.mode == DvlMode::bottom && scenario_.sensors.dvl.water_layer) {
    ping_ = sample;  // the other half of the ensemble comes next
    return {};
  }
  encode::Pd0Options options;
  options.ensemble = ++ensemble_;
  if (sample.mode == DvlMode::bottom) return encode::pd0(sample, valid_ns, options);
  DvlSample bottom = sample;
  bottom.mode = DvlMode::bottom;
  if (ping_ && ping_->header.stamp_ns == valid_ns) {
    bottom = *ping_;
  } else {
    bottom.velocity_D_m_s.fill(kUnknown);
    bottom.beam_velocity_m_s.fill(kUnknown);
    bottom.beam_range_m.fill(kUnknown);
    bottom.error_velocity_m_s = bottom.altitude_m = kUnknown;
  }
  ping_.reset();
  return encode::pd0(bottom, valid_ns, options, &sample);
}

}  // namespace fathom::sim
