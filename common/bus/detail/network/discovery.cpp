#include "bus/detail/network/discovery.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <system_error>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/detail/versions/settings.hpp"
#include "bus/option_error.hpp"

namespace fathom::bus::detail {
namespace {

std::string text_of(const ServerAddress& server) {
  return server.address + ":" + std::to_string(server.port);
}

rtps::Locator_t locator_of(const ServerAddress& server) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, server.address);
  rtps::IPLocator::setPhysicalPort(locator, server.port);
  return locator;
}

/// A client has to know the server's GUID prefix beforehand, so both derive it from where the server listens.
/// The domain is in it: a client of another vehicle's domain does not get an answer.
rtps::GuidPrefix_t server_prefix(const ServerAddress& server, std::uint32_t domain) {
  const rtps::Locator_t locator = locator_of(server);
  const rtps::octet* const ip = rtps::IPLocator::getIPv4(locator);
  rtps::GuidPrefix_t prefix;
  const rtps::octet bytes[] = {'f',
                               't',
                               'h',
                               'm',
                               ip[0],
                               ip[1],
                               ip[2],
                               ip[3],
                               static_cast<rtps::octet>(server.port >> 8U),
                               static_cast<rtps::octet>(server.port & 0xffU),
                               static_cast<rtps::octet>(domain),
                               0};
  std::copy(std::begin(bytes), std::end(bytes), &prefix.value[0]);
  return prefix;
}

/// Where the port is taken Fast DDS would quietly listen at another, where nobody looks for it.
void check_free(const ServerAddress& server) {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(server.port);
  inet_pton(AF_INET, server.address.c_str(), &place.sin_addr);
  const bool free = bind(probe, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
  const int error = errno;
  close(probe);
  if (free) return;
  throw BusError("discovery_listen '" + text_of(server) + "': " + std::generic_category().message(error) +
                 ", expected a free UDP port of this host");
}

}  // namespace

ServerAddress parse_server_address(const std::string& what, const std::string& text) {
  ServerAddress out;
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    out.address = text.substr(0, colon);
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, out.port);
    if (error == std::errc() && rest == end && out.port != 0 && rtps::IPLocator::isIPv4(out.address))
      return out;
  }
  throw OptionError(what + " '" + text + "': expected an IPv4 address and a port such as 192.168.2.1:11811");
}

bool uses_servers(const ParticipantOptions& options) {
  return !options.discovery_servers.empty() || !options.discovery_listen.empty();
}

void discover_through_servers(dds::DomainParticipantQos& qos, const ParticipantOptions& options) {
  auto& builtin = qos.wire_protocol().builtin;
  auto& discovery = builtin.discovery_config;
  discovery.discoveryProtocol = options.discover_everything ? kDiscoverySuperClient : kDiscoveryClient;
  // Named unicast locators, and so no multicast socket.
  builtin.metatrafficUnicastLocatorList.clear();
  for (const std::string& interface : options.interfaces) {
    rtps::Locator_t locator;
    locator.kind = LOCATOR_KIND_UDPv4;
    rtps::IPLocator::setIPv4(locator, interface);
    builtin.metatrafficUnicastLocatorList.push_back(locator);
  }
  if (!options.discovery_listen.empty()) {
    const ServerAddress own = parse_server_address("discovery_listen", options.discovery_listen);
    if (std::find(options.interfaces.begin(), options.interfaces.end(), own.address) ==
        options.interfaces.end()) {
      throw BusError("discovery_listen '" + options.discovery_listen + "': expected one of the interfaces");
    }
    check_free(own);
    discovery.discoveryProtocol = kDiscoveryServer;
    qos.wire_protocol().prefix = server_prefix(own, options.domain);
    builtin.metatrafficUnicastLocatorList.clear();
    builtin.metatrafficUnicastLocatorList.push_back(locator_of(own));
  }
  for (const std::string& text : options.discovery_servers) {
    if (text == options.discovery_listen) continue;  // one file may list the servers for all, itself included
    const ServerAddress server = parse_server_address("discovery server", text);
    add_server(discovery, locator_of(server), server_prefix(server, options.domain));
  }
}

void outlast_predecessor(const dds::DomainParticipantQos& qos, const std::string& listen) {
  constexpr std::chrono::seconds kMargin(1);  // clients on loaded machines notice late
  const auto& lease = qos.wire_protocol().builtin.discovery_config.leaseDuration;
  std::this_thread::sleep_for(std::chrono::seconds(lease.seconds) + kMargin);
  check_free(parse_server_address("discovery_listen", listen));  // another one may have come up meanwhile
}

}  // namespace fathom::bus::detail
