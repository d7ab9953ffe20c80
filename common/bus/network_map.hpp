#pragma once

#include <string>
#include <vector>

#include "bus/participant.hpp"

namespace fathom::bus {

/// A reader or writer, as discovery knows it. Those of this participant are among them, named by their GUID.
struct NetworkEndpoint {
  Peer owner;
  std::string topic;
  std::string type;
  bool writes = false;
};

/// A writer and a reader of one topic that can never meet.
struct NetworkConflict {
  std::string topic;
  std::string policy;  ///< "deadline", or "type" where the two disagree in it
  Peer writer;
  std::string offered;  ///< e.g. "100 ms", "best effort", a type's name
  Peer reader;
  std::string requested;
};

/// What is read and written on the domain, in the order of topic and owner.
[[nodiscard]] std::vector<NetworkEndpoint> endpoints(Participant& participant);
/// Every pair among them that the rules of DDS keep apart.
[[nodiscard]] std::vector<NetworkConflict> conflicts(Participant& participant);

}  // namespace fathom::bus
