#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "base/clock.hpp"
#include "base/iso8601.hpp"
#include "base/units.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "cli/bus_options.hpp"
#include "cli/command.hpp"
#include "cli/live_commands.hpp"
#include "live/command.hpp"
#include "orders/telling.hpp"
#include "samples/nav_state.hpp"

namespace fathom::cli {
namespace {

struct FixOptions {
  bus::ParticipantOptions bus;
  std::string vehicle;
  std::string from = "operator";
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double sigma_m = 0.0;
  double depth_m = kUnknown;
  double depth_sigma_m = kUnknown;
  std::string time;
  std::optional<double> ago_s;
  double timeout_s = 10.0;
  bool json = false;
};

/// What is heard of the vehicle: its time, and what it says to the fix.
class Vehicle {
 public:
  Vehicle(bus::Participant& participant, std::string vehicle, std::string from)
      : vehicle_(std::move(vehicle)),
        from_(std::move(from)),
        states_(participant, [this](const NavState& state, const bus::SampleInfo&) { heard(state); }),
        verdicts_(participant, [this](const Verdict& verdict, const bus::SampleInfo&) { heard(verdict); }) {}

  /// The header of what is told now, by the vehicle's own clock.
  [[nodiscard]] std::optional<SampleHeader> now(double wait_s) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, std::chrono::duration<double>(wait_s),
                           [this] { return state_.has_value(); }))
      return std::nullopt;
    SampleHeader out = state_->header;
    out.sensor = std::string_view(from_);
    out.received_ns = out.stamp_ns + clock_.monotonic_ns() - heard_ns_;
    // Nobody else in this name has the same number.
    out.sequence = static_cast<std::uint64_t>(out.received_ns);
    return out;
  }
  [[nodiscard]] std::optional<Verdict> verdict(double wait_s) {
    std::unique_lock lock(mutex_);
    (void)changed_.wait_for(lock, std::chrono::duration<double>(wait_s),
                            [this] { return verdict_.has_value(); });
    return verdict_;
  }
  void want(const FixSample& fix) {
    const std::lock_guard lock(mutex_);
    wanted_ = fix.header;
  }
  [[nodiscard]] bool may_hear() const { return verdicts_.matched_writers() > 0; }

 private:
  void heard(const NavState& state) {
    const std::lock_guard lock(mutex_);
    if (!vehicle_.empty() && state.header.vehicle.view() != vehicle_) return;
    state_ = state;
    heard_ns_ = clock_.monotonic_ns();
    changed_.notify_all();
  }
  void heard(const Verdict& verdict) {
    const std::lock_guard lock(mutex_);
    if (!wanted_ || verdict.source != SourceKind::fix || verdict.header.vehicle != wanted_->vehicle ||
        verdict.header.sensor != wanted_->sensor || verdict.header.sequence != wanted_->sequence)
      return;
    verdict_ = verdict;
    changed_.notify_all();
  }

  const std::string vehicle_;
  const std::string from_;
  SystemClock clock_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<NavState> state_;
  TimeNs heard_ns_ = 0;
  std::optional<SampleHeader> wanted_;
  std::optional<Verdict> verdict_;
  bus::Reader<NavState> states_;   // last: their handlers use
  bus::Reader<Verdict> verdicts_;  // all of the above
};

TimeNs instant_of(const FixOptions& options, TimeNs now_ns) {
  if (options.ago_s) return now_ns - from_seconds(*options.ago_s);
  if (options.time.empty()) return now_ns;
  const auto instant = from_iso8601(options.time);
  if (!instant)
    throw Failure(ExitCode::bad_configuration,
                  "--time: is '" + options.time + "', expected UTC like 2026-01-31T12:00:00Z");
  return *instant;
}

