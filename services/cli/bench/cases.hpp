#pragma once

#include <functional>
#include <vector>

#include "cli/bench/timer.hpp"

namespace fathom::cli {

/// All rows, in the order of the table. `rounds` is the number of interleaved rounds of each; `done` is
/// called with each row as it is known.
void run_bench(int rounds, const std::function<void(const BenchRow&)>& done);

}  // namespace fathom::cli
