#pragma once

// Description of an aiding instrument. Which kinds know a key stands beside it.

#include <concepts>

#include "base/field.hpp"
#include "base/units.hpp"
#include "estimation/engine_config.hpp"
#include "samples/kinds.hpp"

namespace fathom::estimation {

/// The words of these kinds.
[[nodiscard]] inline std::vector<std::string> kinds(std::same_as<SourceKind> auto... kind) {
  return {std::string(to_string(kind))...};
}

/// The words of all aiding kinds but these.
[[nodiscard]] inline std::vector<std::string> kinds_but(std::same_as<SourceKind> auto... kind) {
  std::vector<std::string> out;
  for_each_aiding_kind([&](auto row) {
    if (((row.kSource != kind) && ...)) out.emplace_back(row.kWord);
  });
  return out;
}

[[nodiscard]] inline std::vector<std::pair<std::string, SourceKind>> aiding_kind_words() {
  std::vector<std::pair<std::string, SourceKind>> out;
  for_each_aiding_kind([&](auto row) { out.emplace_back(row.kWord, row.kSource); });
  return out;
}

template <template <class> class Walk>
void describe(Walk<SensorConfig>& s) {
  using C = SensorConfig;
  using enum SourceKind;
  s.field("sensor", &C::sensor, "name in the instrument's samples").name().required();
  s.field("kind", &C::kind, "what it measures").words(aiding_kind_words()).decides().required();
  s.field("enabled", &C::enabled, "false: its samples are judged source_disabled");
  s.field("lever_B_m", &C::lever_B_m, "from the inertial unit to the instrument, forward, right, down")
      .unit("m")
      .range(-1000, 1000)
      .only_for(kinds(gps, dvl, depth, usbl, propulsion, range, fix))
      .required_for(kinds(gps, dvl, depth, usbl, range));
  s.field(
       "mounting_rpy_deg", &C::mounting_rpy_rad,
       "roll, pitch, yaw of the instrument's axes in the body frame; of a transceiver on a ship in that ship")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .only_for(kinds(dvl, heading, usbl))
      .required_for(kinds(dvl));
  s.field("latency_s", &C::latency_s, "subtracted from the stamp").unit("s").range(-10, 60);
  s.field("sigma_m", &C::sigma, "noise north, east, down; of a depth and of a range the first counts")
      .unit("m")
      .range(1e-6, 1e6)
      .only_for(kinds(gps, depth, usbl, range, fix));
  s.field("sigma_m_s", &C::sigma, "noise along x, y, z; of an airspeed the first counts")
      .unit("m/s")
      .range(1e-6, 1e6)
      .only_for(kinds(dvl, airspeed, propulsion));
  s.field("sigma_deg", &C::sigma, "noise; the first counts")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg)
      .only_for(kinds(heading));
  s.field("velocity_sigma_m_s", &C::velocity_sigma_m_s, "noise of the velocity north, east, down")
      .unit("m/s")
      .range(1e-6, 1e3)
      .only_for(kinds(gps));
  s.field("proportional_sigma", &C::proportional_sigma, "added to the noise times the magnitude measured")
      .range(0, 10)
      .only_for(kinds(dvl, depth, usbl, airspeed, propulsion, range));
  s.field("max_noise_factor", &C::max_noise_factor,
          "where it scatters more than is said of it, its sigmas count up to so many times; 1: as said")
      .range(1, 100)
      .only_for(kinds_but(fins, fix));
  s.field("use_sample_sigma", &C::use_sample_sigma, "a larger noise in the sample counts")
      .only_for(kinds_but(propulsion, fins));
  s.field("use_position", &C::use_position, "its position aids").only_for(kinds(gps));
  s.field("use_velocity", &C::use_velocity, "its velocity aids").only_for(kinds(gps));
  s.field("min_fix", &C::min_fix, "lowest quality used: 3 2D, 4 3D, 5 differential, 6 RTK float, 7 RTK fixed")
      .range(0, 7)
      .only_for(kinds(gps));
  s.field("refuse_spoofed", &C::refuse_spoofed,
          "a fix of which the receiver itself affirms that it is spoofed is out of range")
      .only_for(kinds(gps));
  s.field("gate_probability", &C::gate_probability,
          "share of good measurements that pass the gate; 1: no gate")
      .range(0.5, 1.0)
      .only_for(kinds_but(fins));
  s.field("gate_mode", &C::gate_mode, "judge a measurement as a whole or each component")
      .words({{"whole", GateMode::whole}, {"per_component", GateMode::per_component}})
      .only_for(kinds_but(fins));
  s.field("robust", &C::robust, "weigh doubtful measurements down instead of refusing them")
      .words({{"none", RobustKind::none}, {"huber", RobustKind::huber}, {"student_t", RobustKind::student_t}})
      .only_for(kinds_but(fins));
  s.field("robust_parameter", &C::robust_parameter,
          "student_t: degrees of freedom; huber: threshold in sigmas")
      .range(0.1, 1e3)
      .only_for(kinds_but(fins));
  s.field("robust_reject_ratio", &C::robust_reject_ratio,
          "a robustly weighted measurement is refused all the same above this plain test ratio")
      .range(1, 1e9)
      .only_for(kinds_but(fins));
  s.field("reacquire_s", &C::reacquire_s, "consistent rejections for this long are believed")
      .unit("s")
      .range(0, 1e6)
      .only_for(kinds_but(fins));
  s.field(
       "dispute_s", &C::dispute_s,
       "fixes that agree with each other and with the motion, and headings that agree with each other, but "
       "lie further off than the estimate's uncertainty can explain, are believed after this time at the "
       "latest; 0: fixes never, a person has to decide, headings by the other rules alone")
      .unit("s")
      .range(0, 1e6)
      .only_for(kinds(gps, heading));
  s.field("reacquire_step_m", &C::reacquire_step_m,
          "behind an outage a fix further off than this has to agree with the motion for reacquire_s first, "
          "and no fix moves the position by more than twice this at once")
      .unit("m")
      .range(0.1, 1e6)
      .only_for(kinds(gps));
  s.field(
       "frozen_change", &C::frozen_change,
       "the same reading while the prediction moves by this much is frozen, in the sensor's SI unit; 0: off")
      .range(0, 1e6)
      .only_for(kinds_but(propulsion, fins));
  s.field(
       "two_antenna", &C::two_antenna,
       "from two GPS antennas, mounting_rpy_deg being the direction from the rear one to the front one; its "
       "own sigma counts at the start, the compass's states do not apply to it")
      .only_for(kinds(heading));
  s.field("angle_sigma_deg", &C::angle_sigma_rad, "noise of a direction, across it")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg)
      .only_for(kinds(usbl));
  s.field("transceiver_known", &C::transceiver_known,
          "the transceiver, or the beacon that the vehicle hears, is at the place that follows; a place that "
          "comes with the fix or range goes before it")
      .only_for(kinds(usbl, range));
  s.field("transceiver_latitude_deg", &C::transceiver_latitude_rad, "latitude for transceiver_known")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .only_for(kinds(usbl, range));
  s.field("transceiver_longitude_deg", &C::transceiver_longitude_rad, "longitude for transceiver_known")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .only_for(kinds(usbl, range));
  s.field("transceiver_depth_m", &C::transceiver_depth_m,
          "depth for transceiver_known and for fixes that come with a place but no depth, below the surface")
      .unit("m")
      .range(-1000, 12'000)
      .only_for(kinds(usbl, range));
  s.field("sideslip_sigma_deg", &C::sideslip_sigma_rad,
          "the aircraft flies straight into the air but for its sideslip state and this; 0: not used")
      .unit("deg")
      .range(0, 57)
      .scaled(kRadPerDeg)
      .only_for(kinds(airspeed));
  s.field("attack_sigma_deg", &C::attack_sigma_rad,
          "the aircraft flies level in the air but for its angle of attack state and this; 0: not used")
      .unit("deg")
      .range(0, 57)
      .scaled(kRadPerDeg)
      .only_for(kinds(airspeed));
  s.field("gust_time_s", &C::gust_time_s,
          "time for which a gust lasts, along and across; 0: its sigmas are noise of a sample")
      .unit("s")
      .range(0, 1000)
      .only_for(kinds(airspeed));
  s.field("baro_sigma_m", &C::baro_sigma_m, "noise of the barometric height in its samples; 0: not used")
      .unit("m")
      .range(0, 1e4)
      .only_for(kinds(airspeed));
  s.field("use_beams", &C::use_beams,
          "each beam on its own, one to four of them, where the sample carries them")
      .only_for(kinds(dvl));
  s.field("beam_angle_deg", &C::beam_angle_rad,
          "of the beams from the instrument's down axis, where the sample does not say")
      .unit("deg")
      .range(3, 80)
      .scaled(kRadPerDeg)
      .only_for(kinds(dvl));
  s.field("beam_azimuth_deg", &C::beam_azimuth_rad,
          "where each of the four beams points, from forward towards right")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .only_for(kinds(dvl));
  s.field("scale_m_s_per_rpm", &C::scale_m_s_per_rpm, "water speed per shaft speed; 0: not used")
      .unit("m/s/rpm")
      .range(-10, 10)
      .only_for(kinds(propulsion));
  s.field("min_depth_m", &C::min_depth_m, "shaft speed means nothing above this depth")
      .unit("m")
      .range(-1000, 12'000)
      .only_for(kinds(propulsion));
  s.field("slip_time_s", &C::slip_time_s,
          "time for which slip along and across lasts; 0: it is noise of a sample")
      .unit("s")
      .range(0, 1000)
      .only_for(kinds(propulsion));
}

}  // namespace fathom::estimation
