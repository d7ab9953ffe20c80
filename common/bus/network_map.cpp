#include "bus/network_map.hpp"

#include "bus/detail/participant_impl.hpp"

namespace fathom::bus {

std::vector<NetworkEndpoint> endpoints(Participant& participant) {
  return participant.impl().peers.endpoints();
}

std::vector<NetworkConflict> conflicts(Participant& participant) {
  return participant.impl().peers.conflicts();
}

}  // namespace fathom::bus
