#pragma once

#include <cstdint>
#include <vector>

#include "samples/header.hpp"
#include "samples/kinds.hpp"

namespace fathom {

/// A sample or an order as fusion gave it to its engine.
struct IntakeEntry {
  bool is_order = false;
  SourceKind source = SourceKind::imu;  ///< of a sample
  Name sensor;                          ///< of an order: who gave it
  Name writer;                          ///< who published the sample, where known
  TimeNs stamp_ns = 0;
  std::uint64_t sequence = 0;
};

/// The next entries of one run of a fusion service; header.sensor is the instance.
struct IntakeRecord {
  static constexpr std::size_t kMostEntries = 64;
  SampleHeader header;
  bool resumed = false;              ///< the run began with, or took up, a state that it did not make itself
  std::uint64_t first = 0;           ///< number of the first entry here among those of this run, from 0
  std::vector<IntakeEntry> entries;  ///< at most kMostEntries
};

}  // namespace fathom
