#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "cli/export/recorded.hpp"
#include "cli/export/tracks.hpp"
#include "cli/log.hpp"
#include "cli/outputs.hpp"
#include "cli/removed_files.hpp"
#include "dataset/dataset.hpp"
#include "exchange/track.hpp"

namespace fathom::cli {
namespace {

struct ExportOptions {
  std::string source;
  std::string format;
  std::string out;
  std::string epoch;
  std::string track;
  std::string vehicle;
  double rate_hz = -1.0;
};

std::ofstream open(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  if (!file) throw Failure(ExitCode::runtime_failure, path + ": cannot be written: " + std::strerror(errno));
  return file;
}

void close(std::ofstream& file, const std::string& path) {
  file.close();
  if (!file) throw Failure(ExitCode::runtime_failure, path + ": cannot be written: " + std::strerror(errno));
}

/// Where a folder of CSV has the solution.
std::string solution_in(const std::string& folder) {
  return (std::filesystem::path(folder) / "nav.csv").string();
}

std::vector<NamedPath> outputs_of(const ExportOptions& options) {
  if (options.format != "csv") return {{"--out", options.out}};
  std::vector<NamedPath> outputs{{"--out", solution_in(options.out)}};
  // Of a solution nothing else is written.
  if (is_recording(options.source) || std::filesystem::is_directory(options.source))
    outputs.push_back({"--out", options.out, true});
  return outputs;
}

bool holds_nothing(const dataset::Dataset& data) {
  bool nothing = data.reference.empty();
  for_each_kind([&](auto kind) { nothing = nothing && data.of<typename decltype(kind)::Sample>().empty(); });
  return nothing;
}

void write_csv(const ExportOptions& options, std::optional<TimeNs> epoch_ns) {
  if (std::filesystem::is_directory(options.source)) {
    const dataset::Dataset data = read_dataset(options.source, "auv");
    if (holds_nothing(data))
      throw Failure(ExitCode::bad_input,
                    options.source + ": no samples, expected a data set with imu.csv or others");
    const RemovedFiles removed(options.out);
    dataset::write(options.out, data);
    // Where nobody says the instant of t_s = 0 the copy does not, either.
    if (epoch_ns) write_epoch(options.out, *epoch_ns);
    return;
  }
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error)
    throw Failure(ExitCode::runtime_failure, options.out + ": cannot be created: " + error.message());
  copy_with_utc(options.source, solution_in(options.out), epoch_ns.value_or(dataset::kDefaultEpochNs));
}

void refuse_without_recording(const ExportOptions& options) {
  if (!options.vehicle.empty()) {
    throw Failure(ExitCode::bad_configuration,
                  "--vehicle: only a recording has vehicles, " + options.source + " is none");
  }
}

/// The tracks of the source; none where the data themselves are exported, which is done then.
std::vector<exchange::Track> tracks_of_source(const ExportOptions& options) {
  const double rate_hz = options.rate_hz < 0.0 ? 1.0 : options.rate_hz;
  const bool csv = options.format == "csv";
  if (is_recording(options.source)) {
    if (!options.epoch.empty()) {
      throw Failure(ExitCode::bad_configuration,
                    "--epoch: a recording has its own time, expected none with " + options.source);
    }
    const Recorded recorded = read_recorded(options.source, options.vehicle);
    if (!csv) return tracks_of(recorded, rate_hz);
    write_recorded(options.out, recorded);
    for (const std::string& one : recorded.left_out)
      std::fprintf(stderr, "fathom: export: %s: left out, a data set has one sensor of a kind\n",
                   one.c_str());
    return {};
  }
  refuse_without_recording(options);
  const std::optional<TimeNs> epoch_ns = epoch_of(options.source, options.epoch);
  if (!csv) return read_tracks(options.source, epoch_ns.value_or(dataset::kDefaultEpochNs), rate_hz);
  write_csv(options, epoch_ns);
  return {};
}

void export_tracks(const ExportOptions& options) {
  std::vector<exchange::Track> tracks = tracks_of_source(options);
  if (options.format == "csv") {
    std::printf("%s: csv\n", options.out.c_str());
    return;
  }
  if (!options.track.empty()) {
    std::string have;
    for (const exchange::Track& track : tracks) have += (have.empty() ? "" : ", ") + track.name;
    std::erase_if(tracks, [&](const exchange::Track& track) { return track.name != options.track; });
    if (tracks.empty()) {
      throw Failure(ExitCode::bad_input, options.source + ": no track " + options.track +
                                             ", expected one of " + (have.empty() ? "none" : have));
    }
  }
  if (tracks.empty())
    throw Failure(
        ExitCode::bad_input,
        options.source + ": no positions, expected a recording, nav.csv or a data set with gps or reference");
  std::ofstream file = open(options.out);
  const std::string title = std::filesystem::path(options.source).filename().string();
  if (options.format == "kml") exchange::write_kml(file, title, tracks);
  if (options.format == "gpx") exchange::write_gpx(file, title, tracks);
  if (options.format == "geojson") exchange::write_geojson(file, tracks);
  // A stream of sentences is one receiver's: the first track, the solution or the GPS fixes.
  if (options.format == "nmea") exchange::write_nmea(file, tracks.front());
  close(file, options.out);
  for (const exchange::Track& track : tracks) {
    std::printf("%s: %s, %zu points\n", options.out.c_str(), track.name.c_str(), track.points.size());
    if (options.format == "nmea") break;
  }
}

}  // namespace

