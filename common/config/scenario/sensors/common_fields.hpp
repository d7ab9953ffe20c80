#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/units.hpp"
#include "config/scenario/scenario_schema.hpp"

namespace fathom::config {

// The fields that every sensor has, as members of the sensor's own struct.
template <class T>
void common_fields(Schema<T>& s) {
  using C = sim::SensorCommon;
  s.field("enabled", static_cast<bool T::*>(&C::enabled), "the vehicle carries this sensor");
  s.field("protocol", static_cast<std::string T::*>(&C::protocol),
          "of the device bytes; empty: no device output");
  s.field("link", static_cast<sim::LinkConfig T::*>(&C::link), "where the device bytes leave the simulator");
  s.field("rate_hz", static_cast<double T::*>(&C::rate_hz), "samples per second")
      .unit("Hz")
      .range(0.01, 2000);
  s.field("phase_s", static_cast<double T::*>(&C::phase_s), "of the first sample after the start")
      .unit("s")
      .range(0, 60);
  s.field("latency_s", static_cast<double T::*>(&C::latency_s), "from validity to the last byte")
      .unit("s")
      .range(0, 60);
  s.field("stamp_late_s", static_cast<double T::*>(&C::stamp_late_s),
          "its stamps are later than validity by this: what navigation has to be told")
      .unit("s")
      .range(-5, 5);
  s.field("jitter_s", static_cast<double T::*>(&C::jitter_s), "of the latency, uniform, on top of it")
      .unit("s")
      .range(0, 10);
  s.field("dropout_probability", static_cast<double T::*>(&C::dropout_probability), "a sample gets lost")
      .range(0, 1);
  s.field("outlier_probability", static_cast<double T::*>(&C::outlier_probability), "a sample is wrong")
      .range(0, 1);
  s.field("dropouts", static_cast<std::vector<sim::Window> T::*>(&C::dropouts),
          "spans of the run in which nothing usable is measured");
  s.field("lever_B_m", static_cast<std::array<double, 3> T::*>(&C::lever_B_m),
          "place of the sensor relative to the IMU: forward, right, down")
      .unit("m")
      .range(-100, 100);
  s.check([](const T& sensor) -> std::pair<std::string, std::string> {
    if (!sensor.protocol.empty() && sensor.link.port == 0 && sensor.link.path.empty()) {
      return {"link", "where the bytes of protocol " + sensor.protocol + " go"};
    }
    return {};
  });
}

}  // namespace fathom::config
