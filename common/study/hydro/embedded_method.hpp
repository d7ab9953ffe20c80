#pragma once

#include "study/hydro/experiment.hpp"

namespace fathom::study::hydro {

/// Inertial alone, its altitude slaved to depth.
[[nodiscard]] std::vector<ErrorPoint> run_ins(const Run& run);
/// The published filter as printed.
[[nodiscard]] std::vector<ErrorPoint> run_printed(const Run& run);
/// The published filter with the gyro, gyro biases, current and the link between its two velocities.
[[nodiscard]] std::vector<ErrorPoint> run_linked(const Run& run);

}  // namespace fathom::study::hydro
