#pragma once

// Description of the estimator's configuration; included by the fusion_*.cpp of this folder only. In the
// file, angles are in degrees and inertial errors in the units of their data sheets; the keys say which.

#include "config/json/schema.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::config {

void describe(Schema<estimation::ImuConfig>& s);
void describe(Schema<estimation::StateGroups>& s);
void describe(Schema<estimation::StateModelConfig>& s);
void describe(Schema<estimation::SensorConfig>& s);
void describe(Schema<estimation::AlignmentConfig>& s);
void describe(Schema<estimation::StabilityConfig>& s);
void describe(Schema<estimation::DropConfig>& s);
void describe(Schema<estimation::NonHolonomicConfig>& s);
void describe(Schema<estimation::ConstantDepthConfig>& s);
void describe(Schema<estimation::ConstraintsConfig>& s);
void describe(Schema<estimation::hydro::HydroCoefficients>& s);
void describe(Schema<estimation::VehicleModelConfig>& s);
void describe(Schema<estimation::ForecastLimitConfig>& s);
void describe(Schema<estimation::EngineConfig>& s);

/// What a sensor's entry leaves out is that of its kind: default_sensor().
void load_value(const nlohmann::json& json, estimation::SensorConfig& out,
                const Rules<estimation::SensorConfig>& rules, const Place& place);

/// Coefficients from the file that is named, relative to the file that names it.
void load_value(const nlohmann::json& json, estimation::VehicleModelConfig& out,
                const Rules<estimation::VehicleModelConfig>& rules, const Place& place);

/// The state groups that are not named are those of the named configuration.
void load_value(const nlohmann::json& json, estimation::EngineConfig& out,
                const Rules<estimation::EngineConfig>& rules, const Place& place);

}  // namespace fathom::config
