#include "recorder/recorder_service.hpp"

#include <string>
#include <utility>

#include "blackbox/recorder.hpp"
#include "blackbox/surroundings.hpp"
#include "blackbox/tap.hpp"
#include "config/vehicle/catalogue.hpp"
#include "runtime/build_info.hpp"

namespace fathom::recorder {
namespace {

std::uint64_t megabytes(double count) {
  return static_cast<std::uint64_t>(count * 1e6);
}

record::Compression compression_of(config::RecordCompression word) {
  switch (word) {
    case config::RecordCompression::none:
      return record::Compression::none;
    case config::RecordCompression::lz4:
      return record::Compression::lz4;
    case config::RecordCompression::zstd:
      return record::Compression::zstd;
  }
  return record::Compression::zstd;
}

blackbox::Options options_of(const config::RecorderConfig& config, const host::ServiceHost& host) {
  blackbox::Options out;
  out.out = config.folder;
  out.compression = compression_of(config.files.compression);
  out.split_bytes = megabytes(config.files.split_mb);
  out.split_ns = from_seconds(config.files.split_s);
  out.quota_bytes = megabytes(config.files.quota_mb);
  out.queue_bytes = megabytes(config.files.queue_mb);
  out.sync_ns = from_seconds(config.files.sync_s);
  out.around_events = config.around_events.enabled;
  out.before_ns = from_seconds(config.around_events.before_s);
  out.after_ns = from_seconds(config.around_events.after_s);
  out.before_bytes = megabytes(config.around_events.before_mb);
  out.topics = config.topics;
  out.library = host.name() + " " + std::string(runtime::version());
  return out;
}

}  // namespace

struct RecorderService::Impl {
  Impl(host::ServiceHost& the_host, const config::RecorderConfig& config)
      : host(the_host),
        recorder(options_of(config, the_host), the_host.clock(),
                 [log = &the_host.log()](bool is_trouble, const std::string& line) {
                   log->write(is_trouble ? runtime::LogLevel::warning : runtime::LogLevel::info, line);
                 }),
        tap(the_host.participant(), recorder.queue(), the_host.clock(), config.topics, runtime::host_name(),
            config::catalogue_directory()) {
    for (blackbox::Enclosure& one :
         blackbox::qos_profiles(config.common.bus.profiles_dir, the_host.clock().utc_ns()))
      recorder.queue().put(std::move(one));
    for (const std::string& topic : tap.refused()) host.log().warning("not recorded: " + topic);
    host.on_status([this](ServiceStatus& status) { fill(status); });
    if (config.foreign.empty()) return;
    host.on_tick(kNsPerSecond, [this, patterns = config.foreign] {
      for (const std::string& line : tap.look_around(patterns)) host.log().warning("not recorded: " + line);
    });
  }
  ~Impl() {
    host.on_status([](ServiceStatus&) {});
    host.on_tick(kNsPerSecond, [] {});
  }

  void fill(ServiceStatus& status) {
    const blackbox::StoreCounts counts = recorder.counts();
    status.counters.push_back({"samples", counts.samples});
    status.counters.push_back({"bytes", counts.bytes});
    status.counters.push_back({"files", counts.files});
    if (counts.lost > 0) status.counters.push_back({"samples_lost", counts.lost});
    if (counts.removed > 0) status.counters.push_back({"files_removed", counts.removed});
    status.rates.push_back({"samples", static_cast<double>(counts.samples - last_samples)});
    last_samples = counts.samples;
    if (!counts.trouble.empty()) {
      status.state = ServiceState::degraded;
      status.text = "nothing is recorded: " + counts.trouble;
    } else if (counts.lost > last_lost) {
      status.text = std::to_string(counts.lost - last_lost) + " samples were dropped";
    }
    last_lost = counts.lost;
  }

  host::ServiceHost& host;
  std::uint64_t last_samples = 0;
  std::uint64_t last_lost = 0;
  blackbox::Recorder recorder;
  blackbox::Tap tap;  // ends first: it fills the recorder's queue
};

RecorderService::RecorderService(host::ServiceHost& host, const config::RecorderConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}
RecorderService::~RecorderService() = default;

}  // namespace fathom::recorder
