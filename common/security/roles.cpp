#include "security/roles.hpp"

#include <algorithm>
#include <array>

namespace fathom::security {
namespace {

using Topics = std::span<const std::string_view>;

template <class... Names>
constexpr std::array<std::string_view, sizeof...(Names)> list(Names... names) {
  return {std::string_view(names)...};
}

// Every service writes its life sign.
constexpr auto kImu = list("fathom/v1/imu", "fathom/v1/service_status");
constexpr auto kDvl = list("fathom/v1/dvl", "fathom/v1/service_status");
constexpr auto kGps = list("fathom/v1/gps", "fathom/v1/service_status");
constexpr auto kDepth = list("fathom/v1/depth", "fathom/v1/service_status");
constexpr auto kHeading = list("fathom/v1/heading", "fathom/v1/service_status");
constexpr auto kUsbl = list("fathom/v1/usbl", "fathom/v1/service_status");
constexpr auto kActuator = list("fathom/v1/propulsion", "fathom/v1/fins", "fathom/v1/service_status");
constexpr auto kAirData = list("fathom/v1/airspeed", "fathom/v1/service_status");

constexpr auto kFusionWrites = list("fathom/v1/nav_state", "fathom/v1/nav_detail", "fathom/v1/verdict",
                                    "fathom/v1/alignment", "fathom/v1/forecast", "fathom/v1/replica_status",
                                    "fathom/v1/engine_state", "fathom/v1/service_status");
// What the others of its kind say, too: of several fusion services each knows how far it is from the one that
// leads.
constexpr auto kFusionReads = list(
    "fathom/v1/imu", "fathom/v1/gps", "fathom/v1/dvl", "fathom/v1/depth", "fathom/v1/heading",
    "fathom/v1/usbl", "fathom/v1/airspeed", "fathom/v1/propulsion", "fathom/v1/fins", "fathom/v1/command",
    "fathom/v1/nav_state", "fathom/v1/verdict", "fathom/v1/replica_status", "fathom/v1/engine_state");

constexpr auto kMonitorWrites =
    list("fathom/v1/alarm", "fathom/v1/monitor_status", "fathom/v1/service_status");
constexpr auto kMonitorReads =
    list("fathom/v1/imu", "fathom/v1/gps", "fathom/v1/dvl", "fathom/v1/depth", "fathom/v1/heading",
         "fathom/v1/usbl", "fathom/v1/airspeed", "fathom/v1/propulsion", "fathom/v1/fins",
         "fathom/v1/nav_state", "fathom/v1/alignment", "fathom/v1/verdict", "fathom/v1/forecast",
         "fathom/v1/service_status", "fathom/v1/command");

constexpr auto kConsoleWrites = list("fathom/v1/command", "fathom/v1/service_status");
constexpr auto kConsoleReads =
    list("fathom/v1/nav_state", "fathom/v1/nav_detail", "fathom/v1/verdict", "fathom/v1/alignment",
         "fathom/v1/monitor_status", "fathom/v1/forecast", "fathom/v1/service_status", "fathom/v1/alarm",
         "fathom/v1/gps", "fathom/v1/usbl", "fathom/v1/route");

constexpr auto kGuidanceWrites = list("fathom/v1/route", "fathom/v1/service_status");
constexpr auto kGuidanceReads =
    list("fathom/v1/nav_state", "fathom/v1/alignment", "fathom/v1/monitor_status", "fathom/v1/alarm");

constexpr auto kSimulatorWrites = list("fathom/v1/truth", "fathom/v1/service_status");
constexpr auto kLifeSign = list("fathom/v1/service_status");
constexpr auto kCommand = list("fathom/v1/command");
// A black box: all that was measured, said and ordered. The engine's state is for those who may take over.
constexpr auto kRecorderReads =
    list("fathom/v1/imu", "fathom/v1/gps", "fathom/v1/dvl", "fathom/v1/depth", "fathom/v1/heading",
         "fathom/v1/usbl", "fathom/v1/airspeed", "fathom/v1/propulsion", "fathom/v1/fins",
         "fathom/v1/nav_state", "fathom/v1/nav_detail", "fathom/v1/verdict", "fathom/v1/alignment",
         "fathom/v1/forecast", "fathom/v1/alarm", "fathom/v1/monitor_status", "fathom/v1/service_status",
         "fathom/v1/replica_status", "fathom/v1/command", "fathom/v1/route", "fathom/v1/truth");
// What status shows and what a run is judged by; who exists at all doctor learns from discovery.
constexpr auto kCliReads = list("fathom/v1/nav_state", "fathom/v1/verdict", "fathom/v1/alignment",
                                "fathom/v1/forecast", "fathom/v1/alarm", "fathom/v1/monitor_status",
                                "fathom/v1/service_status", "fathom/v1/gps", "fathom/v1/truth");
constexpr std::array<std::string_view, 0> kNothing{};

constexpr std::array kRoles{
    Role{"imu_bridge", kImu, kNothing},
    Role{"dvl_bridge", kDvl, kNothing},
    Role{"gps_bridge", kGps, kNothing},
    Role{"depth_bridge", kDepth, kNothing},
    Role{"heading_bridge", kHeading, kNothing},
    Role{"usbl_bridge", kUsbl, kNothing},
    Role{"actuator_bridge", kActuator, kNothing},
    Role{"air_data_bridge", kAirData, kNothing},
    Role{"fusion", kFusionWrites, kFusionReads},
    Role{"monitor", kMonitorWrites, kMonitorReads},
    Role{"console", kConsoleWrites, kConsoleReads},
    Role{"guidance", kGuidanceWrites, kGuidanceReads},
    Role{"guidance_example", kGuidanceWrites, kGuidanceReads},
    Role{"discovery", kLifeSign, kNothing},
    Role{"recorder", kLifeSign, kRecorderReads},
    Role{"simulator", kSimulatorWrites, kNothing},
    Role{"cli", kCommand, kCliReads},  // status, doctor, and the referee of a demonstration
};

}  // namespace

std::span<const Role> roles() {
  return kRoles;
}

const Role* find_role(std::string_view name) {
  const auto* const found =
      std::find_if(kRoles.begin(), kRoles.end(), [&](const Role& role) { return role.name == name; });
  return found == kRoles.end() ? nullptr : found;
}

}  // namespace fathom::security
