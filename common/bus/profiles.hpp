#pragma once

#include <string>

namespace fathom::bus {

/// The folder of the QoS profiles that participants of this process load: `configured`, else as
/// ParticipantOptions::profiles_dir says. Throws BusError naming the places it looked at.
[[nodiscard]] std::string profiles_folder(const std::string& configured);

}  // namespace fathom::bus
