#pragma once

#include "bus/participant.hpp"

namespace fathom::bus {

/// What a participant was told cannot be meant: an address that is none, a folder without QoS profiles. The
/// message names it and what was expected.
class OptionError : public BusError {
 public:
  using BusError::BusError;
};

}  // namespace fathom::bus
