#pragma once

#include "study/hydro/experiment.hpp"

namespace fathom::study::hydro {

enum class EngineMethod { conventional, without_model, with_model };

/// The fusion engine on a run: `conventional` estimates position, velocity, attitude and inertial biases with
/// the DVL and depth; the others also the DVL's scale and the current, and the last takes the vehicle model
/// as a virtual velocity log. One point a second.
[[nodiscard]] std::vector<ErrorPoint> run_engine(const Run& run, EngineMethod method);

}  // namespace fathom::study::hydro
