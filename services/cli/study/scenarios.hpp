#pragma once

#include <memory>

#include "study/study.hpp"

namespace fathom::cli {

/// The shipped scenarios over many seeds, offline: simulated instruments, device bytes, codecs and stamps,
/// and fusion as its configuration and the scenario set it. Throws config::ConfigError.
[[nodiscard]] std::unique_ptr<const study::Study> make_scenario_study();

}  // namespace fathom::cli
