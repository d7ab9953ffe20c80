#pragma once

#include <string>

#include "base/time.hpp"
#include "report/material.hpp"

namespace fathom::cli {

/// What only a recording has: how each service was, how its host's clock stood, and what the vehicle itself
/// tells of the run. Throws Failure.
void add_recorded(const std::string& file, const std::string& vehicle, TimeNs epoch_ns,
                  report::Material& material);

}  // namespace fathom::cli
