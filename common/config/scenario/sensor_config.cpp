#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "config/scenario/scenario_schema.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

constexpr double kDegree = std::numbers::pi / 180.0;

// The fields that every sensor has, as members of the sensor's own struct.
template <class T>
void common_fields(Schema<T>& s) {
  using C = sim::SensorCommon;
  s.field("enabled", static_cast<bool T::*>(&C::enabled), "the vehicle carries this sensor");
  s.field("protocol", static_cast<std::string T::*>(&C::protocol),
          "of the device bytes; empty: no device output");
  s.field("link", static_cast<sim::LinkConfig T::*>(&C::link), "where the device bytes leave the simulator");
  s.field("rate_hz", static_cast<double T::*>(&C::rate_hz), "samples per second")
      .unit("Hz")
      .range(0.01, 2000);
  s.field("phase_s", static_cast<double T::*>(&C::phase_s), "of the first sample after the start")
      .unit("s")
      .range(0, 60);
  s.field("latency_s", static_cast<double T::*>(&C::latency_s), "from validity to the last byte")
      .unit("s")
      .range(0, 60);
  s.field("jitter_s", static_cast<double T::*>(&C::jitter_s), "of the latency, uniform, on top of it")
      .unit("s")
      .range(0, 10);
  s.field("dropout_probability", static_cast<double T::*>(&C::dropout_probability), "a sample gets lost")
      .range(0, 1);
  s.field("outlier_probability", static_cast<double T::*>(&C::outlier_probability), "a sample is wrong")
      .range(0, 1);
  s.field("dropouts", static_cast<std::vector<sim::Window> T::*>(&C::dropouts),
          "spans of the run in which nothing usable is measured");
  s.field("lever_B_m", static_cast<std::array<double, 3> T::*>(&C::lever_B_m),
          "place of the sensor relative to the IMU: forward, right, down")
      .unit("m")
      .range(-100, 100);
  s.check([](const T& sensor) -> Fault {
    if (!sensor.protocol.empty() && sensor.link.port == 0 && sensor.link.path.empty()) {
      return {"link", "where the bytes of protocol " + sensor.protocol + " go"};
    }
    return {};
  });
}

}  // namespace

void describe(Schema<sim::Window>& s) {
  s.field("from_s", &sim::Window::from_s, "seconds since the start").unit("s").range(0, 1e6).required();
  s.field("to_s", &sim::Window::to_s, "seconds since the start").unit("s").range(0, 1e6).required();
  s.check([](const sim::Window& w) -> Fault {
    if (w.to_s <= w.from_s) return {"to_s", "later than from_s"};
    return {};
  });
}

void describe(Schema<sim::LinkConfig>& s) {
  using Type = sim::LinkConfig::Type;
  s.field("type", &sim::LinkConfig::type, "pseudo-terminal, TCP server or UDP sender")
      .words({{"pty", Type::pty}, {"tcp_server", Type::tcp_server}, {"udp", Type::udp}})
      .required();
  s.field("path", &sim::LinkConfig::path, "pty: name of the link below the simulator's link_dir");
  s.field("address", &sim::LinkConfig::address, "tcp_server: bound; udp: sent to");
  s.field("port", &sim::LinkConfig::port, "tcp_server, udp").range(0, 65535);
  s.check([](const sim::LinkConfig& link) -> Fault {
    if (link.type == Type::pty && link.path.empty()) return {"path", "a name for the pseudo-terminal"};
    if (link.type != Type::pty && link.port == 0) return {"port", "a port from 1 to 65535"};
    return {};
  });
}

