#pragma once

#include <string>
#include <string_view>

#include "base/time.hpp"
#include "samples/usbl.hpp"

namespace fathom::sim::encode {

/// `+++AT:length:text` CR LF.
[[nodiscard]] std::string evologics_line(std::string_view text);

/// USBLLONG of a fix along N, from a level head that looks east, or along the vehicle, from a head on it that
/// has no attitude sensor: both sets of axes are the same. The address is the name of the transponder. Both
/// instants are of the device's own clock. Range and direction are sent as components. A fix in other axes or
/// without place gives nothing.
[[nodiscard]] std::string evologics(const UsblSample& sample, DurationNs measured, DurationNs sent);

}  // namespace fathom::sim::encode
