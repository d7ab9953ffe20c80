#pragma once

#include <string>

#include "config/fusion/fusion_config.hpp"

namespace fathom::config {

/// The mounting of an instrument turns its axes once: at the bridge or in fusion. Throws ConfigError where it
/// is set in fusion's configuration and in that of the instrument's bridge, which lies in the same folder as
/// `fusion_file`; the message names both files and keys. A bridge's file that cannot be loaded is the
/// bridge's to refuse.
void refuse_second_mounting(const FusionConfig& fusion, const std::string& fusion_file);

}  // namespace fathom::config
