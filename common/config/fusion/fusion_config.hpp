#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/unknown.hpp"
#include "config/common_config.hpp"
#include "config/json/error.hpp"
#include "config/registry.hpp"
#include "config/service_config.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::config {

/// The state that navigation starts from where the configuration gives it.
struct GivenState {
  std::int64_t stamp_ns = 0;  ///< UTC; 0: with the first inertial sample
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_m = kUnknown;  ///< above the WGS-84 ellipsoid
  std::array<double, 3> velocity_N_m_s{0, 0, 0};
  std::array<double, 3> rpy_rad{kUnknown, kUnknown, kUnknown};
};

/// How well a given state, or a reference that navigation starts from, is known.
struct StartSigma {
  std::array<double, 3> position_N_m{1.0, 1.0, 1.0};
  std::array<double, 3> velocity_N_m_s{0.1, 0.1, 0.1};
  std::array<double, 3> attitude_rad{0.01, 0.01, 0.02};  ///< about north, east, down
};

/// The modes that begin with the configured state.
[[nodiscard]] bool starts_from_state(estimation::StartMode mode);

/// Section "start".
struct StartConfig {
  estimation::StartMode mode = estimation::StartMode::automatic;
  std::optional<GivenState> state;  ///< required by modes "given" and "air_drop"
  StartSigma sigma;
};

/// Section "checkpoint": the state that a fusion started anew goes on from.
struct CheckpointConfig {
  std::string path;         ///< of the file; empty: none is written or read
  double period_s = 1.0;    ///< host time between two of them
  double max_age_s = 60.0;  ///< an older one is not gone on from
  bool sync = false;        ///< onto the disk each time, to survive a power cut; wears a flash memory
};

/// Section "standby": this fusion is one of several that keep the same state.
struct StandbyConfig {
  bool enabled = false;
  double listen_s = 0.5;  ///< for another one, before this one leads
};

/// deploy/config/fusion.json, and what `fathom solve --config` reads: the same engine from the same file.
struct FusionConfig {
  CommonConfig common;
  std::string instance = "fusion";      ///< its name among the services, and in NavState
  std::string imu_sensor = "imu";       ///< the inertial unit that is listened to, and no other
  std::int32_t ownership_strength = 0;  ///< of NavState: the strongest living fusion is heard
  StartConfig start;
  CheckpointConfig checkpoint;
  StandbyConfig standby;
  estimation::EngineConfig engine;  ///< as in the file; use engine_config() to build an engine
};

/// Throws ConfigError.
template <>
[[nodiscard]] LoadedConfig<FusionConfig> load_service_config<FusionConfig>(const LoadRequest& request);

[[nodiscard]] ConfigKind fusion_kind();

/// The engine's configuration with what stands elsewhere in the file: vehicle and start mode.
[[nodiscard]] estimation::EngineConfig engine_config(const FusionConfig& config);

/// Hash of what the estimate follows from: equal for two services whose engines make the same of the same
/// samples, however they are named and wherever they run.
[[nodiscard]] std::string estimation_hash(const FusionConfig& config);

/// The configured state for FusionEngine::start_from(). Precondition: config.start.state.
[[nodiscard]] estimation::InitialState initial_state(const FusionConfig& config);

}  // namespace fathom::config
