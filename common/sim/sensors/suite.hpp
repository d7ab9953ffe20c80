#pragma once

#include "samples/kinds.hpp"
#include "sim/sensors/airspeed.hpp"
#include "sim/sensors/altimeter.hpp"
#include "sim/sensors/depth.hpp"
#include "sim/sensors/dvl.hpp"
#include "sim/sensors/fins.hpp"
#include "sim/sensors/fix.hpp"
#include "sim/sensors/gps.hpp"
#include "sim/sensors/heading.hpp"
#include "sim/sensors/imu.hpp"
#include "sim/sensors/propulsion.hpp"
#include "sim/sensors/range.hpp"
#include "sim/sensors/usbl.hpp"

namespace fathom::sim {

template <class Sample>
struct SuitePart {
  SimulatedSensor<Sample> sensor;
};

/// One simulated sensor a kind: `suite.of<GpsSample>()`.
template <class... Samples>
struct SuiteOf : SuitePart<Samples>... {
  template <class Sample>
  [[nodiscard]] SimulatedSensor<Sample>& of() {
    return static_cast<SuitePart<Sample>&>(*this).sensor;
  }
  template <class Sample>
  [[nodiscard]] const SimulatedSensor<Sample>& of() const {
    return static_cast<const SuitePart<Sample>&>(*this).sensor;
  }
};

using SensorSuite = Kinds::Samples<SuiteOf>;

}  // namespace fathom::sim
