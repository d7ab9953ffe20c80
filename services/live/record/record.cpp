#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/clock.hpp"
#include "blackbox/recorder.hpp"
#include "blackbox/surroundings.hpp"
#include "blackbox/tap.hpp"
#include "cli/bus_options.hpp"
#include "cli/command.hpp"
#include "cli/live_commands.hpp"
#include "cli/recording.hpp"
#include "config/vehicle/catalogue.hpp"
#include "live/command.hpp"
#include "record/reader.hpp"
#include "record/recover.hpp"
#include "runtime/build_info.hpp"

namespace fathom::cli {
namespace {

struct RecordOptions {
  std::string out;
  std::string recover;
  double duration_s = 0.0;
  std::vector<std::string> topics;
  std::vector<std::string> foreign;
  std::string compression = "zstd";
  bus::ParticipantOptions bus;
};

volatile std::sig_atomic_t recording_stopped = 0;

/// Says what of a closed file cannot be read, which is an error.
void check(const std::string& path) {
  auto reader = record::Reader::open(path);
  if (!reader) throw Failure(ExitCode::bad_input, reader.error().message);
  const record::Outcome found = reader.value().check();
  if (found.problems.empty()) return;
  for (const std::string& problem : found.problems) std::printf("  %s\n", problem.c_str());
  throw Failure(ExitCode::bad_input, path + ": is closed but damaged: " + std::to_string(found.messages) +
                                         " of " +
                                         std::to_string(reader.value().contents().statistics.message_count) +
                                         " messages can be read; what is damaged was left as it is");
}

void recover(const std::string& path) {
  const auto recovery = record::recover(path);
  if (!recovery) throw Failure(ExitCode::bad_input, recovery.error().message);
  const record::Recovery& one = recovery.value();
  if (one.was_whole) {
    check(path);
    std::printf("%s: is whole, %llu messages\n", path.c_str(), static_cast<unsigned long long>(one.messages));
    return;
  }
  std::printf("%s: closed with %llu messages; %llu bytes behind them were no whole record (%s)%s%s\n",
              path.c_str(), static_cast<unsigned long long>(one.messages),
              static_cast<unsigned long long>(one.cut), one.ending.c_str(),
              one.rest.empty() ? "" : ", kept in ", one.rest.c_str());
  check(path);
}

std::string default_name(TimeNs now_ns) {
  std::string stamp = to_iso8601(now_ns, 0);
  std::erase_if(stamp, [](char c) { return c == '-' || c == ':'; });
  return "fathom-" + stamp + ".mcap";
}

ExitCode record(const RecordOptions& options) {
  const SystemClock clock;
  blackbox::Options keep;
  keep.out = options.out.empty() ? default_name(clock.utc_ns()) : options.out;
  if (keep.out.extension() != ".mcap") {
    throw Failure(ExitCode::bad_configuration,
                  "--out " + options.out + ": expected a name that ends in .mcap");
  }
  if (std::filesystem::exists(keep.out)) {
    throw Failure(ExitCode::bad_configuration, keep.out.string() + ": is there already, expected a new file");
  }
  keep.compression = options.compression == "lz4"    ? record::Compression::lz4
                     : options.compression == "none" ? record::Compression::none
                                                     : record::Compression::zstd;
  keep.library = "fathom record " + std::string(runtime::version());
  const std::vector<std::string> topics = topics_of(options.topics);
  recording_stopped = 0;
  std::signal(SIGINT, [](int) { recording_stopped = 1; });
  std::signal(SIGTERM, [](int) { recording_stopped = 1; });
  blackbox::StoreCounts counts;
  {
    bus::Participant participant(options.bus);
    blackbox::Recorder recorder(keep, clock, [](bool /*is_trouble*/, const std::string& line) {
      std::fprintf(stderr, "fathom: record: %s\n", line.c_str());
    });
    blackbox::Tap tap(participant, recorder.queue(), clock, topics, runtime::host_name(),
                      config::catalogue_directory());
    for (blackbox::Enclosure& one : blackbox::qos_profiles(options.bus.profiles_dir, clock.utc_ns()))
      recorder.queue().put(std::move(one));
    for (const std::string& line : tap.refused()) std::fprintf(stderr, "fathom: record: %s\n", line.c_str());
    const TimeNs end_ns = clock.monotonic_ns() + from_seconds(options.duration_s);
    for (int i = 0; recording_stopped == 0 && (options.duration_s <= 0.0 || clock.monotonic_ns() < end_ns);
         ++i) {
      constexpr int kLookEvery = 10;
      if (i % kLookEvery == 0 && !options.foreign.empty()) {
        for (const std::string& line : tap.look_around(options.foreign))
          std::fprintf(stderr, "fathom: record: %s\n", line.c_str());
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    std::this_thread::sleep_for(std::chrono::nanoseconds(2 * keep.sync_ns));  // the counts of what came
    counts = recorder.counts();
  }
  if (counts.files == 0) {
    if (!counts.trouble.empty())
      throw Failure(ExitCode::runtime_failure, "record: " + keep.out.string() + ": " + counts.trouble);
    throw Failure(ExitCode::no, "record: nothing came on domain " + std::to_string(options.bus.domain));
  }
  std::printf("%s: %llu messages, %llu bytes, %llu lost\n", keep.out.c_str(),
              static_cast<unsigned long long>(counts.samples), static_cast<unsigned long long>(counts.bytes),
              static_cast<unsigned long long>(counts.lost));
  // What is lost the disk did not take, or not quickly enough.
  return counts.lost == 0 && counts.trouble.empty() ? ExitCode::done : ExitCode::runtime_failure;
}

}  // namespace

void add_record(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<RecordOptions>();
  options->bus.name = "fathom_record";
  options->bus.low_priority = true;
  auto* command = app.add_subcommand(kRecord.name, kRecord.description);
  command->add_option("--out", options->out, "file to write; default: fathom-UTC.mcap");
  command->add_option("--duration", options->duration_s, "seconds; default: until Ctrl-C")
      ->check(CLI::Range(0.1, 1e7));
  auto* mend = command->add_option("--recover", options->recover,
                                   "record nothing: close a file that was cut off, in its place");
  command->add_option("--topic", options->topics, "only this one, e.g. nav_state; may be repeated")
      ->allow_extra_args(false)
      ->excludes(mend);
  command
      ->add_option("--foreign", options->foreign,
                   "also topics of others on the domain, e.g. rt/camera or 'rt/*'; may be repeated")
      ->allow_extra_args(false)
      ->excludes(mend);
  command->add_option("--compression", options->compression, "of the chunks")
      ->check(CLI::IsMember({"zstd", "lz4", "none"}))
      ->capture_default_str();
  add_bus_options(*command, options->bus, "recorder");
  command->callback([options, &exit_code] {
    if (!options->recover.empty()) return recover(options->recover);
    exit_code = record(*options);
  });
}

}  // namespace fathom::cli
