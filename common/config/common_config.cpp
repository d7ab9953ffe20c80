#include "config/common_config.hpp"

#include "config/service_schema.hpp"

namespace fathom::config {

void describe(Schema<BusConfig>& s) {
  s.field("domain", &BusConfig::domain, "DDS domain; services of one vehicle share it").range(0, 232);
  s.field("interfaces", &BusConfig::interfaces,
          "addresses of this host that DDS binds; nothing else is bound");
  s.field("peers", &BusConfig::peers, "addresses asked for discovery besides multicast");
  s.field("profiles_dir", &BusConfig::profiles_dir,
          "folder of the QoS XML files; empty: found beside the executable or where installed");
  s.check([](const BusConfig& bus) -> std::pair<std::string, std::string> {
    if (bus.interfaces.empty()) return {"interfaces", "at least one address"};
    return {};
  });
}

void describe(Schema<LogConfig>& s) {
  s.field("level", &LogConfig::level, "least severe messages that are written")
      .words({{"trace", "trace"},
              {"debug", "debug"},
              {"info", "info"},
              {"warning", "warning"},
              {"error", "error"}});
}

void describe(Schema<ClockConfig>& s) {
  s.field("rate", &ClockConfig::rate, "vehicle seconds per host second; all services of a vehicle share it")
      .range(0.01, 1000.0);
  s.field("epoch_ns", &ClockConfig::epoch_ns,
          "UTC instant, since 1970, at which an accelerated clock starts; 0: the host's own clock")
      .unit("ns")
      .range(0, 9.2e18);
  s.check([](const ClockConfig& clock) -> std::pair<std::string, std::string> {
    if (clock.rate != 1.0 && clock.epoch_ns == 0) {
      return {"epoch_ns", "an instant, because the rate is not 1 and all services must start from the same"};
    }
    return {};
  });
}

void describe(Schema<CommonConfig>& s) {
  s.field("vehicle", &CommonConfig::vehicle, "name of the vehicle, the first key of every topic");
  s.field("bus", &CommonConfig::bus, "the vehicle network");
  s.field("log", &CommonConfig::log, "the service's log on standard error");
  s.field("clock", &CommonConfig::clock, "what the service calls now");
  s.check([](const CommonConfig& common) -> std::pair<std::string, std::string> {
    if (common.vehicle.empty() || common.vehicle.size() > Name::kCapacity) {
      return {"vehicle", "1 to " + std::to_string(Name::kCapacity) + " characters"};
    }
    return {};
  });
}

}  // namespace fathom::config
