#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "record/compression.hpp"

namespace fathom::blackbox {

/// What is kept of a vehicle network, and where.
struct Options {
  /// Folder of files that are called fathom-UTC-N.mcap, or one file where the name ends in .mcap, which is
  /// then not split.
  std::filesystem::path out;
  record::Compression compression = record::Compression::zstd;
  std::uint64_t split_bytes = 1U << 30U;      ///< a new file is begun when one is this large; 0: never
  DurationNs split_ns = 3600 * kNsPerSecond;  ///< and when it is this old; 0: never
  std::uint64_t quota_bytes = 16ULL << 30U;   ///< of all files in the folder; the oldest go first; 0: none
  std::uint64_t queue_bytes = 32U << 20U;     ///< samples that wait for the disk
  DurationNs sync_ns = kNsPerSecond / 2;      ///< so often everything is brought to the disk
  bool around_events = false;                 ///< keep only what is around alarms and orders
  DurationNs before_ns = 30 * kNsPerSecond;   ///< of an event
  DurationNs after_ns = 60 * kNsPerSecond;    ///< of the last event
  std::uint64_t before_bytes = 64U << 20U;    ///< most memory for what is before an event
  std::vector<std::string> topics{};          ///< empty: all but the engine's state
  std::string library = "fathom";             ///< who records, with version
};

}  // namespace fathom::blackbox
