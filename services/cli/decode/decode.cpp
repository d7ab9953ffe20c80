#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <unistd.h>

#include "cli/command.hpp"
#include "cli/decode/json.hpp"
#include "codec/registry.hpp"

namespace fathom::cli {
namespace {

struct DecodeOptions {
  std::string protocol;
  std::string file;
  bool json = false;
  bool list = false;
  bool no_checksum = false;
  codec::CodecOptions codec;
  double latitude_deg = 0.0;
  double heading_alignment_deg = 0.0;
  std::string ascii_prefix;
};

void write_line(std::string line) {
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), stdout) != line.size()) {
    throw Failure(ExitCode::runtime_failure, std::string("standard output: ") + std::strerror(errno));
  }
}

class JsonLines : public codec::Sink {
 public:
  void on_sample(const codec::Decoded& decoded) override {
    runs_.end(decoded.offset);
    write_line(to_json(decoded));
  }
  void on_rejected(const codec::Rejected& rejected) override { runs_.add(rejected); }
  void finish(const codec::Totals& totals) {
    runs_.end(totals.bytes);
    write_line(to_json(totals));
  }

 private:
  RejectionRuns runs_{[](const RejectionRun& run) { write_line(to_json(run)); }};
};

class Summary : public codec::Sink {
 public:
  void on_sample(const codec::Decoded& decoded) override {
    Kind& kind = kinds_[std::string(to_string(source_of(decoded.sample)))];
    ++kind.count;
    if (const TimeNs utc = utc_of(decoded.time); utc != 0) {
      if (kind.first_ns == 0) kind.first_ns = utc;
      kind.last_ns = utc;
    }
  }
  void on_rejected(const codec::Rejected& rejected) override {
    ++reasons_[std::string(codec::to_string(rejected.reason))];
  }

  void print(const codec::Totals& totals) const {
    for (const auto& [name, kind] : kinds_) {
      std::string line = name + ": " + std::to_string(kind.count) + " samples";
      if (kind.first_ns != 0) line += ", " + to_iso8601(kind.first_ns) + " to " + to_iso8601(kind.last_ns);
      write_line(std::move(line));
    }
    for (const auto& [reason, count] : reasons_) {
      write_line("rejected, " + reason + ": " + std::to_string(count));
    }
    write_line(std::to_string(totals.bytes) + " bytes, " + std::to_string(totals.samples) + " samples, " +
               std::to_string(totals.frames_ignored) + " frames without sample, " +
               std::to_string(totals.rejected) + " rejected, " + std::to_string(totals.skipped_bytes) +
               " bytes between frames");
  }

 private:
  struct Kind {
    std::uint64_t count = 0;
    TimeNs first_ns = 0;
    TimeNs last_ns = 0;
  };
  std::map<std::string, Kind> kinds_;
  std::map<std::string, std::uint64_t> reasons_;
};

/// The file, or standard input for "-".
class Input {
 public:
  explicit Input(const std::string& path)
      : name_(path == "-" ? "standard input" : path),
        fd_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (fd_ < 0) fail();
  }
  ~Input() {
    if (fd_ > STDIN_FILENO) ::close(fd_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// What is there, as soon as anything is; empty at the end.
  std::span<const std::uint8_t> read() {
    ssize_t count = -1;
    do {
      count = ::read(fd_, buffer_.data(), buffer_.size());
    } while (count < 0 && errno == EINTR);
    if (count < 0) fail();
    return {buffer_.data(), static_cast<std::size_t>(count)};
  }

 private:
  [[noreturn]] void fail() const {
    throw Failure(ExitCode::bad_input,
                  name_ + ": cannot be read (" + std::strerror(errno) + "), expected a device recording");
  }

  std::string name_;
  int fd_;
  std::array<std::uint8_t, 65'536> buffer_{};
};

std::string known_protocols() {
  std::string names;
  for (const codec::Protocol& protocol : codec::protocols()) {
    if (!names.empty()) names += ", ";
    names += protocol.name;
  }
  return names;
}

void list_protocols() {
  for (const codec::Protocol& protocol : codec::protocols()) {
    std::string line(protocol.name);
    line.resize(std::max<std::size_t>(line.size(), 16), ' ');
    line += " " + std::string(protocol.description);
    for (std::size_t i = 0; i < protocol.aliases.size(); ++i) {
      line += (i == 0 ? " (also: " : ", ") + std::string(protocol.aliases[i]);
    }
    if (!protocol.aliases.empty()) line += ")";
    write_line(std::move(line));
  }
}

void run(const DecodeOptions& options) {
  if (options.list) return list_protocols();
  if (options.protocol.empty() || options.file.empty()) {
    throw Failure(ExitCode::bad_configuration,
                  "decode: PROTOCOL and FILE are missing, expected both or --list");
  }
  const codec::Protocol* protocol = codec::find_protocol(options.protocol);
  if (protocol == nullptr) {
    throw Failure(ExitCode::bad_configuration, "decode: PROTOCOL: \"" + options.protocol +
                                                   "\" is not known, expected one of " + known_protocols());
  }
  codec::CodecOptions codec_options = options.codec;
  codec_options.require_checksum = !options.no_checksum;
  codec_options.latitude_rad = options.latitude_deg * std::numbers::pi / 180.0;
  codec_options.dvl_heading_alignment_rad = options.heading_alignment_deg * std::numbers::pi / 180.0;
  codec_options.ascii_prefix = options.ascii_prefix;

  Input input(options.file);
  const auto codec = protocol->make(codec_options);
  JsonLines lines;
  Summary summary;
  codec::Sink& sink = options.json ? static_cast<codec::Sink&>(lines) : summary;
  for (auto bytes = input.read(); !bytes.empty(); bytes = input.read()) {
    codec->feed(bytes, sink);
    std::fflush(stdout);  // whoever reads a live stream sees each sample as it arrives
  }
  codec->finish(sink);
  if (options.json) {
    lines.finish(codec->totals());
  } else {
    summary.print(codec->totals());
  }
  if (std::fflush(stdout) != 0) {
    throw Failure(ExitCode::runtime_failure, std::string("standard output: ") + std::strerror(errno));
  }
}

}  // namespace