void describe(Schema<sim::GyroConfig>& s) {
  using T = sim::TriadConfig;
  const double hour = 3600.0;
  const auto field = [&s](const char* key, double T::*member, const char* text) -> FieldRef<double> {
    return s.field(key, static_cast<double sim::GyroConfig::*>(member), text);
  };
  field("bias_sigma_deg_h", &T::bias_sigma, "turn-on bias, drawn once a run")
      .unit("deg/h")
      .scaled(kDegree / hour)
      .range(0, 1e5);
  field("instability_sigma_deg_h", &T::instability_sigma, "in-run bias, Gauss-Markov")
      .unit("deg/h")
      .scaled(kDegree / hour)
      .range(0, 1e5);
  field("instability_tau_s", &T::instability_tau_s, "its correlation time").unit("s").range(0.1, 1e6);
  field("random_walk_deg_sqrt_h", &T::random_walk, "white noise")
      .unit("deg/sqrt(h)")
      .scaled(kDegree / 60.0)
      .range(0, 100);
  field("vibration_deg_s", &T::vibration_sigma, "white noise of each sample")
      .unit("deg/s")
      .scaled(kDegree)
      .range(0, 100);
  field("scale_ppm", &T::scale_sigma, "scale error of each axis").unit("ppm").scaled(1e-6).range(0, 1e5);
  field("misalignment_mrad", &T::misalignment_sigma_rad, "each cross term")
      .unit("mrad")
      .scaled(1e-3)
      .range(0, 100);
  field("quantum_rad", &T::quantum, "of an increment (of a rate where only rates are given)")
      .unit("rad")
      .range(0, 1);
  field("range_deg_s", &T::range, "clip; 0: none").unit("deg/s").scaled(kDegree).range(0, 1e5);
}

void describe(Schema<sim::AccelerometerConfig>& s) {
  using T = sim::TriadConfig;
  constexpr double kMilliG = 9.80665e-3;
  const auto field = [&s](const char* key, double T::*member, const char* text) -> FieldRef<double> {
    return s.field(key, static_cast<double sim::AccelerometerConfig::*>(member), text);
  };
  field("bias_sigma_mg", &T::bias_sigma, "turn-on bias, drawn once a run")
      .unit("mg")
      .scaled(kMilliG)
      .range(0, 1e4);
  field("instability_sigma_mg", &T::instability_sigma, "in-run bias, Gauss-Markov")
      .unit("mg")
      .scaled(kMilliG)
      .range(0, 1e4);
  field("instability_tau_s", &T::instability_tau_s, "its correlation time").unit("s").range(0.1, 1e6);
  field("random_walk_m_s_sqrt_h", &T::random_walk, "white noise")
      .unit("m/s/sqrt(h)")
      .scaled(1.0 / 60.0)
      .range(0, 100);
  field("vibration_mg", &T::vibration_sigma, "white noise of each sample")
      .unit("mg")
      .scaled(kMilliG)
      .range(0, 1e4);
  field("scale_ppm", &T::scale_sigma, "scale error of each axis").unit("ppm").scaled(1e-6).range(0, 1e5);
  field("misalignment_mrad", &T::misalignment_sigma_rad, "each cross term")
      .unit("mrad")
      .scaled(1e-3)
      .range(0, 100);
  field("quantum_m_s", &T::quantum, "of an increment (of m/s^2 where only rates are given)")
      .unit("m/s")
      .range(0, 10);
  field("range_g", &T::range, "clip; 0: none").unit("g").scaled(9.80665).range(0, 1e5);
}

void describe(Schema<sim::ImuConfig>& s) {
  common_fields(s);
  s.field("gyro", &sim::ImuConfig::gyro, "error model of the gyros");
  s.field("accelerometer", &sim::ImuConfig::accelerometer, "error model of the accelerometers");
  s.field("increments", &sim::ImuConfig::increments,
          "true: increments over the interval and their mean rates; false: rates at the instant");
}

void describe(Schema<sim::GpsConfig>& s) {
  using C = sim::GpsConfig;
  common_fields(s);
  s.field("position_sigma_m", &C::position_sigma_m, "white error, north and east").unit("m").range(0, 1e3);
  s.field("altitude_sigma_m", &C::altitude_sigma_m, "white error").unit("m").range(0, 1e3);
  s.field("correlated_sigma_m", &C::correlated_sigma_m, "slow error, north and east").unit("m").range(0, 1e3);
  s.field("correlated_altitude_sigma_m", &C::correlated_altitude_sigma_m, "slow error")
      .unit("m")
      .range(0, 1e3);
  s.field("correlated_tau_s", &C::correlated_tau_s, "correlation time of the slow error")
      .unit("s")
      .range(0.1, 1e6);
  s.field("velocity_sigma_m_s", &C::velocity_sigma_m_s, "north and east").unit("m/s").range(0, 100);
  s.field("velocity_down_sigma_m_s", &C::velocity_down_sigma_m_s, "down").unit("m/s").range(0, 100);
  s.field("outlier_m", &C::outlier_m, "size of a wrong fix").unit("m").range(0, 1e6);
  s.field("reacquire_s", &C::reacquire_s, "from the antenna's return to the air to a fix")
      .unit("s")
      .range(0, 600);
  s.field("antenna_clearance_m", &C::antenna_clearance_m, "least height of the antenna above the water")
      .unit("m")
      .range(-1, 10);
}

