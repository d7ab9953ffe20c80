#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/is_name.hpp"
#include "blackbox/player.hpp"
#include "cli/bus_options.hpp"
#include "cli/command.hpp"
#include "cli/live_commands.hpp"
#include "cli/recording.hpp"
#include "live/command.hpp"
#include "live/record/verify.hpp"
#include "record/reader.hpp"
#include "samples/kinds.hpp"

namespace fathom::cli {
namespace {

struct ReplayOptions {
  std::vector<std::string> files;
  double speed = 1.0;
  double from_s = 0.0;
  double to_s = 0.0;
  bool sensors_only = false;
  bool loop = false;
  bool now = false;
  bool verify = false;
  std::vector<std::string> topics;
  std::vector<std::string> renames;
  bus::ParticipantOptions bus;
};

volatile std::sig_atomic_t replay_stopped = 0;

ExitCode replay(const ReplayOptions& options) {
  if (options.to_s > 0.0 && options.to_s <= options.from_s) {
    std::ostringstream range;
    range << "--to " << options.to_s << ": expected more than --from, which is " << options.from_s;
    throw Failure(ExitCode::bad_configuration, range.str());
  }
  std::vector<record::Reader> readers;
  for (const std::string& file : options.files) readers.push_back(open_recording(file));
  blackbox::PlayOptions play;
  play.speed = options.speed;
  play.now = options.now;
  play.selection.topics = topics_of(options.topics);
  if (options.sensors_only)
    for_each_kind([&](auto kind) { play.selection.topics.emplace_back(kind.kTopic); });
  const TimeNs begin = readers.front().contents().statistics.message_start_time;
  if (options.from_s > 0.0) play.selection.from = begin + from_seconds(options.from_s);
  if (options.to_s > 0.0) play.selection.to = begin + from_seconds(options.to_s);
  for (const std::string& rename : options.renames) {
    const std::size_t at = rename.find('=');
    const bool good =
        at != std::string::npos && is_name(rename.substr(0, at)) && is_name(rename.substr(at + 1));
    if (!good)
      throw Failure(ExitCode::bad_configuration,
                    "--rename " + rename + ": expected OLD=NEW, names of vehicles");
    play.vehicles[rename.substr(0, at)] = rename.substr(at + 1);
  }
  replay_stopped = 0;
  std::signal(SIGINT, [](int) { replay_stopped = 1; });
  std::signal(SIGTERM, [](int) { replay_stopped = 1; });
  bus::Participant participant(options.bus);
  blackbox::Played sum;
  bool came = true;
  do {
    came = false;
    for (record::Reader& reader : readers) {
      const blackbox::Played played =
          blackbox::play(reader, participant, play, [] { return replay_stopped == 0; });
      sum.samples += played.samples;
      sum.refused += played.refused;
      sum.problems.insert(sum.problems.end(), played.problems.begin(), played.problems.end());
      came = came || played.samples > 0;
    }
  } while (options.loop && replay_stopped == 0 && came && sum.problems.empty());
  for (const std::string& problem : sum.problems)
    std::fprintf(stderr, "fathom: %s: %s\n", options.files.front().c_str(), problem.c_str());
  std::printf("%s: %llu samples published, %llu refused\n", options.files.front().c_str(),
              static_cast<unsigned long long>(sum.samples), static_cast<unsigned long long>(sum.refused));
  return sum.problems.empty() && sum.refused == 0 && sum.samples > 0 ? ExitCode::done : ExitCode::no;
}

}  // namespace

void add_replay(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  options->bus.name = "fathom_replay";
  auto* command = app.add_subcommand(kReplay.name, kReplay.description);
  command->add_option("file", options->files, "recording (MCAP); several that follow one another")
      ->required();
  auto* speed = command->add_option("--speed", options->speed, "times as fast; 0: as fast as it goes")
                    ->check(CLI::Range(0.0, 1000.0))
                    ->capture_default_str();
  auto* from = command->add_option("--from", options->from_s, "seconds after the beginning of the file")
                   ->check(CLI::Range(0.0, 1e9));
  auto* to = command->add_option("--to", options->to_s, "seconds after the beginning of the file")
                 ->check(CLI::Range(0.0, 1e9));
  auto* sensors = command->add_flag("--sensors-only", options->sensors_only,
                                    "what instruments said and nothing else, so that fusion runs anew");
  auto* topic =
      command->add_option("--topic", options->topics, "only this one, e.g. nav_state; may be repeated")
          ->allow_extra_args(false)
          ->excludes(sensors);
  auto* rename =
      command->add_option("--rename", options->renames, "OLD=NEW: vehicle OLD is called NEW; may be repeated")
          ->allow_extra_args(false);
  auto* now = command->add_flag("--now", options->now, "move all stamps, so that it happens now");
  auto* loop = command->add_flag("--loop", options->loop, "begin again at the end, until Ctrl-C");
  auto* proves = command->add_flag(
      "--verify", options->verify,
      "publish nothing: prove that states and verdicts follow from the samples, to the last bit");
  for (CLI::Option* of_publishing : {speed, from, to, sensors, topic, rename, now, loop})
    proves->excludes(of_publishing);
  add_bus_options(*command, options->bus, "cli");
  command->callback(
      [options, &exit_code] { exit_code = options->verify ? verify(options->files) : replay(*options); });
}

}  // namespace fathom::cli
