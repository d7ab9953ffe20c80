#pragma once

#include <array>
#include <string>
#include <vector>

namespace fathom::sim {

/// A span of the run, seconds since its start: [from_s, to_s).
struct Window {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// Where the device bytes of a sensor leave the simulator.
struct LinkConfig {
  enum class Type { pty, tcp_server, udp };
  Type type = Type::udp;
  std::string path;                   ///< pty: name of the link below the simulator's link_dir
  std::string address = "127.0.0.1";  ///< tcp_server: bound; udp: sent to
  int port = 0;
};

/// What every sensor has.
struct SensorCommon {
  bool enabled = false;
  std::string protocol;  ///< of the device bytes; empty: the sensor has no device output
  LinkConfig link;
  double rate_hz = 1.0;
  double phase_s = 0.0;                            ///< of the first sample
  double latency_s = 0.0;                          ///< from validity to the last byte sent
  double jitter_s = 0.0;                           ///< uniform, on top of the latency
  double dropout_probability = 0.0;                ///< per sample
  double outlier_probability = 0.0;                ///< per sample
  std::vector<Window> dropouts;                    ///< nothing usable in these spans
  std::array<double, 3> lever_B_m{0.0, 0.0, 0.0};  ///< sensor relative to the body origin
};

/// One triad of inertial sensors. x_out = (I + scale)(I + misalignment) x + bias + noise, each axis.
struct TriadConfig {
  double bias_sigma = 0.0;              ///< turn-on, drawn once a run; rad/s or m/s^2
  double instability_sigma = 0.0;       ///< in-run, first-order Gauss-Markov; rad/s or m/s^2
  double instability_tau_s = 3600.0;    ///< its correlation time
  double random_walk = 0.0;             ///< white noise density; rad/sqrt(s) or (m/s)/sqrt(s)
  double vibration_sigma = 0.0;         ///< white noise of each sample, whatever the rate; rad/s or m/s^2
  double scale_sigma = 0.0;             ///< per axis
  double misalignment_sigma_rad = 0.0;  ///< each of the six cross terms
  double quantum = 0.0;                 ///< of an increment (rad, m/s) or a point sample (rad/s, m/s^2)
  double range = 0.0;                   ///< clip, rad/s or m/s^2; 0 none
};

struct GyroConfig : TriadConfig {};
struct AccelerometerConfig : TriadConfig {};

struct ImuConfig : SensorCommon {
  GyroConfig gyro;
  AccelerometerConfig accelerometer;
  /// True: increments over the sample interval and their mean rates, as a strapdown unit gives. False: rates
  /// at the instant only.
  bool increments = true;
};

struct GpsConfig : SensorCommon {
  double position_sigma_m = 0.5;    ///< white, north and east
  double altitude_sigma_m = 0.8;    ///< white
  double correlated_sigma_m = 1.0;  ///< Gauss-Markov, north and east
  double correlated_altitude_sigma_m = 1.5;
  double correlated_tau_s = 120.0;
  double velocity_sigma_m_s = 0.05;
  double velocity_down_sigma_m_s = 0.1;
  double outlier_m = 50.0;
  double reacquire_s = 2.5;           ///< from the antenna's return to the air to the first fix
  double antenna_clearance_m = 0.03;  ///< least height of the antenna above the water
};

struct DvlConfig : SensorCommon {
  double beam_angle_rad = 0.523598775598298873;     ///< from the instrument's down axis: 30 degrees
  double beam_sigma_m_s = 0.003;                    ///< white
  double beam_sigma_per_speed = 0.002;              ///< share of the speed, added in quadrature
  double scale_sigma = 0.0;                         ///< one factor, drawn once a run
  double scale = 0.0;                               ///< known part of it
  double bias_sigma_m_s = 0.0;                      ///< offset of each axis, drawn once a run
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};  ///< rotation of the DVL's axes against the body
  double misalignment_sigma_rad = 0.0;              ///< unknown part of it, each axis
  double minimum_range_m = 0.5;
  double maximum_range_m = 200.0;
  double beam_dropout_probability = 0.0;  ///< each beam of each ping
  int working_beams = 4;                  ///< 3: the one astern is dead, 2: the one to starboard as well
  bool water_track = false;               ///< pings that do not reach the bottom measure against the water
  bool water_layer = false;               ///< each ping measures against the water layer as well
  std::vector<Window> bottom_lost;        ///< the bottom gives no echo; the water layer does
  double outlier_m_s = 1.0;
  double sound_speed_m_s = 1500.0;
  enum class Frame { instrument, ship, beam };
  Frame frame = Frame::instrument;  ///< of the recorded bytes
};

struct DepthConfig : SensorCommon {
  bool wet_only = false;  ///< switched on by the water: silent in the air, else it reads the atmosphere there
  double bias_sigma_m = 0.0;
  double sigma_m = 0.02;
  double quantum_m = 0.0;
  double outlier_m = 5.0;
};

struct HeadingConfig : SensorCommon {
  double bias_sigma_rad = 0.0;
  double sigma_rad = 0.0;
  /// Deviation A + B sin psi + C cos psi + D sin 2 psi + E cos 2 psi.
  std::array<double, 5> deviation_rad{0, 0, 0, 0, 0};
  bool magnetic = false;
  double outlier_rad = 0.5;
};

struct UsblConfig : SensorCommon {
  double range_fraction = 0.01;  ///< of the slant range, each axis
  double floor_m = 0.5;
  double maximum_latency_s = 2.0;           ///< latency is uniform between latency_s and this
  double outlier_m = 40.0;                  ///< multipath
  double minimum_depth_m = 1.0;             ///< of the transponder; shallower it is not heard
  std::array<double, 3> ship_N_m{0, 0, 5};  ///< transceiver: north, east of the start, down from the surface
  std::array<double, 3> ship_velocity_N_m_s{0, 0, 0};
  std::array<double, 3> ship_rpy_rad{0, 0, 0};
  /// What is sent: the place; components along N or along the ship; range and direction along the ship; or
  /// range and direction of a beacon in the ship's place along the vehicle, which carries the transceiver.
  enum class Output { geodetic, ned, vessel, range_bearing, inverted };
  Output output = Output::geodetic;
  double ship_sigma_m = 0.0;            ///< of the ship's place as it is sent, each axis
  double angle_sigma_rad = 0.005;       ///< of a direction, across it
  double misalignment_sigma_rad = 0.0;  ///< of the transceiver's axes, each, drawn once a run
};

struct PropulsionConfig : SensorCommon {
  double sigma_rpm = 2.0;
  double scale_sigma = 0.0;
};

struct FinsConfig : SensorCommon {
  double sigma_rad = 0.002;
  double bias_sigma_rad = 0.0;
};

struct AirspeedConfig : SensorCommon {
  double scale_sigma = 0.0;
  double sigma_m_s = 0.5;
  double baro_sigma_m = 0.5;
  double baro_bias_sigma_m = 2.0;
};

struct SensorSuite {
  ImuConfig imu;
  GpsConfig gps;
  DvlConfig dvl;
  DepthConfig depth;
  HeadingConfig heading;
  UsblConfig usbl;
  PropulsionConfig propulsion;
  FinsConfig fins;
  AirspeedConfig airspeed;
};

}  // namespace fathom::sim
