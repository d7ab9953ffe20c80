#pragma once

#include <functional>

#include "cli/bench/timer.hpp"

namespace fathom::cli {

/// What the vehicle model costs: a step of the published filter, as printed and linked, and in the engine a
/// step of the model with its use as a measurement.
void bench_hydro(int rounds, const std::function<void(const BenchRow&)>& done);

}  // namespace fathom::cli
