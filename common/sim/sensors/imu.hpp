#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <Eigen/Geometry>

#include "samples/imu.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;
struct ImuTruth;

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

template <>
struct SimulatedSensor<ImuSample> : SensorCommon {
  static constexpr const char* kDescription = "inertial measurement unit at the body origin";
  static constexpr bool kAlwaysHeard = true;
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};  ///< rotation of the unit's axes against the body
  GyroConfig gyro;
  AccelerometerConfig accelerometer;
  /// True: increments over the sample interval and their mean rates, as a strapdown unit gives. False: rates
  /// at the instant only.
  bool increments = true;
};
using ImuConfig = SimulatedSensor<ImuSample>;

/// One triad: turn-on bias, in-run bias, scale, misalignment, white noise, vibration, quantisation, clipping.
class TriadModel {
 public:
  TriadModel(const TriadConfig& config, Random& random);
  /// Integral over an interval of `dt_s`, in the unit of the integral.
  Eigen::Vector3d increment(const Eigen::Vector3d& truth, double dt_s, Random& random);
  /// Value at an instant, `dt_s` after the one before.
  Eigen::Vector3d point(const Eigen::Vector3d& truth, double dt_s, Random& random);
  /// Turn-on plus in-run bias now.
  [[nodiscard]] Eigen::Vector3d bias() const;

 private:
  void advance(double dt_s, Random& random);
  TriadConfig config_;
  Eigen::Vector3d turn_on_ = Eigen::Vector3d::Zero();
  std::array<GaussMarkov, 3> in_run_;
  Eigen::Matrix3d response_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d remainder_ = Eigen::Vector3d::Zero();
};

class ImuModel {
 public:
  ImuModel(const ImuConfig& config, std::uint64_t seed);
  ImuSample sample(const ImuTruth& interval, const TruthPoint& end);
  [[nodiscard]] const TriadModel& gyro() const { return gyro_; }
  [[nodiscard]] const TriadModel& accelerometer() const { return accelerometer_; }

 private:
  ImuConfig config_;
  Random random_;
  Eigen::Matrix3d C_IB_;  ///< body axes into those of the unit
  TriadModel gyro_;
  TriadModel accelerometer_;
};
template <>
struct ModelOf<ImuSample> {
  using type = ImuModel;
};

/// The device of an inertial unit.
template <>
class SimulatedDevice<ImuSample> {
 public:
  static constexpr std::array<std::string_view, 6> kProtocols{"vectornav", "xsens",   "microstrain",
                                                              "sbg",       "stim300", "kvh"};
  [[nodiscard]] Bytes encode(const ImuSample& imu, const DeviceCall& device);

 private:
  std::uint16_t counter_ = 0;  ///< of messages, where the protocol counts them
};

}  // namespace fathom::sim
