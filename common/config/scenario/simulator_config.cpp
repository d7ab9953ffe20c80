#include "config/scenario/simulator_config.hpp"

#include "config/scenario/scenario_config.hpp"
#include "config/scenario/scenario_schema.hpp"
#include "config/service_schema.hpp"

namespace fathom::config {

void describe(Schema<SimulatorConfig>& s) {
  using C = SimulatorConfig;
  s.include(&C::common);
  s.field("scenario", &C::scenario, "name of a scenario, or a file (with a slash or ending in .json)");
  s.field("scenario_dir", &C::scenario_dir,
          "folder of the scenarios; empty: found beside the executable or where installed");
  s.field("dataset", &C::dataset,
          "folder of a recorded vehicle to play through the scenario's devices; empty: simulate");
  s.field("seed", &C::seed, "of all random numbers").range(0, 9e15);
  s.field("epoch_ns", &C::epoch_ns,
          "UTC of the start since 1970; 0: start_delay_s from now, on a whole second")
      .unit("ns")
      .range(0, 9.2e18);
  s.field("start_delay_s", &C::start_delay_s, "from the service's start, where epoch_ns is 0")
      .unit("s")
      .range(0, 3600);
  s.field("link_dir", &C::link_dir, "folder in which the pseudo-terminals appear under their names");
  s.field("port_offset", &C::port_offset, "added to every TCP and UDP port of the scenario")
      .range(-60000, 60000);
  s.field("truth_rate_hz", &C::truth_rate_hz, "how often the truth is published").unit("Hz").range(1, 100);
  s.check([](const C& config) -> std::pair<std::string, std::string> {
    if (config.scenario.empty()) return {"scenario", "the name of a scenario"};
    if (config.link_dir.empty()) return {"link_dir", "a folder"};
    return {};
  });
}

template <>
LoadedConfig<SimulatorConfig> load_service_config(const LoadRequest& request) {
  LoadedConfig<SimulatorConfig> out;
  out.value = load<SimulatorConfig>(request);
  out.value.loaded = load_scenario({scenario_file(out.value.scenario, out.value.scenario_dir), {}});
  out.hash = runtime::hex_hash(canonical(out.value) + canonical(out.value.loaded));
  return out;
}

ConfigKind simulator_kind() {
  return make_kind<SimulatorConfig>("simulator");
}

}  // namespace fathom::config
