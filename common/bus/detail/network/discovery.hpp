#pragma once

#include <cstdint>
#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "bus/detail/versions/names.hpp"
#include "bus/participant.hpp"

namespace fathom::bus::detail {

/// Address of a discovery server.
struct ServerAddress {
  std::string address;  ///< IPv4
  std::uint16_t port = 0;
};

/// Reads "192.168.2.1:11811". `what` names the option in the error. Throws BusError.
[[nodiscard]] ServerAddress parse_server_address(const std::string& what, const std::string& text);

/// Whether these options leave discovery to servers.
[[nodiscard]] bool uses_servers(const ParticipantOptions& options);

/// Discovery without multicast: as a client of options.discovery_servers, and as a server where
/// options.discovery_listen says so. The interfaces of `options` must be this host's. Throws BusError.
void discover_through_servers(dds::DomainParticipantQos& qos, const ParticipantOptions& options);

/// Waits, before a server starts, until every client has given up a predecessor that was killed just now. The
/// new server has the same GUID but not the same memory. A client that took it for the old one would wait for
/// ever for data that it does not have.
void outlast_predecessor(const dds::DomainParticipantQos& qos, const std::string& listen);

}  // namespace fathom::bus::detail
