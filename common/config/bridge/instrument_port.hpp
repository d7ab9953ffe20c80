#pragma once

#include "runtime/byte_source.hpp"

namespace fathom::config {

/// The port of an instrument as far as the vehicle's file says it: the catalogue may know the rest. What is
/// missing then is found where the configuration of its bridge is made of it.
struct InstrumentPort : runtime::ByteSourceConfig {};

}  // namespace fathom::config
