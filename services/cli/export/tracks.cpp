#include "cli/export/tracks.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "base/disk/regular_file.hpp"
#include "base/iso8601.hpp"
#include "base/units.hpp"
#include "cli/command.hpp"
#include "cli/log.hpp"
#include "dataset/csv_reader.hpp"
#include "dataset/csv_writer.hpp"
#include "dataset/dataset.hpp"
#include "dataset/nav_rows.hpp"

namespace fathom::cli {
namespace {

using exchange::Point;
using exchange::Quality;
using exchange::Track;

Quality quality_of(GpsFix fix) {
  switch (fix) {
    case GpsFix::fix_2d:
      return Quality::fix_2d;
    case GpsFix::fix_3d:
      return Quality::fix_3d;
    case GpsFix::differential:
      return Quality::differential;
    case GpsFix::rtk_float:
      return Quality::rtk_float;
    case GpsFix::rtk_fixed:
      return Quality::rtk_fixed;
    case GpsFix::none:
    case GpsFix::time_only:
      return Quality::none;
    case GpsFix::dead_reckoning:
      return Quality::estimated;
  }
  return Quality::none;
}

class Adder {
 public:
  Adder(Track& track, double rate_hz)
      : track_(track), period_ns_(rate_hz > 0.0 ? from_seconds(1.0 / rate_hz) : 0) {}

  void add(Point point, double latitude_rad, double longitude_rad) {
    if (!known(latitude_rad) || !known(longitude_rad)) return;
    // A grid: what comes a little early is not left out.
    if (started_ && point.utc_ns + period_ns_ / 10 < next_ns_) return;
    if (!started_ || point.utc_ns - next_ns_ > period_ns_) next_ns_ = point.utc_ns;
    started_ = true;
    next_ns_ += period_ns_;
    point.latitude_deg = latitude_rad * kDegPerRad;
    point.longitude_deg = exchange::wrapped_longitude_deg(longitude_rad * kDegPerRad);
    track_.points.push_back(point);
  }

