#pragma once

#include <functional>

#include "cli/bench/timer.hpp"

namespace fathom::cli {

/// One row per aiding model, instruments and constraints alike, each as an update of the full configuration:
/// innovation and H, S, and the covariance and state behind it, beside a dense Joseph update of as many rows.
void bench_updates(int rounds, const std::function<void(const BenchRow&)>& done);

}  // namespace fathom::cli