void describe(Schema<sim::DvlConfig>& s) {
  using C = sim::DvlConfig;
  using Frame = C::Frame;
  common_fields(s);
  s.field("beam_angle_deg", &C::beam_angle_rad, "of the beams from the instrument's down axis")
      .unit("deg")
      .scaled(kDegree)
      .range(5, 60);
  s.field("beam_sigma_m_s", &C::beam_sigma_m_s, "white error of each beam").unit("m/s").range(0, 10);
  s.field("beam_sigma_per_speed", &C::beam_sigma_per_speed, "and this share of the speed").range(0, 1);
  s.field("scale_sigma", &C::scale_sigma, "scale error, drawn once a run").range(0, 0.5);
  s.field("scale", &C::scale, "known part of it").range(-0.5, 0.5);
  s.field("bias_sigma_m_s", &C::bias_sigma_m_s, "offset of each axis, drawn once a run")
      .unit("m/s")
      .range(0, 10);
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad, "attitude of the instrument's axes in the body")
      .unit("deg")
      .scaled(kDegree)
      .range(-180, 180);
  s.field("misalignment_sigma_deg", &C::misalignment_sigma_rad, "error of that, each axis, drawn once a run")
      .unit("deg")
      .scaled(kDegree)
      .range(0, 20);
  s.field("minimum_range_m", &C::minimum_range_m, "height above the bottom").unit("m").range(0, 1e3);
  s.field("maximum_range_m", &C::maximum_range_m, "along a beam").unit("m").range(1, 1e4);
  s.field("beam_dropout_probability", &C::beam_dropout_probability, "each beam of each ping").range(0, 1);
  s.field("working_beams", &C::working_beams, "3: the one astern is dead, 2: the one to starboard as well")
      .range(2, 4);
  s.field("water_track", &C::water_track, "pings that do not reach the bottom measure against the water");
  s.field("water_layer", &C::water_layer, "each ping measures against the water layer as well");
  s.field("bottom_lost", &C::bottom_lost, "when the bottom gives no echo; the water layer does");
  s.field("outlier_m_s", &C::outlier_m_s, "size of a wrong velocity").unit("m/s").range(0, 100);
  s.field("sound_speed_m_s", &C::sound_speed_m_s, "that the instrument uses").unit("m/s").range(1300, 1700);
  s.field("frame", &C::frame, "of the recorded velocities")
      .words({{"instrument", Frame::instrument}, {"ship", Frame::ship}, {"beam", Frame::beam}});
}

void describe(Schema<sim::DepthConfig>& s) {
  using C = sim::DepthConfig;
  common_fields(s);
  s.field("bias_sigma_m", &C::bias_sigma_m, "drawn once a run").unit("m").range(0, 100);
  s.field("sigma_m", &C::sigma_m, "white error").unit("m").range(0, 100);
  s.field("wet_only", &C::wet_only, "switched on by the water: silent in the air");
  s.field("quantum_m", &C::quantum_m, "resolution").unit("m").range(0, 10);
  s.field("outlier_m", &C::outlier_m, "size of a wrong depth").unit("m").range(0, 1e4);
}

void describe(Schema<sim::HeadingConfig>& s) {
  using C = sim::HeadingConfig;
  common_fields(s);
  s.field("bias_sigma_deg", &C::bias_sigma_rad, "drawn once a run").unit("deg").scaled(kDegree).range(0, 180);
  s.field("sigma_deg", &C::sigma_rad, "white error").unit("deg").scaled(kDegree).range(0, 180);
  s.field("deviation_deg", &C::deviation_rad, "A, B sin, C cos, D sin 2, E cos 2 of the heading")
      .unit("deg")
      .scaled(kDegree)
      .range(-90, 90);
  s.field("magnetic", &C::magnetic, "a magnetic compass; false: true north");
  s.field("outlier_deg", &C::outlier_rad, "size of a wrong heading")
      .unit("deg")
      .scaled(kDegree)
      .range(0, 180);
}

