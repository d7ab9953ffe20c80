#pragma once

#include "config/bridge/bridge_config.hpp"
#include "config/json/schema.hpp"

namespace fathom::config {

// Descriptions of instruments that have a file of their own; included by the bridges' *_config.cpp only.
void describe(Schema<SensorConfig>& s);
void describe(Schema<AirColumnConfig>& s);
void describe(Schema<AirLineConfig>& s);
void describe(Schema<AirTransducers>& s);
void describe(Schema<AirDataSensorConfig>& s);

}  // namespace fathom::config
