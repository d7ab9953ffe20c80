#pragma once

#include <string>
#include <vector>

#include "blackbox/sample.hpp"
#include "samples/status/health.hpp"

namespace fathom::blackbox {

/// What a service of any host says of itself, to be kept:
///   services/NAME/process.json: {"host", "pid", "version", "config_hash", "started", "utc_offset_s"}
/// utc_offset_s: how far the host's clock was set while the service ran.
[[nodiscard]] Enclosure process_of(const ServiceStatus& status, TimeNs now_ns);

/// The QoS profiles that participants here load: qos/NAME.xml. `configured`: their folder, as
/// bus::profiles_folder() takes it. Throws BusError.
[[nodiscard]] std::vector<Enclosure> qos_profiles(const std::string& configured, TimeNs now_ns);

}  // namespace fathom::blackbox
