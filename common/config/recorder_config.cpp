#include "config/recorder_config.hpp"

#include <utility>

#include "config/service_schema.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

}  // namespace

void describe(Schema<RecordFilesConfig>& s) {
  s.field("compression", &RecordFilesConfig::compression, "of the chunks of a file")
      .words({{"none", RecordCompression::none},
              {"lz4", RecordCompression::lz4},
              {"zstd", RecordCompression::zstd}});
  s.field("split_mb", &RecordFilesConfig::split_mb, "a new file is begun when one is this large")
      .unit("MB")
      .range(1, 1e6);
  s.field("split_s", &RecordFilesConfig::split_s, "and when it is this old").unit("s").range(1, 1e6);
  s.field("quota_mb", &RecordFilesConfig::quota_mb,
          "of all files in the folder; the oldest are removed first")
      .unit("MB")
      .range(2, 1e8);
  s.field("sync_s", &RecordFilesConfig::sync_s, "everything is brought to the disk this often")
      .unit("s")
      .range(0.05, 60);
  s.field("queue_mb", &RecordFilesConfig::queue_mb,
          "samples that wait for a slow disk; what finds no room is dropped and counted")
      .unit("MB")
      .range(0.05, 4096);
  s.check([](const RecordFilesConfig& files) -> Fault {
    if (files.quota_mb < 2.0 * files.split_mb) return {"quota_mb", "at least twice split_mb"};
    return {};
  });
}

void describe(Schema<RecordEventsConfig>& s) {
  s.field("enabled", &RecordEventsConfig::enabled, "keep only what is around alarms and orders");
  s.field("before_s", &RecordEventsConfig::before_s, "kept from before an event").unit("s").range(0, 3600);
  s.field("after_s", &RecordEventsConfig::after_s, "and after the last one").unit("s").range(1, 86400);
  s.field("before_mb", &RecordEventsConfig::before_mb, "most memory for what is before an event")
      .unit("MB")
      .range(1, 4096);
}

void describe(Schema<RecorderConfig>& s) {
  s.include(&RecorderConfig::common);
  s.field("folder", &RecorderConfig::folder, "of the files fathom-UTC-N.mcap; it is made").required();
  s.field("files", &RecorderConfig::files, "what a recording is cut into");
  s.field("around_events", &RecorderConfig::around_events, "a recorder of events");
  s.field("topics", &RecorderConfig::topics,
          "that are kept, e.g. fathom/v1/nav_state; empty: all but the engine's state");
  s.field("foreign", &RecorderConfig::foreign,
          "topics of others on the same domain that are kept as well, e.g. rt/camera or rt/*: their bytes "
          "and the "
          "names of their types; * at the end stands for anything");
  s.check([](const RecorderConfig& config) -> Fault {
    if (config.folder.empty()) return {"folder", "the path of a folder"};
    if (config.folder.ends_with(".mcap")) return {"folder", "a folder, not a file"};
    return {};
  });
}

template LoadedConfig<RecorderConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<RecorderConfig>();

ConfigKind recorder_kind() {
  return make_kind<RecorderConfig>("recorder");
}

}  // namespace fathom::config
