#pragma once

#include <cstdint>
#include <vector>

#include "samples/header.hpp"
#include "samples/kinds.hpp"

namespace fathom {

enum class IntakeKind : std::uint8_t {
  sample,
  order,
  state,  ///< the engine went on from a state that it had not made itself
  end     ///< nothing more is given, and what the engine held back is judged
};

/// One thing that fusion gave to its engine.
struct IntakeEntry {
  IntakeKind kind = IntakeKind::sample;
  SourceKind source = SourceKind::imu;  ///< of a sample
  Name sensor;                          ///< of an order: who gave it; of a state: who saved it, where known
  Name writer;                          ///< who published the sample, where known
  TimeNs stamp_ns = 0;
  std::uint64_t sequence = 0;  ///< of a state: its digest (archive/digest.hpp)
  bool again = false;  ///< given to an earlier state as well; what the engine says of it is not published
};

/// The next entries of one run of a fusion service; header.sensor is the instance.
struct IntakeRecord {
  static constexpr std::size_t kMostEntries = 64;
  SampleHeader header;
  std::uint64_t first = 0;           ///< number of the first entry here among those of this run, from 0
  std::vector<IntakeEntry> entries;  ///< at most kMostEntries
};

}  // namespace fathom