ExitCode run(const FixOptions& options) {
  (void)instant_of(options, 0);  // before anything is waited for
  bus::Participant participant(options.bus);
  bus::Writer<FixSample> writer(participant);
  Vehicle vehicle(participant, options.vehicle, options.from);
  if (!vehicle.now(options.timeout_s))
    throw Failure(ExitCode::runtime_failure,
                  "domain " + std::to_string(options.bus.domain) + ": no navigation heard for " +
                      std::to_string(static_cast<int>(options.timeout_s)) + " s, expected a fusion service");
  const SystemClock clock;
  const TimeNs begin_ns = clock.monotonic_ns();
  const auto left_s = [&] { return options.timeout_s - to_seconds(clock.monotonic_ns() - begin_ns); };
  // Whoever would hear it is found first: nothing is kept for those who come later.
  while ((writer.matched_readers() == 0 || !vehicle.may_hear()) && left_s() > 0.0)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (writer.matched_readers() == 0)
    throw Failure(ExitCode::runtime_failure, "domain " + std::to_string(options.bus.domain) +
                                                 ": nobody takes positions, expected a fusion service");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  FixSample fix;
  fix.header = *vehicle.now(1.0);  // it is told now
  fix.header.stamp_ns = instant_of(options, fix.header.received_ns);
  if (fix.header.stamp_ns > fix.header.received_ns)
    throw Failure(ExitCode::bad_configuration, "--time: is " + to_iso8601(fix.header.stamp_ns) +
                                                   ", expected no later than the vehicle's " +
                                                   to_iso8601(fix.header.received_ns));
  fix.latitude_rad = kRadPerDeg * options.lat_deg;
  fix.longitude_rad = kRadPerDeg * options.lon_deg;
  fix.sigma_m = options.sigma_m;
  fix.depth_m = options.depth_m;
  fix.depth_sigma_m = options.depth_sigma_m;
  vehicle.want(fix);
  if (!writer.write(fix)) throw Failure(ExitCode::runtime_failure, "the network did not take the position");
  const auto verdict = vehicle.verdict(std::max(left_s(), 1.0));
  if (!verdict)
    throw Failure(ExitCode::runtime_failure,
                  "fix: told, but no verdict came, expected one of a fusion service");
  std::puts(options.json ? orders::json_line(fix, *verdict).c_str()
                         : orders::in_words(fix, *verdict).c_str());
  return verdict->kind == VerdictKind::used ? ExitCode::done : ExitCode::no;
}

}  // namespace

void add_fix(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<FixOptions>();
  options->bus.name = "fathom_fix";
  CLI::App* command = app.add_subcommand(kFix.name, kFix.description);
  command->footer("Exit code: 0 used, 1 not used; the line says why.");
  command->add_option("--lat", options->lat_deg, "Latitude in degrees, north positive")
      ->check(CLI::Range(-90.0, 90.0))
      ->required();
  command->add_option("--lon", options->lon_deg, "Longitude in degrees, east positive")
      ->check(CLI::Range(-180.0, 180.0))
      ->required();
  command->add_option("--sigma", options->sigma_m, "One sigma of north and of east, m")
      ->check(CLI::Range(0.01, 1e5))
      ->required();
  CLI::Option* depth =
      command->add_option("--depth", options->depth_m, "Depth below the surface, m, where it is known")
          ->check(CLI::Range(-50.0, 12000.0));
  command->add_option("--depth-sigma", options->depth_sigma_m, "One sigma of the depth, m")
      ->check(CLI::Range(0.01, 1e5))
      ->needs(depth);
  CLI::Option* time = command->add_option(
      "--time", options->time, "When the vehicle was there: UTC like 2026-01-31T12:00:00Z; default: now");
  command->add_option("--ago", options->ago_s, "Instead of --time: so many seconds ago")
      ->check(CLI::Range(0.0, 7200.0))
      ->excludes(time);
  command
      ->add_option("--from", options->from,
                   "Who says so: a sensor of kind fix in the vehicle's configuration")
      ->capture_default_str();
  command->add_option("--vehicle", options->vehicle, "Name of the vehicle; default: the first one heard");
  command->add_option("--timeout", options->timeout_s, "Seconds to wait at most")
      ->check(CLI::Range(1.0, 600.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "What became of it as one line of JSON");
  add_bus_options(*command, options->bus, "cli");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fathom::cli
