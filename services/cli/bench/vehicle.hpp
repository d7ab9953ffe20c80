#pragma once

#include <type_traits>
#include <variant>
#include <vector>

#include "estimation/engine/fusion_engine.hpp"
#include "estimation/navigator/navigator.hpp"
#include "geo/wgs84.hpp"
#include "samples/kinds.hpp"

namespace fathom::cli {

/// A vehicle under water that holds course, depth and speed, and what its instruments say: enough for the
/// estimator to do all its work on, at any rate and for any time.
class BenchVehicle {
 public:
  using Sample = AnySample;

  BenchVehicle(const std::string& configuration, double imu_rate_hz);

  /// With all the sensors of the stream.
  [[nodiscard]] const estimation::EngineConfig& config() const { return config_; }
  [[nodiscard]] estimation::InitialState start() const;
  /// One inertial sample and the aiding that arrives behind it: DVL at 5 Hz, depth and compass at 10 Hz, GPS
  /// at 2 Hz, each an instant late as instruments are.
  void step(std::vector<Sample>& out);
  /// A position fix of this long ago.
  [[nodiscard]] UsblSample late_fix(double late_s) const;
  [[nodiscard]] TimeNs now_ns() const { return now_ns_; }

 private:
  void carry_transponder();
  [[nodiscard]] static geo::Geodetic position(TimeNs stamp_ns);
  [[nodiscard]] SampleHeader header(const char* sensor, TimeNs stamp_ns) const;
  [[nodiscard]] bool every(double rate_hz) const;

  estimation::EngineConfig config_;
  double rate_hz_;
  std::int64_t step_ = 0;
  TimeNs now_ns_;
  std::array<double, 3> rate_B_rad_s_{};
  std::array<double, 3> force_B_m_s2_{};
};

/// A navigator that has been under way for a while, with the covariance that this makes: everything is
/// correlated with everything that can be.
[[nodiscard]] estimation::Navigator settled(const estimation::Setup& setup, const BenchVehicle& vehicle);

/// Hands one sample to the engine.
inline bool feed(estimation::FusionEngine& engine, const BenchVehicle::Sample& sample) {
  return std::visit(
      [&](const auto& one) {
        if constexpr (std::is_same_v<std::decay_t<decltype(one)>, ImuSample>) return engine.add(one);
        engine.add(one);
        return false;
      },
      sample);
}

}  // namespace fathom::cli
