#pragma once

// Descriptions of a scenario's parts, shared by scenario_config.cpp, vehicle_config.cpp and
// sensor_config.cpp.

#include "config/json/schema.hpp"
#include "sim/scenario.hpp"

namespace fathom::config {

void describe(Schema<sim::Window>& s);
void describe(Schema<sim::LinkConfig>& s);
void describe(Schema<sim::GyroConfig>& s);
void describe(Schema<sim::AccelerometerConfig>& s);
void describe(Schema<sim::ImuConfig>& s);
void describe(Schema<sim::GpsConfig>& s);
void describe(Schema<sim::DvlConfig>& s);
void describe(Schema<sim::DepthConfig>& s);
void describe(Schema<sim::HeadingConfig>& s);
void describe(Schema<sim::UsblConfig>& s);
void describe(Schema<sim::PropulsionConfig>& s);
void describe(Schema<sim::FinsConfig>& s);
void describe(Schema<sim::AirspeedConfig>& s);
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
