#pragma once

#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>

#include "bus/detail/versions/names.hpp"

namespace fathom::bus::detail {

/// Loads a file of QoS profiles, written as for Fast DDS 2, into the process; one loaded before is skipped.
/// False when Fast DDS does not understand it.
[[nodiscard]] bool load_profiles_file(const std::string& path);

#if FATHOM_FASTDDS_MAJOR < 3
inline constexpr auto kDiscoveryClient = rtps::DiscoveryProtocol_t::CLIENT;
inline constexpr auto kDiscoverySuperClient = rtps::DiscoveryProtocol_t::SUPER_CLIENT;
inline constexpr auto kDiscoveryServer = rtps::DiscoveryProtocol_t::SERVER;

/// A server to ask, known by where it listens and, until 3.0, by its GUID prefix.
template <class Discovery>
void add_server(Discovery& discovery, const rtps::Locator_t& at, const rtps::GuidPrefix_t& prefix) {
  rtps::RemoteServerAttributes server;
  server.guidPrefix = prefix;
  server.metatrafficUnicastLocatorList.push_back(at);
  discovery.m_DiscoveryServers.push_back(server);
}

inline Duration heartbeat_period(const dds::DataWriterQos& qos) {
  return qos.reliable_writer_qos().times.heartbeatPeriod;
}
#else
inline constexpr auto kDiscoveryClient = rtps::DiscoveryProtocol::CLIENT;
inline constexpr auto kDiscoverySuperClient = rtps::DiscoveryProtocol::SUPER_CLIENT;
inline constexpr auto kDiscoveryServer = rtps::DiscoveryProtocol::SERVER;

template <class Discovery>
void add_server(Discovery& discovery, const rtps::Locator_t& at, const rtps::GuidPrefix_t& /*prefix*/) {
  discovery.m_DiscoveryServers.push_back(at);
}

inline Duration heartbeat_period(const dds::DataWriterQos& qos) {
  return qos.reliable_writer_qos().times.heartbeat_period;
}
#endif

}  // namespace fathom::bus::detail