 private:
  Track& track_;
  DurationNs period_ns_;
  TimeNs next_ns_ = 0;
  bool started_ = false;
};

double heading_deg(double yaw_rad) {
  const double degrees = std::fmod(yaw_rad * kDegPerRad, 360.0);
  return degrees < 0.0 ? degrees + 360.0 : degrees;
}

/// A state as nav.csv has it.
void add_state(Adder& adder, const dataset::NavRow& row, TimeNs utc_ns) {
  Point point;
  point.utc_ns = utc_ns;
  point.altitude_m = row.altitude_m;
  point.velocity_N_m_s = row.velocity_N_m_s;
  point.heading_deg = heading_deg(row.rpy_rad[2]);
  point.sigma_N_m = row.position_sigma_N_m;
  point.quality = row.mode == "gps_aided"                        ? Quality::fix_3d
                  : row.mode == "none" || row.mode == "aligning" ? Quality::none
                                                                 : Quality::estimated;
  adder.add(point, row.latitude_rad, row.longitude_rad);
}

Track nav_track(const std::string& source, TimeNs epoch_ns, double rate_hz) {
  Track track{"nav", {}};
  Adder adder(track, rate_hz);
  dataset::read_nav_rows(source,
                         [&](const dataset::NavRow& row) { add_state(adder, row, epoch_ns + row.t_ns); });
  return track;
}

std::vector<Track> tracks_of(const dataset::Dataset& data, double rate_hz) {
  Track gps{"gps", {}};
  Adder fixes(gps, rate_hz);
  for (const GpsSample& fix : data.of<GpsSample>()) {
    if (quality_of(fix.fix) == Quality::none) continue;
    Point point;
    point.utc_ns = fix.header.stamp_ns;
    point.altitude_m = fix.altitude_m;
    point.velocity_N_m_s = fix.velocity_N_m_s;
    point.sigma_N_m = fix.position_sigma_N_m;
    point.quality = quality_of(fix.fix);
    point.satellites = fix.satellites;
    fixes.add(point, fix.latitude_rad, fix.longitude_rad);
  }
  Track usbl{"usbl", {}};
  Adder acoustic(usbl, rate_hz);
  for (const UsblSample& fix : data.of<UsblSample>()) {
    Point point;
    point.utc_ns = fix.header.stamp_ns;
    point.altitude_m = -fix.depth_m;
    acoustic.add(point, fix.latitude_rad, fix.longitude_rad);
  }
  Track reference{"reference", {}};
  Adder truth(reference, rate_hz);
  for (const Truth& row : data.reference) {
    Point point;
    point.utc_ns = row.header.stamp_ns;
    point.altitude_m = row.altitude_m;
    point.velocity_N_m_s = row.velocity_N_m_s;
    point.heading_deg = heading_deg(row.rpy_rad[2]);
    truth.add(point, row.latitude_rad, row.longitude_rad);
  }
  std::vector<Track> tracks;
  for (Track* track : {&gps, &usbl, &reference})
    if (!track->points.empty()) tracks.push_back(std::move(*track));
  return tracks;
}

}  // namespace

std::optional<TimeNs> epoch_of(const std::string& source, const std::string& asked) {
  if (!asked.empty()) {
    if (const auto epoch_ns = from_iso8601(asked)) return epoch_ns;
    throw Failure(ExitCode::bad_configuration,
                  "--epoch " + asked + ": is no instant, expected one like 2026-01-31T12:00:00Z");
  }
  const std::filesystem::path file = std::filesystem::path(source) / "import.json";
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return std::nullopt;
  constexpr std::size_t kMostBytes = 4UL << 20U;
  const auto text = read_regular_file(file, kMostBytes);
  if (!text) throw Failure(ExitCode::bad_input, file.string() + ": " + text.error().message);
  const auto json = nlohmann::json::parse(text.value(), nullptr, false);
  if (!json.is_object())
    throw Failure(ExitCode::bad_input,
                  file.string() + ": is no JSON object, expected what fathom import writes");
  if (!json.contains("utc_of_start") || json["utc_of_start"].is_null()) return std::nullopt;
  const nlohmann::json& said = json["utc_of_start"];
  const auto epoch_ns = said.is_string() ? from_iso8601(said.get<std::string>()) : std::nullopt;
  if (!epoch_ns)
    throw Failure(ExitCode::bad_input, file.string() + ": utc_of_start: is " + said.dump() +
                                           ", expected one like \"2026-01-31T12:00:00Z\", or --epoch");
  return epoch_ns;
}

std::vector<Track> read_tracks(const std::string& source, TimeNs epoch_ns, double rate_hz) {
  if (std::filesystem::is_directory(source)) return tracks_of(read_dataset(source, "auv", epoch_ns), rate_hz);
  std::vector<Track> tracks{nav_track(source, epoch_ns, rate_hz)};
  if (tracks.front().points.empty()) tracks.clear();
  return tracks;
}

std::vector<Track> tracks_of(const Recorded& recorded, double rate_hz) {
  Track nav{"nav", {}};
  Adder states(nav, rate_hz);
  for (const NavState& state : recorded.states) {
    dataset::NavRow row;
    row.latitude_rad = state.latitude_rad;
    row.longitude_rad = state.longitude_rad;
    row.altitude_m = state.altitude_m;
    row.velocity_N_m_s = state.velocity_N_m_s;
    row.rpy_rad = state.rpy_rad;
    for (std::size_t i = 0; i < 3; ++i)
      row.position_sigma_N_m[i] = std::sqrt(state.position_covariance_N_m2[4 * i]);
    row.mode = to_string(state.mode);
    add_state(states, row, state.header.stamp_ns);
  }
  std::vector<Track> tracks;
  if (!nav.points.empty()) tracks.push_back(std::move(nav));
  for (Track& track : tracks_of(recorded.data, rate_hz)) tracks.push_back(std::move(track));
  return tracks;
}

void copy_with_utc(const std::string& source, const std::string& out, TimeNs epoch_ns) {
  dataset::CsvReader csv(source);
  const auto t = csv.column("t_s");
  std::string header = "utc";
  const std::size_t columns = csv.columns();
  for (std::size_t i = 0; i < columns; ++i) header += "," + std::string(csv.name(i));
  dataset::CsvWriter copy(out);
  copy.line(header);
  while (csv.next()) {
    const double t_s = csv.number(t);
    if (!(std::abs(t_s) < 4e9)) csv.fail("column t_s: '" + std::string(csv.text(t)) + "', expected seconds");
    copy.text(to_iso8601(epoch_ns + from_seconds(t_s), 6));
    for (std::size_t i = 0; i < columns; ++i) copy.text(csv.text(i));
    copy.end_row();
  }
  copy.close();
}

}  // namespace fathom::cli
