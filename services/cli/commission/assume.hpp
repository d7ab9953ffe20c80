#pragma once

#include "commission/assumed.hpp"
#include "config/fusion/fusion_config.hpp"

namespace fathom::cli {

/// What a configuration of fusion says of the instruments: of each kind its first sensor.
[[nodiscard]] commission::Assumed assumed_by(const config::FusionConfig& config);

}  // namespace fathom::cli
