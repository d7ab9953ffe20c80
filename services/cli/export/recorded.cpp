#include "cli/export/recorded.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/log.hpp"
#include "cli/removed_files.hpp"
#include "dataset/nav_csv.hpp"

namespace fathom::cli {
namespace {

constexpr auto by_stamp = [](const auto& a, const auto& b) { return a.header.stamp_ns < b.header.stamp_ns; };

/// Keeps the sensor that is heard first, in the order of its stamps; names the others.
template <class Sample>
void keep_one_sensor(std::vector<Sample>& stream, std::set<std::string>& others) {
  if (stream.empty()) return;
  const Name first = stream.front().header.sensor;
  std::erase_if(stream, [&](const Sample& one) {
    const bool other = one.header.sensor != first;
    if (other) others.insert(one.header.sensor.str());
    return other;
  });
  std::stable_sort(stream.begin(), stream.end(), by_stamp);
}

}  // namespace

Recorded read_recorded(const std::string& file, const std::string& vehicle) {
  RecordedSamples samples = read_recording(file, Name(vehicle), true);
  Recorded out;
  out.data = std::move(samples.data);
  out.states = std::move(samples.states);
  std::set<std::string> others;
  std::optional<TimeNs> first_ns;
  const auto begins = [&](const auto& stream) {
    if (!stream.empty())
      first_ns = std::min(first_ns.value_or(stream.front().header.stamp_ns), stream.front().header.stamp_ns);
  };
  for_each_kind([&](auto kind) {
    auto& stream = out.data.of<typename decltype(kind)::Sample>();
    keep_one_sensor(stream, others);
    begins(stream);
  });
  out.left_out.assign(others.begin(), others.end());
  // A standby that took over may say again what the one before it said.
  std::stable_sort(out.states.begin(), out.states.end(), by_stamp);
  const auto same = [](const auto& a, const auto& b) { return a.header.stamp_ns == b.header.stamp_ns; };
  out.states.erase(std::unique(out.states.begin(), out.states.end(), same), out.states.end());
  begins(out.states);
  if (!first_ns) {
    throw Failure(ExitCode::bad_input, file + ": no samples and no navigation states" +
                                           (vehicle.empty() ? "" : " of vehicle " + vehicle) +
                                           ", expected topics fathom/v1/imu, fathom/v1/nav_state or others");
  }
  out.epoch_ns = *first_ns / kNsPerSecond * kNsPerSecond;
  return out;
}

void write_recorded(const std::string& folder, const Recorded& recorded) {
  const RemovedFiles removed(folder);
  dataset::write(folder, recorded.data, {recorded.epoch_ns, false});
  const std::filesystem::path path(folder);
  if (!recorded.states.empty()) {
    dataset::NavCsv states(path / "nav.csv", recorded.epoch_ns);
    for (const NavState& state : recorded.states) states.add(state);
    states.close();
  }
  write_epoch(folder, recorded.epoch_ns);
}

void write_epoch(const std::string& folder, TimeNs epoch_ns) {
  const nlohmann::json about{{"utc_of_start", to_iso8601(epoch_ns, 9)}};
  write_text((std::filesystem::path(folder) / "import.json").string(), about.dump(2) + "\n");
}

}  // namespace fathom::cli