void describe(Schema<sim::UsblConfig>& s) {
  using C = sim::UsblConfig;
  common_fields(s);
  s.field("range_fraction", &C::range_fraction, "error of each axis as a share of the slant range")
      .range(0, 1);
  s.field("floor_m", &C::floor_m, "least error").unit("m").range(0, 1e3);
  s.field("maximum_latency_s", &C::maximum_latency_s, "latency is uniform between latency_s and this")
      .unit("s")
      .range(0, 60);
  s.field("outlier_m", &C::outlier_m, "size of a multipath error").unit("m").range(0, 1e5);
  s.field("minimum_depth_m", &C::minimum_depth_m, "the transponder is not heard above it")
      .unit("m")
      .range(-10, 1e3);
  s.field("ship_N_m", &C::ship_N_m, "transceiver: north and east of the start, down from the surface")
      .unit("m")
      .range(-1e5, 1e5);
  s.field("ship_velocity_N_m_s", &C::ship_velocity_N_m_s, "of the ship: north, east, down")
      .unit("m/s")
      .range(-50, 50);
  s.field("ship_rpy_deg", &C::ship_rpy_rad, "attitude of the ship")
      .unit("deg")
      .scaled(kDegree)
      .range(-360, 360);
  s.field("ship_sigma_m", &C::ship_sigma_m, "error of the ship's place as it is sent, each axis")
      .unit("m")
      .range(0, 1e3);
  s.field("output", &C::output,
          "place of the transponder; components along north or along the ship; range and direction along the "
          "ship; or of a beacon in the ship's place along the vehicle, which carries the transceiver")
      .words({{"geodetic", C::Output::geodetic},
              {"ned", C::Output::ned},
              {"vessel", C::Output::vessel},
              {"range_bearing", C::Output::range_bearing},
              {"inverted", C::Output::inverted}});
  s.field("angle_sigma_deg", &C::angle_sigma_rad, "error of a direction, across it")
      .unit("deg")
      .scaled(kDegree)
      .range(0, 90);
  s.field("misalignment_sigma_deg", &C::misalignment_sigma_rad,
          "error of the transceiver's axes, each axis, drawn once a run")
      .unit("deg")
      .scaled(kDegree)
      .range(0, 20);
  s.check([](const C& usbl) -> Fault {
    const bool polar = usbl.output == C::Output::range_bearing || usbl.output == C::Output::inverted;
    if (polar && !usbl.protocol.empty()) return {"output", "geodetic, ned or vessel for a device protocol"};
    return {};
  });
}

void describe(Schema<sim::PropulsionConfig>& s) {
  common_fields(s);
  s.field("sigma_rpm", &sim::PropulsionConfig::sigma_rpm, "white error").unit("rpm").range(0, 1e4);
  s.field("scale_sigma", &sim::PropulsionConfig::scale_sigma, "scale error, drawn once a run").range(0, 1);
}

void describe(Schema<sim::FinsConfig>& s) {
  common_fields(s);
  s.field("sigma_deg", &sim::FinsConfig::sigma_rad, "white error").unit("deg").scaled(kDegree).range(0, 90);
  s.field("bias_sigma_deg", &sim::FinsConfig::bias_sigma_rad, "drawn once a run")
      .unit("deg")
      .scaled(kDegree)
      .range(0, 90);
}

void describe(Schema<sim::AirspeedConfig>& s) {
  using C = sim::AirspeedConfig;
  common_fields(s);
  s.field("scale_sigma", &C::scale_sigma, "scale error, drawn once a run").range(0, 1);
  s.field("sigma_m_s", &C::sigma_m_s, "white error").unit("m/s").range(0, 100);
  s.field("baro_sigma_m", &C::baro_sigma_m, "white error of the barometric altitude").unit("m").range(0, 1e3);
  s.field("baro_bias_sigma_m", &C::baro_bias_sigma_m, "its bias, drawn once a run").unit("m").range(0, 1e3);
}

void describe(Schema<sim::SensorSuite>& s) {
  using C = sim::SensorSuite;
  s.field("imu", &C::imu, "inertial measurement unit at the body origin");
  s.field("gps", &C::gps, "satellite receiver");
  s.field("dvl", &C::dvl, "Doppler velocity log");
  s.field("depth", &C::depth, "pressure sensor");
  s.field("heading", &C::heading, "compass or gyrocompass");
  s.field("usbl", &C::usbl, "acoustic positioning from a ship");
  s.field("propulsion", &C::propulsion, "shaft speed");
  s.field("fins", &C::fins, "fin angles");
  s.field("airspeed", &C::airspeed, "air data");
}

}  // namespace fathom::config
