#include <numbers>
#include <string>

#include "config/fusion/engine_schema.hpp"

namespace fathom::config {

using namespace estimation;

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

const std::vector<std::pair<std::string, SourceKind>>& aiding_kinds() {
  static const std::vector<std::pair<std::string, SourceKind>> kinds{{"gps", SourceKind::gps},
                                                                     {"dvl", SourceKind::dvl},
                                                                     {"depth", SourceKind::depth},
                                                                     {"heading", SourceKind::heading},
                                                                     {"usbl", SourceKind::usbl},
                                                                     {"airspeed", SourceKind::airspeed},
                                                                     {"propulsion", SourceKind::propulsion},
                                                                     {"fins", SourceKind::fins}};
  return kinds;
}

// The key that states a sensor's noise in the unit of what it measures.
std::string sigma_key(SourceKind kind) {
  switch (kind) {
    case SourceKind::heading:
      return "sigma_deg";
    case SourceKind::dvl:
    case SourceKind::airspeed:
    case SourceKind::propulsion:
      return "sigma_m_s";
    default:
      return "sigma_m";
  }
}

}  // namespace

void describe(Schema<SensorConfig>& s) {
  using C = SensorConfig;
  s.field("sensor", &C::sensor, "name in the instrument's samples").name().required();
  s.field("kind", &C::kind, "what it measures").words(aiding_kinds()).required();
  s.field("enabled", &C::enabled, "false: its samples are judged source_disabled");
  s.field("lever_B_m", &C::lever_B_m,
          "from the inertial unit to the instrument, forward, right, down; must be given for gps, dvl, "
          "depth, usbl")
      .unit("m")
      .range(-1000, 1000);
  s.field(
       "mounting_rpy_deg", &C::mounting_rpy_rad,
       "roll, pitch, yaw of the instrument's axes in the body frame, of a usbl transceiver in its ship; must "
       "be given for dvl")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("latency_s", &C::latency_s, "subtracted from the stamp").unit("s").range(-10, 60);
  s.field("sigma_m", &C::sigma, "noise: gps and usbl north, east, down; depth and usbl range in the first")
      .unit("m")
      .range(1e-6, 1e6);
  s.field("sigma_m_s", &C::sigma, "noise: dvl and propulsion x, y, z; airspeed in the first")
      .unit("m/s")
      .range(1e-6, 1e6);
  s.field("sigma_deg", &C::sigma, "noise: heading in the first")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg);
  s.field("velocity_sigma_m_s", &C::velocity_sigma_m_s, "noise of the GPS velocity north, east, down")
      .unit("m/s")
      .range(1e-6, 1e3);
  s.field("proportional_sigma", &C::proportional_sigma, "added to the noise times the magnitude measured")
      .range(0, 10);
  s.field("use_sample_sigma", &C::use_sample_sigma, "a larger figure in the sample counts");
  s.field("use_position", &C::use_position, "gps");
  s.field("use_velocity", &C::use_velocity, "gps");
  s.field("min_fix", &C::min_fix,
          "gps: lowest quality used: 3 2D, 4 3D, 5 differential, 6 RTK float, 7 RTK fixed")
      .range(0, 7);
  s.field("refuse_spoofed", &C::refuse_spoofed,
          "gps: a fix of which the receiver itself affirms that it is spoofed is out of range");
  s.field("gate_probability", &C::gate_probability,
          "share of good measurements that pass the gate; 1: no gate")
      .range(0.5, 1.0);
  s.field("gate_mode", &C::gate_mode, "judge a measurement as a whole or each component")
      .words({{"whole", GateMode::whole}, {"per_component", GateMode::per_component}});
  s.field("robust", &C::robust, "weigh doubtful measurements down instead of refusing them")
      .words(
          {{"none", RobustKind::none}, {"huber", RobustKind::huber}, {"student_t", RobustKind::student_t}});
  s.field("robust_parameter", &C::robust_parameter,
          "student_t: degrees of freedom; huber: threshold in sigmas")
      .range(0.1, 1e3);
  s.field("robust_reject_ratio", &C::robust_reject_ratio,
          "a robustly weighted measurement is refused all the same above this plain test ratio")
      .range(1, 1e9);
  s.field("reacquire_s", &C::reacquire_s, "consistent rejections for this long are believed")
      .unit("s")
      .range(0, 1e6);
  s.field(
       "dispute_s", &C::dispute_s,
       "GPS: fixes that agree with each other and with the motion, but lie further off than the estimate's "
       "uncertainty can explain, are believed after this time at the latest; 0: never, a person has to "
       "decide")
      .unit("s")
      .range(0, 1e6);
  s.field("reacquire_step_m", &C::reacquire_step_m,
          "GPS: behind an outage a fix further off than this has to agree with the motion for reacquire_s "
          "first, "
          "and no fix moves the position by more than twice this at once")
      .unit("m")
      .range(0.1, 1e6);
  s.field(
       "frozen_change", &C::frozen_change,
       "the same reading while the prediction moves by this much is frozen, in the sensor's SI unit; 0: off")
      .range(0, 1e6);
  s.field(
      "two_antenna", &C::two_antenna,
      "heading: from two GPS antennas, mounting_rpy_deg being the direction from the rear one to the front "
      "one; its own sigma counts at the start, the compass's states do not apply to it");
  s.field("angle_sigma_deg", &C::angle_sigma_rad, "usbl: noise of a direction, across it")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg);
  s.field("transceiver_known", &C::transceiver_known,
          "usbl: the transceiver, or the beacon that the vehicle's own transceiver looks at, is at the place "
          "that follows; a place that comes with the fix goes before it");
  s.field("transceiver_latitude_deg", &C::transceiver_latitude_rad, "usbl: for transceiver_known")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg);
  s.field("transceiver_longitude_deg", &C::transceiver_longitude_rad, "usbl: for transceiver_known")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("transceiver_depth_m", &C::transceiver_depth_m,
          "usbl: for transceiver_known and for fixes that come with a place but no depth, below the surface")
      .unit("m")
      .range(-1000, 12'000);
  s.field(
       "sideslip_sigma_deg", &C::sideslip_sigma_rad,
       "airspeed: the aircraft flies straight into the air but for its sideslip state and this; 0: not used")
      .unit("deg")
      .range(0, 57)
      .scaled(kRadPerDeg);
  s.field("attack_sigma_deg", &C::attack_sigma_rad, "airspeed: likewise the angle of attack; 0: not used")
      .unit("deg")
      .range(0, 57)
      .scaled(kRadPerDeg);
  s.field("gust_time_s", &C::gust_time_s,
          "airspeed: for which a gust lasts, along and across; 0: its sigmas are noise of a sample")
      .unit("s")
      .range(0, 1000);
  s.field("baro_sigma_m", &C::baro_sigma_m,
          "airspeed: noise of the barometric height in its samples; 0: not used")
      .unit("m")
      .range(0, 1e4);
  s.field("use_beams", &C::use_beams,
          "dvl: each beam on its own, one to four of them, where the sample carries them");
  s.field("beam_angle_deg", &C::beam_angle_rad,
          "dvl: of the beams from the instrument's down axis, where the sample does not say")
      .unit("deg")
      .range(3, 80)
      .scaled(kRadPerDeg);
  s.field("beam_azimuth_deg", &C::beam_azimuth_rad,
          "dvl: where each of the four beams points, from forward towards right")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("scale_m_s_per_rpm", &C::scale_m_s_per_rpm, "propulsion: water speed per shaft speed; 0: not used")
      .unit("m/s/rpm")
      .range(-10, 10);
  s.field("min_depth_m", &C::min_depth_m, "propulsion: shaft speed means nothing above it")
      .unit("m")
      .range(-1000, 12'000);
  s.field("slip_time_s", &C::slip_time_s,
          "propulsion: for which slip along and across lasts; 0: noise of a sample")
      .unit("s")
      .range(0, 1000);
}

void load_value(const nlohmann::json& json, SensorConfig& out, const Rules<SensorConfig>&,
                const Place& place) {
  if (!json.is_object()) place.fail(json, "an object");
  SourceKind kind = SourceKind::gps;
  if (!json.contains("kind")) place.child("kind").fail_missing("what the instrument measures");
  load_value(json.at("kind"), kind, Rules<SourceKind>{.words = aiding_kinds()}, place.child("kind"));
  out = default_sensor(kind, "");
  const bool lever = kind == SourceKind::gps || kind == SourceKind::dvl || kind == SourceKind::depth ||
                     kind == SourceKind::usbl;
  if (lever && !json.contains("lever_B_m")) {
    place.child("lever_B_m")
        .fail_missing("the instrument's place from the inertial unit, forward, right, down in m");
  }
  if (kind == SourceKind::dvl && !json.contains("mounting_rpy_deg")) {
    place.child("mounting_rpy_deg")
        .fail_missing("roll, pitch, yaw of the instrument's axes in the body frame in deg");
  }
  for (const char* key : {"sigma_m", "sigma_m_s", "sigma_deg"}) {
    if (json.contains(key) && key != sigma_key(kind)) {
      place.child(key).fail(json.at(key), "the key " + sigma_key(kind) + " for this kind");
    }
  }
  schema_of<SensorConfig>().load(json, out, place);
}

}  // namespace fathom::config
