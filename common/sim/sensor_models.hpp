#pragma once

#include <optional>

#include "geo/wgs84.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/usbl.hpp"
#include "sim/random.hpp"
#include "sim/scenario.hpp"
#include "sim/truth_generator.hpp"

/// Error models: truth in, measured sample out. They fill the measured values; stamps, names and sequence
/// numbers are the Simulation's. All randomness comes from the seed and the sensor's name.
namespace fathom::sim {

[[nodiscard]] bool inside(const std::vector<Window>& windows, double t_s);

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
  TriadModel gyro_;
  TriadModel accelerometer_;
};

/// Position of an antenna with a correlated error; no fix under water, in scheduled outages, and until the
/// receiver has acquired again.
class GpsModel {
 public:
  GpsModel(const GpsConfig& config, const EnvironmentConfig& environment, std::uint64_t seed);
  /// Every inertial sample: whether the antenna is out of the water.
  void observe(const TruthPoint& point);
  [[nodiscard]] bool available() const { return available_; }
  GpsSample sample(const TruthPoint& point);

 private:
  GpsConfig config_;
  EnvironmentConfig environment_;
  Random random_;
  std::array<GaussMarkov, 3> drift_;
  double last_sample_s_ = 0.0;
  double clear_since_s_;
  bool available_ = true;
};

/// Four-beam Janus: beam 1 port, 2 starboard, 3 ahead, 4 astern, each tilted from down by the beam angle. A
/// ping with fewer than three good beams has no velocity.
class DvlModel {
 public:
  DvlModel(const DvlConfig& config, std::uint64_t seed);
  DvlSample sample(const TruthPoint& point);
  /// Of the same ping, the water layer; none where it is not measured.
  std::optional<DvlSample> water_layer(const TruthPoint& point);
  /// Rotation of vectors from the instrument's true axes into B, misalignment included.
  [[nodiscard]] const Eigen::Quaterniond& q_BD() const { return q_BD_; }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  /// Whether the beams reach the bottom is the caller's; what they measure is this.
  struct Ping {
    bool water = false;
    bool outlier = false;
  };
  DvlSample measure(const TruthPoint& point, const Ping& ping, Random& random) const;

  DvlConfig config_;
  Random random_;
  Random layer_;  ///< apart, so that the bottom is measured alike with and without it
  Eigen::Quaterniond q_BD_ = Eigen::Quaterniond::Identity();
  double scale_ = 0.0;
  Eigen::Vector3d bias_D_m_s_ = Eigen::Vector3d::Zero();
};

class DepthModel {
 public:
  DepthModel(const DepthConfig& config, std::uint64_t seed);
  /// Nothing in the air when only the water switches it on.
  std::optional<DepthSample> sample(const TruthPoint& point);

 private:
  DepthConfig config_;
  Random random_;
  double bias_m_;
};

class HeadingModel {
 public:
  HeadingModel(const HeadingConfig& config, const EnvironmentConfig& environment, std::uint64_t seed);
  HeadingSample sample(const TruthPoint& point);

 private:
  HeadingConfig config_;
  double variation_rad_;
  Random random_;
  double bias_rad_;
};

/// Acoustic fixes between the vehicle and a ship that lies still or keeps its course.
class UsblModel {
 public:
  UsblModel(const UsblConfig& config, const Scenario& scenario, std::uint64_t seed);
  /// Nothing when the transponder is not heard.
  std::optional<UsblSample> sample(const TruthPoint& point);
  /// Time from validity to arrival of the sample just taken.
  double latency_s();

 private:
  void relative(UsblSample& out, const TruthPoint& transponder, const geo::Geodetic& ship,
                const geo::Geodetic& heard, double sigma_m);

  UsblConfig config_;
  Random random_;
  geo::Geodetic start_;  ///< of the ship's transceiver
  double surface_altitude_m_ = 0.0;
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();  ///< from the transceiver's true axes
};

class PropulsionModel {
 public:
  PropulsionModel(const PropulsionConfig& config, std::uint64_t seed);
  PropulsionSample sample(const TruthPoint& point);

 private:
  PropulsionConfig config_;
  Random random_;
  double scale_;
};

class FinsModel {
 public:
  FinsModel(const FinsConfig& config, std::uint64_t seed);
  FinsSample sample(const TruthPoint& point);

 private:
  FinsConfig config_;
  Random random_;
  double rudder_bias_rad_;
  double stern_bias_rad_;
};

class AirspeedModel {
 public:
  AirspeedModel(const AirspeedConfig& config, const EnvironmentConfig& environment, std::uint64_t seed);
  AirspeedSample sample(const TruthPoint& point);

 private:
  AirspeedConfig config_;
  double air_warmer_K_;
  Random random_;
  double scale_;
  double baro_bias_m_;
};

}  // namespace fathom::sim
