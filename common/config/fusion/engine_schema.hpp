#pragma once

// The estimator's configuration as a section of a file. Its fields are described beside the structs, in
// estimation/description; fusion_engine_config.cpp alone reads that.

#include "config/json/schema.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::config {

void describe(Schema<estimation::EngineConfig>& s);

/// The state groups that are not named are those of the named configuration.
void load_value(const nlohmann::json& json, estimation::EngineConfig& out,
                const Rules<estimation::EngineConfig>& rules, const Place& place);

}  // namespace fathom::config
