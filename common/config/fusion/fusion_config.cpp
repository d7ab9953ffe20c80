#include "config/fusion/fusion_config.hpp"

#include "base/units.hpp"
#include "config/fusion/engine_schema.hpp"
#include "config/service_schema.hpp"

namespace fathom::config {

using estimation::StartMode;

void describe(Schema<GivenState>& s) {
  s.field("stamp_ns", &GivenState::stamp_ns,
          "UTC instant of the state since 1970; 0: with the first inertial sample")
      .unit("ns")
      .range(0, 9.2e18);
  s.field("latitude_deg", &GivenState::latitude_rad, "geodetic latitude, WGS-84")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .required();
  s.field("longitude_deg", &GivenState::longitude_rad, "geodetic longitude, WGS-84")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .required();
  s.field("altitude_m", &GivenState::altitude_m, "height above the WGS-84 ellipsoid, up")
      .unit("m")
      .range(-12'000, 100'000)
      .required();
  s.field("velocity_N_m_s", &GivenState::velocity_N_m_s, "velocity north, east, down")
      .unit("m/s")
      .range(-1000, 1000);
  s.field("rpy_deg", &GivenState::rpy_rad, "roll, pitch, yaw of the body")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .required();
}

void describe(Schema<StartSigma>& s) {
  s.field("position_N_m", &StartSigma::position_N_m, "one standard deviation north, east, down")
      .unit("m")
      .range(1e-4, 1e6);
  s.field("velocity_N_m_s", &StartSigma::velocity_N_m_s, "one standard deviation north, east, down")
      .unit("m/s")
      .range(1e-5, 1e3);
  s.field("attitude_deg", &StartSigma::attitude_rad, "one standard deviation about north, east, down")
      .unit("deg")
      .range(1e-5, 180)
      .scaled(kRadPerDeg);
}

bool starts_from_state(StartMode mode) {
  return mode == StartMode::given || mode == StartMode::air_drop;
}

void describe(Schema<StartConfig>& s) {
  s.field("mode", &StartConfig::mode, "how navigation begins")
      .words({{"at_rest", StartMode::at_rest},
              {"in_motion", StartMode::in_motion},
              {"given", StartMode::given},
              {"automatic", StartMode::automatic},
              {"air_drop", StartMode::air_drop}});
  s.field("state", &StartConfig::state, "the state that modes \"given\" and \"air_drop\" start from");
  s.field("sigma", &StartConfig::sigma, "how well a given state or a reference is known");
}

void describe(Schema<CheckpointConfig>& s) {
  s.field("path", &CheckpointConfig::path,
          "file that the state is kept in and a fusion started anew goes on from; below /run it costs no "
          "disk and "
          "survives the process, on a disk with sync also the power; empty: none");
  s.field("period_s", &CheckpointConfig::period_s, "between two of them").unit("s").range(0.05, 3600);
  s.field("max_age_s", &CheckpointConfig::max_age_s, "an older one is not gone on from")
      .unit("s")
      .range(0.1, 86'400);
  s.field("sync", &CheckpointConfig::sync, "onto the disk each time, before the next");
}

void describe(Schema<StandbyConfig>& s) {
  s.field("enabled", &StandbyConfig::enabled,
          "this is one of several fusion services of the vehicle that keep the same state: the one of the "
          "greatest ownership_strength leads, another one takes over when it falls silent");
  s.field("listen_s", &StandbyConfig::listen_s,
          "how long it listens for another one before it leads, after its start and after a silence")
      .unit("s")
      .range(0.05, 60);
}

void describe(Schema<FusionConfig>& s) {
  s.include(&FusionConfig::common);
  s.field("instance", &FusionConfig::instance,
          "name of this service; of several fusion services on one vehicle each has its own")
      .name();
  s.field(
       "imu_sensor", &FusionConfig::imu_sensor,
       "name of the inertial unit that is listened to; samples of others are refused, for they lie elsewhere")
      .name();
  s.field("ownership_strength", &FusionConfig::ownership_strength,
          "of the navigation state: the strongest living fusion is heard")
      .range(0, 1'000'000);
  s.field("start", &FusionConfig::start, "how navigation begins");
  s.field("checkpoint", &FusionConfig::checkpoint, "the state that a fusion started anew goes on from");
  s.field("standby", &FusionConfig::standby, "several fusion services of one vehicle");
  s.field("engine", &FusionConfig::engine, "the estimator and its instruments").required();
  s.check([](const FusionConfig& config) -> std::pair<std::string, std::string> {
    if (starts_from_state(config.start.mode) && !config.start.state) {
      return {"start.state", "the state to start from, because start.mode is \"given\" or \"air_drop\""};
    }
    return {};
  });
}

template <>
LoadedConfig<FusionConfig> load_service_config<FusionConfig>(const LoadRequest& request) {
  LoadedConfig<FusionConfig> out;
  out.value = load<FusionConfig>(request);
  out.hash = runtime::hex_hash(canonical(out.value));
  return out;
}

template std::string explain_service_config<FusionConfig>();

ConfigKind fusion_kind() {
  return make_kind<FusionConfig>("fusion");
}

estimation::EngineConfig engine_config(const FusionConfig& config) {
  estimation::EngineConfig engine = config.engine;
  engine.vehicle = config.common.vehicle;
  engine.sensor = config.instance;
  engine.alignment.mode = config.start.mode;
  return engine;
}

std::string estimation_hash(const FusionConfig& config) {
  FusionConfig shared = config;
  shared.common.bus = {};
  shared.common.log = {};
  shared.common.realtime = {};
  shared.common.clock.anchor_file.clear();
  shared.instance = FusionConfig().instance;
  shared.ownership_strength = 0;
  shared.checkpoint = {};
  shared.standby = {};
  return runtime::hex_hash(canonical(shared));
}

estimation::InitialState initial_state(const FusionConfig& config) {
  const GivenState& given = *config.start.state;
  estimation::InitialState state;
  state.stamp_ns = given.stamp_ns;
  state.latitude_rad = given.latitude_rad;
  state.longitude_rad = given.longitude_rad;
  state.altitude_m = given.altitude_m;
  state.velocity_N_m_s = given.velocity_N_m_s;
  state.rpy_rad = given.rpy_rad;
  state.position_sigma_N_m = config.start.sigma.position_N_m;
  state.velocity_sigma_N_m_s = config.start.sigma.velocity_N_m_s;
  state.attitude_sigma_rad = config.start.sigma.attitude_rad;
  return state;
}

}  // namespace fathom::config