void add_decode(CLI::App& app, ExitCode& /*exit_code*/) {
  auto options = std::make_shared<DecodeOptions>();
  CLI::App* command = app.add_subcommand("decode", "Run a device recording through its codec.");
  command->footer(
      "Exit code 0 when the recording was read to its end, whatever was found in it: refused frames and "
      "totals "
      "are\npart of the output. 2 for an unknown protocol, 3 when FILE cannot be read.");
  command->add_option("protocol", options->protocol, "Protocol of the device (see --list)");
  command->add_option("file", options->file, "Recorded bytes; - reads standard input as it arrives");
  command->add_flag(
      "--json", options->json,
      "One JSON object a line per sample and per refused frame or run of such frames (with their "
      "count), and one of totals at the end");
  command->add_flag("--list", options->list, "List the protocols and end");
  command->add_flag("--no-checksum", options->no_checksum, "NMEA 0183: accept sentences without checksum");
  command->add_option("--latitude", options->latitude_deg, "Pressure: latitude in degrees, for gravity")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--atmosphere", options->codec.atmosphere_Pa, "Pressure: at the surface, Pa")
      ->check(CLI::Range(0.0, 200'000.0));
  command->add_option("--pressure-unit", options->codec.pressure_unit_Pa, "Pressure: of one unit sent, Pa")
      ->check(CLI::PositiveNumber);
  command->add_flag("--value-is-depth", options->codec.value_is_depth,
                    "Pressure: the value sent is metres of depth");
  command->add_option("--prefix", options->ascii_prefix, "ASCII depth, altitude: text before the number");
  command->add_option("--scale", options->codec.ascii_scale, "ASCII depth, altitude: factor to metres");
  command->add_option("--offset", options->codec.ascii_offset,
                      "ASCII depth, altitude: added after the factor");
  command->add_option("--dvl-heading-alignment", options->heading_alignment_deg,
                      "DVL in instrument or beam axes: degrees from forward to beam 3, clockwise from above");
  command->add_option("--usbl-sigma-floor", options->codec.usbl.sigma_floor_m, "USBL: least sigma, m")
      ->check(CLI::NonNegativeNumber);
  command->add_flag_callback(
      "--usbl-on-vehicle", [options] { options->codec.usbl.carrier = codec::UsblCarrier::vehicle; },
      "EvoLogics: the vehicle carries the head, not a station");
  command
      ->add_option_function<std::string>(
          "--north",
          [options](const std::string& north) {
            options->codec.untold_north = north == "true" ? North::true_north : North::magnetic;
          },
          "Attitude sentences that do not say it: true or magnetic")
      ->check(CLI::IsMember({"true", "magnetic"}));
  command
      ->add_option("--least-confidence", options->codec.least_confidence_percent,
                   "Ping: a range of which the device is less sure is unknown, %")
      ->check(CLI::Range(0.0, 100.0));
  command
      ->add_option("--mavlink-system", options->codec.mavlink_system,
                   "MAVLink: system id of the autopilot; 0: of the first that is heard")
      ->check(CLI::Range(0, 255));
  command
      ->add_option("--stim300-accel-range", options->codec.stim300.accel_range_g,
                   "STIM300: range of its accelerometers, g, where no configuration datagram says it")
      ->check(CLI::IsMember({5.0, 10.0, 30.0, 80.0}));
  command
      ->add_option("--stim300-increments-hz", options->codec.stim300.increments_hz,
                   "STIM300: sample rate where it gives increments; 0: it gives rates and accelerations")
      ->check(CLI::IsMember({0.0, 125.0, 250.0, 500.0, 1000.0, 2000.0}));
  command
      ->add_option("--kvh-increments-hz", options->codec.kvh.increments_hz,
                   "KVH: messages per second where it gives delta angles; 0: it gives rates of rotation")
      ->check(CLI::Range(0.0, 5000.0));
  command->add_flag("--kvh-degrees", options->codec.kvh.degrees, "KVH: rotation is in degrees, not radians");
  command->callback([options] { run(*options); });
}

}  // namespace fathom::cli
