#pragma once

#include "archive/visitor.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/command.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/usbl.hpp"

/// Fields of the samples. Their numbers may be any: a sample out of an archive is judged when it acts, as one
/// that has just come from the network.
namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, SampleHeader>
void fields(Archive& archive, Self& self) {
  archive("vehicle", self.vehicle);
  archive("sensor", self.sensor);
  archive("stamp_ns", self.stamp_ns, fathom::archive::kAnyWhole);
  archive("received_ns", self.received_ns, fathom::archive::kAnyWhole);
  archive("sequence", self.sequence);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Command>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("kind", self.kind, CommandKind::mark_at_rest);
  archive("target", self.target);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("depth_m", self.depth_m, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("value_s", self.value_s, kAny);
  if (archive.since(2)) archive("confirmed", self.confirmed);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, GpsSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("fix", self.fix, GpsFix::rtk_fixed);
  archive("satellites", self.satellites, fathom::archive::kAnyWhole);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("altitude_m", self.altitude_m, kAny);
  archive("altitude_msl_m", self.altitude_msl_m, kAny);
  archive("position_sigma_N_m", self.position_sigma_N_m, kAny);
  archive("velocity_N_m_s", self.velocity_N_m_s, kAny);
  archive("velocity_sigma_N_m_s", self.velocity_sigma_N_m_s, kAny);
  archive("hdop", self.hdop, kAny);
  archive("course_rad", self.course_rad, kAny);
  archive("jamming", self.jamming, GpsJamming::critical);
  archive("spoofing", self.spoofing, GpsSpoofing::affirmed);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, DvlSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("mode", self.mode, DvlMode::water);
  archive("recorded_frame", self.recorded_frame, DvlFrame::earth);
  archive("velocity_D_m_s", self.velocity_D_m_s, kAny);
  archive("error_velocity_m_s", self.error_velocity_m_s, kAny);
  archive("sigma_m_s", self.sigma_m_s, kAny);
  archive("beam_velocity_m_s", self.beam_velocity_m_s, kAny);
  archive("beam_range_m", self.beam_range_m, kAny);
  archive("beam_angle_rad", self.beam_angle_rad, kAny);
  archive("altitude_m", self.altitude_m, kAny);
  archive("sound_speed_m_s", self.sound_speed_m_s, kAny);
  archive("roll_rad", self.roll_rad, kAny);
  archive("pitch_rad", self.pitch_rad, kAny);
  archive("heading_rad", self.heading_rad, kAny);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, DepthSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("depth_m", self.depth_m, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("pressure_Pa", self.pressure_Pa, kAny);
  archive("temperature_degC", self.temperature_degC, kAny);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, HeadingSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("north", self.north, North::magnetic);
  archive("heading_rad", self.heading_rad, kAny);
  archive("sigma_rad", self.sigma_rad, kAny);
  archive("variation_rad", self.variation_rad, kAny);
  archive("deviation_rad", self.deviation_rad, kAny);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, UsblSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("frame", self.frame, UsblFrame::vehicle_frd);
  archive("transponder", self.transponder);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("depth_m", self.depth_m, kAny);
  archive("relative_m", self.relative_m, kAny);
  archive("range_m", self.range_m, kAny);
  archive("bearing_rad", self.bearing_rad, kAny);
  archive("depression_rad", self.depression_rad, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("sigma_rad", self.sigma_rad, kAny);
  archive("travel_time_s", self.travel_time_s, kAny);
  archive("station_latitude_rad", self.station_latitude_rad, kAny);
  archive("station_longitude_rad", self.station_longitude_rad, kAny);
  archive("station_depth_m", self.station_depth_m, kAny);
  archive("station_rpy_rad", self.station_rpy_rad, kAny);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, AirspeedSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("airspeed_m_s", self.airspeed_m_s, kAny);
  archive("baro_altitude_m", self.baro_altitude_m, kAny);
  archive("sigma_m_s", self.sigma_m_s, kAny);
  archive("true_airspeed_m_s", self.true_airspeed_m_s, kAny);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, PropulsionSample>
void fields(Archive& archive, Self& self) {
  archive("header", self.header);
  archive("rpm", self.rpm, fathom::archive::any_number());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, FinsSample>
void fields(Archive& archive, Self& self) {
  archive("header", self.header);
  archive("rudder_rad", self.rudder_rad, fathom::archive::any_number());
  archive("stern_rad", self.stern_rad, fathom::archive::any_number());
}

}  // namespace fathom
