#include "config/common_config.hpp"

#include <algorithm>

#include <arpa/inet.h>

#include "config/service_schema.hpp"

namespace fathom::config {

void describe(Schema<BusSecurityConfig>& s) {
  s.field("folder", &BusSecurityConfig::folder,
          "folder of the credentials that fathom keygen makes; empty: the network is not protected");
  s.field("identity", &BusSecurityConfig::identity,
          "whose credentials in the folder; empty: those of the service's name")
      .optional_name();
  s.check([](const BusSecurityConfig& security) -> std::pair<std::string, std::string> {
    if (security.folder.empty() && !security.identity.empty())
      return {"folder", "one, because an identity is named"};
    return {};
  });
}

namespace {

bool is_address(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

}  // namespace

std::string address_wanted(const std::vector<std::string>& texts) {
  const auto wrong = std::find_if_not(texts.begin(), texts.end(), is_address);
  return wrong == texts.end() ? "" : "IPv4 addresses such as 192.168.2.1, not '" + *wrong + "'";
}

bool is_address_and_port(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || !is_address(text.substr(0, colon))) return false;
  const std::string port = text.substr(colon + 1);
  if (port.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos)
    return false;
  const int number = std::stoi(port);
  return number >= 1 && number <= 65535;
}

void describe(Schema<BusConfig>& s) {
  s.field("domain", &BusConfig::domain, "DDS domain; services of one vehicle share it").range(0, 232);
  s.field("interfaces", &BusConfig::interfaces,
          "addresses of this host that DDS binds; nothing else is bound");
  s.field("peers", &BusConfig::peers, "addresses asked for discovery besides multicast");
  s.field("profiles_dir", &BusConfig::profiles_dir,
          "folder of the QoS XML files; empty: found beside the executable or where installed");
  s.field("security", &BusConfig::security, "proof of identity, permissions and encryption");
  s.field(
      "discovery_servers", &BusConfig::discovery_servers,
      "address:port of each fathom-discovery; others are then found through them alone, without multicast "
      "and peers");
  s.check([](const BusConfig& bus) -> std::pair<std::string, std::string> {
    if (bus.interfaces.empty()) return {"interfaces", "at least one address"};
    if (const std::string wanted = address_wanted(bus.interfaces); !wanted.empty())
      return {"interfaces", wanted};
    if (const std::string wanted = address_wanted(bus.peers); !wanted.empty()) return {"peers", wanted};
    for (const std::string& server : bus.discovery_servers) {
      if (!is_address_and_port(server)) return {"discovery_servers", kAddressAndPort};
    }
    if (!bus.discovery_servers.empty() && !bus.security.folder.empty()) {
      return {"discovery_servers", "none where security.folder is set: Fast DDS 2.9 aborts with both"};
    }
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
  s.field(
      "anchor_file", &ClockConfig::anchor_file,
      "shared by the services of one host, so that they agree on UTC whoever sets the host's clock; empty: "
      "each goes on from UTC as it was at its start");
  s.check([](const ClockConfig& clock) -> std::pair<std::string, std::string> {
    if (clock.rate != 1.0 && clock.epoch_ns == 0) {
      return {"epoch_ns", "an instant, because the rate is not 1 and all services must start from the same"};
    }
    return {};
  });
}

void describe(Schema<RealtimeConfig>& s) {
  s.field("policy", &RealtimeConfig::policy,
          "scheduling of all threads of the service: as it was started, or SCHED_FIFO")
      .words({{"other", SchedulingPolicy::other}, {"fifo", SchedulingPolicy::fifo}});
  s.field("priority", &RealtimeConfig::priority, "of SCHED_FIFO, 1 is the lowest").range(1, 99);
  s.field("lock_memory", &RealtimeConfig::lock_memory,
          "keep what the service has in memory from being paged out");
}

void describe(Schema<CommonConfig>& s) {
  s.field("vehicle", &CommonConfig::vehicle, "name of the vehicle, the first key of every topic").name();
  s.field("bus", &CommonConfig::bus, "the vehicle network");
  s.field("log", &CommonConfig::log, "the service's log on standard error");
  s.field("clock", &CommonConfig::clock, "what the service calls now");
  s.field("realtime", &CommonConfig::realtime,
          "scheduling and memory; what is refused is said, and goes on without");
}

}  // namespace fathom::config
