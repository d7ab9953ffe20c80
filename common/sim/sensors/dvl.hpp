#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "samples/dvl.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<DvlSample> : SensorCommon {
  static constexpr const char* kDescription = "Doppler velocity log";
  static constexpr bool kAlwaysHeard = true;
  static constexpr bool kTalksOn = true;            ///< without the bottom
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
using DvlConfig = SimulatedSensor<DvlSample>;

/// Four-beam Janus: beam 1 port, 2 starboard, 3 ahead, 4 astern, each tilted from down by the beam angle. A
/// ping with fewer than three good beams has no velocity.
class DvlModel {
 public:
  DvlModel(const DvlConfig& config, std::uint64_t seed);
  DvlSample sample(const TruthPoint& point);
  /// Of the same ping, the water layer; none where it is not measured.
  std::optional<DvlSample> second(const TruthPoint& point);
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
template <>
struct ModelOf<DvlSample> {
  using type = DvlModel;
};

/// The device of a Doppler velocity log.
template <>
class SimulatedDevice<DvlSample> {
 public:
  static constexpr std::array<std::string_view, 4> kProtocols{"pd0", "pd6", "waterlinked", "nortek"};
  /// Empty for the first of two measurements that share a ping's frame: what is measured of the bottom waits
  /// for the water layer.
  [[nodiscard]] Bytes encode(const DvlSample& dvl, const DeviceCall& device);

 private:
  Bytes both_layers(const DvlSample& sample, const DeviceCall& device);
  Bytes written(const DvlSample& bottom, const DvlSample* water, TimeNs valid_ns, const DeviceCall& device);

  std::uint32_t ensemble_ = 0;
  TimeNs last_ns_ = 0;
  std::optional<DvlSample> ping_;  ///< on the bottom, until its water layer comes
};

}  // namespace fathom::sim
