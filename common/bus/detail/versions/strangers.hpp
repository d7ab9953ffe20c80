#pragma once

#include "bus/detail/versions/names.hpp"

/// The name space of the library's classes, as it stands in the names of its functions.
#if FATHOM_FASTDDS_MAJOR < 3
#define FATHOM_FASTDDS_MANGLED "8fastrtps"
#else
#define FATHOM_FASTDDS_MANGLED "7fastdds"
#endif

namespace fathom::bus::detail {

/// Whether Fast DDS tells of participants that have not proved an identity. From 3.0 on it tells of their
/// GUID alone.
inline constexpr bool kTellsOfUnproven = FATHOM_FASTDDS_MAJOR < 3;

}  // namespace fathom::bus::detail