void add_export(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export", "Writes a recording, a solution or a data set for the programs of others.");
  command->footer(
      "SOURCE is a recording (tracks nav, as it was published, gps, usbl, reference), nav.csv of fathom "
      "solve,\n"
      "or the folder of a data set (tracks gps, usbl, reference).\n"
      "kml, gpx, geojson and nmea have one point a second unless --rate says otherwise; their altitudes are\n"
      "above the WGS-84 ellipsoid. nmea is of one track: the first, or --track. csv writes a folder: the\n"
      "data set, of a recording with nav.csv, or nav.csv again with a column utc.");
  command->add_option("source", options->source, "a recording (.mcap), nav.csv (or .gz), or a data set")
      ->required();
  command->add_option("--format", options->format, "csv, kml, gpx, geojson or nmea")
      ->required()
      ->check(CLI::IsMember({"csv", "kml", "gpx", "geojson", "nmea"}));
  command
      ->add_option("--out", options->out,
                   "file to write; with csv a folder, in which files of an earlier data set are removed")
      ->required();
  command->add_option("--epoch", options->epoch,
                      "UTC of t_s = 0, e.g. 2026-01-31T12:00:00Z; default: that of import.json beside the "
                      "data, else 2020-01-01T00:00:00Z");
  CLI::Option* track =
      command->add_option("--track", options->track, "only this track: nav, gps, usbl or reference");
  command->add_option("--vehicle", options->vehicle,
                      "of a recording: this one; without it: the one that is heard first");
  CLI::Option* rate =
      command->add_option("--rate", options->rate_hz, "points a second; 0: every one; default 1")
          ->check(CLI::Range(0.0, 1e5));
  command->callback([options, track, rate] {
    for (const CLI::Option* of_tracks : {track, rate}) {
      if (options->format == "csv" && of_tracks->count() > 0)
        throw Failure(
            ExitCode::bad_configuration,
            of_tracks->get_name() + ": csv has every row of everything, expected another --format with it");
    }
    refuse_same_files({{"the input", options->source, true}}, outputs_of(*options));
    try {
      export_tracks(*options);
    } catch (const dataset::WriteError& error) {
      throw Failure(ExitCode::runtime_failure, error.what());
    } catch (const dataset::DatasetError& error) {
      throw Failure(ExitCode::bad_input, error.what());
    }
  });
}

}  // namespace fathom::cli
