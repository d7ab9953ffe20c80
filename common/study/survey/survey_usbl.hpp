#pragma once

#include "estimation/engine_config.hpp"
#include "sim/scenario.hpp"

/// Acoustic positioning of the survey vehicle from a ship, and what the filters are told about it.
namespace fathom::study {

void add_survey_usbl(sim::Scenario& scenario);
[[nodiscard]] estimation::SensorConfig told_survey_usbl();

}  // namespace fathom::study
