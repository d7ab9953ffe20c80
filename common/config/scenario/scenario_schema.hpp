#pragma once

// Descriptions of a scenario's parts, shared by the files beside it.

#include "config/json/schema.hpp"
#include "sim/scenario.hpp"

namespace fathom::config {

void describe(Schema<sim::Window>& s);
void describe(Schema<sim::LinkConfig>& s);
void describe(Schema<sim::GyroConfig>& s);
void describe(Schema<sim::AccelerometerConfig>& s);
/// A simulated sensor, of each kind in sensors/.
template <OfAKind Sample>
void describe(Schema<sim::SimulatedSensor<Sample>>& s);
void describe(Schema<sim::SensorSuite>& s);

void describe(Schema<sim::AuvConfig>& s);
void describe(Schema<sim::AirDropConfig>& s);
void describe(Schema<sim::AircraftConfig>& s);
void describe(Schema<sim::RotatingArmConfig>& s);
void describe(Schema<sim::RemusBeyondModel>& s);
void describe(Schema<sim::RemusConfig>& s);
void describe(Schema<sim::VehicleConfig>& s);

void describe(Schema<sim::EnvironmentConfig>& s);
void describe(Schema<sim::StartSpread>& s);
void describe(Schema<sim::StartConfig>& s);
void describe(Schema<sim::MissionStep>& s);
void describe(Schema<sim::ScenarioLimits>& s);
void describe(Schema<sim::Scenario>& s);

}  // namespace fathom::config
