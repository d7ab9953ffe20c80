#pragma once

#include <cstdint>
#include <string>

#include "bus/participant.hpp"
#include "support/paths.hpp"

namespace fathom::test {

/// Of a participant on this host alone, with the project's QoS profiles.
inline bus::ParticipantOptions presence(std::uint32_t domain, const std::string& name) {
  bus::ParticipantOptions out;
  out.name = name;
  out.domain = domain;
  out.profiles_dir = source_dir() + "/deploy/dds";
  return out;
}

}  // namespace fathom::test
