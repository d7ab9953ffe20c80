#include "engine_states.hpp"

#include "drop_run.hpp"
#include "small_vehicle.hpp"
#include "survey_run.hpp"

namespace fathom::test {

void EngineState::feed_to(estimation::FusionEngine& engine) const {
  for (const Heard& one : next) {
    std::visit(
        [&]<class T>(const T& sample) {
          if constexpr (std::is_same_v<T, Command>) {
            (void)engine.apply(sample);
          } else {
            engine.add(sample);
          }
        },
        one);
  }
}

EngineState survey_state(double at_s) {
  EngineState out;
  out.config = SurveyRun::config();
  (void)estimation::named_state_groups("full", out.config.groups);
  out.config.horizon_s = 0.6;
  out.config.measurement_capacity = 64;
  out.config.groups.model_scale = out.config.groups.model_bias = true;
  out.config.vehicle_model.enabled = true;
  out.config.vehicle_model.coefficients = small_vehicle();
  out.config.constraints.non_holonomic.enabled = true;
  out.config.constraints.constant_depth.enabled = true;
  auto gps = out.config.sensors[0];
  gps.sensor = "gps1";
  gps.latency_s = 0.1;
  gps.gate_mode = estimation::GateMode::per_component;
  out.config.sensors.push_back(gps);
  out.config.sensors.push_back(estimation::default_sensor(SourceKind::airspeed, "air0"));
  out.config.sensors.push_back(estimation::default_sensor(SourceKind::propulsion, "propulsion0"));
  out.config.sensors.push_back(estimation::default_sensor(SourceKind::fins, "fins0"));
  for (auto& one : out.config.sensors) one.frozen_change = 5.0;

  const SurveyRun run({.duration_s = at_s + 1.2, .dive_s = at_s + 0.6});
  const TimeNs cut_ns = SurveyRun::kEpochNs + from_seconds(at_s);
  estimation::FusionEngine engine(out.config);
  TimeNs second_ns = 0;
  const auto hear = [&](const auto& sample, bool after) {
    if (after) {
      out.next.emplace_back(sample);
    } else {
      engine.add(sample);
    }
  };
  for (const Sample& sample : run.samples) {
    const SampleHeader& from = header(sample);
    const bool after = from.received_ns > cut_ns;
    if (after && out.image.empty()) (void)engine.save(out.image);
    std::visit([&](const auto& one) { hear(one, after); }, sample);
    if (from.received_ns - second_ns < kNsPerSecond / 5) continue;
    second_ns = from.received_ns;
    PropulsionSample propulsion;
    propulsion.header = from;
    propulsion.header.sensor = "propulsion0";
    propulsion.rpm = 800.0;
    hear(propulsion, after);
    FinsSample fins;
    fins.header = from;
    fins.header.sensor = "fins0";
    fins.rudder_rad = 0.02;
    fins.stern_rad = -0.01;
    hear(fins, after);
    AirspeedSample air;
    air.header = from;
    air.header.sensor = "air0";
    air.airspeed_m_s = 30.0;
    hear(air, after);
    Command order;
    order.header = from;
    order.kind = CommandKind::set_position;
    order.latitude_rad = 0.61;
    order.longitude_rad = 2.2;
    order.sigma_m = 50.0;
    if (after && out.next.size() < 200) out.next.emplace_back(order);
  }
  return out;
}

EngineState drop_state(double at_s) {
  EngineState out;
  out.config = drop_config();
  out.config.horizon_s = 0.6;
  out.config.measurement_capacity = 64;
  const Fall fall(at_s + 1.2);
  const TimeNs cut_ns = kEpoch + from_seconds(at_s);
  estimation::FusionEngine engine(out.config);
  engine.start_from(release());
  for (const sim::Measurement& sample : fall.samples) {
    const bool after = header_of(sample).received_ns > cut_ns;
    if (after && out.image.empty()) (void)engine.save(out.image);
    if (!after) {
      feed(engine, sample);
      continue;
    }
    std::visit(
        [&](const auto& one) {
          if constexpr (std::is_constructible_v<EngineState::Heard, decltype(one)>)
            out.next.emplace_back(one);
        },
        sample);
  }
  return out;
}

}  // namespace fathom::test
