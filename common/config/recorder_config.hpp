#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

enum class RecordCompression : std::uint8_t { none = 0, lz4 = 1, zstd = 2 };

/// Section "files": what a recording is cut into.
struct RecordFilesConfig {
  RecordCompression compression = RecordCompression::zstd;
  double split_mb = 512.0;    ///< a new file is begun when one is this large
  double split_s = 3600.0;    ///< and when it is this old
  double quota_mb = 16384.0;  ///< of all files; the oldest are removed first
  double sync_s = 0.5;        ///< everything is brought to the disk this often
  double queue_mb = 16.0;     ///< samples that wait for a slow disk
};

/// Section "around_events": only what is around alarms and orders is kept.
struct RecordEventsConfig {
  bool enabled = false;
  double before_s = 30.0;
  double after_s = 60.0;
  double before_mb = 32.0;  ///< most memory for what is before an event
};

/// deploy/config/recorder.json
struct RecorderConfig {
  CommonConfig common;
  std::string folder = "/var/lib/fathom/recordings";
  RecordFilesConfig files;
  RecordEventsConfig around_events;
  std::vector<std::string> topics;   ///< empty: all but the engine's state
  std::vector<std::string> foreign;  ///< patterns of topics that are not this build's; empty: none
};

[[nodiscard]] ConfigKind recorder_kind();

}  // namespace fathom::config
