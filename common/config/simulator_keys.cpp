// The keys of the simulator's own file; what is in a scenario has a file and a schema of its own.
#include "config/scenario/simulator_config.hpp"
#include "config/service_schema.hpp"

namespace fathom::config {

void describe(Schema<SimulatorConfig>& s);

template std::string explain_service_config<SimulatorConfig>();

}  // namespace fathom::config
