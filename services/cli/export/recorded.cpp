#include "cli/export/recorded.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "bus/cdr.hpp"
#include "cli/command.hpp"
#include "cli/recording.hpp"
#include "dataset/nav_csv.hpp"

namespace fathom::cli {
namespace {

constexpr const char* kNavState = "fathom/v1/nav_state";
constexpr const char* kTruth = "fathom/v1/truth";

/// Keeps the samples of one vehicle, and of each kind those of one sensor.
class Gatherer {
 public:
  Gatherer(Recorded& out, Name vehicle) : out_(out), vehicle_(vehicle) {}

  void take(const std::string& topic, std::span<const std::uint8_t> bytes) {
    if (topic == kTruth) keep(bytes, out_.data.reference);
    if (topic == kNavState) keep(bytes, out_.states);
    for_each_kind([&](auto kind) {
      if (topic != kind.kTopic) return;
      auto& stream = out_.data.of<typename decltype(kind)::Sample>();
      keep(bytes, stream);
      if (stream.empty() || stream.back().header.sensor == stream.front().header.sensor) return;
      others_.insert(stream.back().header.sensor.str());
      stream.pop_back();
    });
  }
  /// False when there is nothing.
  [[nodiscard]] bool finish() {
    out_.left_out.assign(others_.begin(), others_.end());
    // A standby that took over may say again what the one before it said.
    std::stable_sort(out_.states.begin(), out_.states.end(), by_stamp);
    const auto end = std::unique(out_.states.begin(), out_.states.end(), [](const auto& a, const auto& b) {
      return a.header.stamp_ns == b.header.stamp_ns;
    });
    out_.states.erase(end, out_.states.end());
    constexpr TimeNs kNone = std::numeric_limits<TimeNs>::max();
    TimeNs first_ns = kNone;
    for_each_kind([&](auto kind) {
      auto& stream = out_.data.of<typename decltype(kind)::Sample>();
      std::stable_sort(stream.begin(), stream.end(), by_stamp);
      if (!stream.empty()) first_ns = std::min(first_ns, stream.front().header.stamp_ns);
    });
    if (!out_.states.empty()) first_ns = std::min(first_ns, out_.states.front().header.stamp_ns);
    out_.epoch_ns = first_ns / kNsPerSecond * kNsPerSecond;
    return first_ns != kNone;
  }
  [[nodiscard]] std::uint64_t foreign() const { return foreign_; }

 private:
  static constexpr auto by_stamp = [](const auto& a, const auto& b) {
    return a.header.stamp_ns < b.header.stamp_ns;
  };

  template <class T>
  void keep(std::span<const std::uint8_t> bytes, std::vector<T>& into) {
    const auto sample = bus::from_cdr<T>(bytes);
    if (!sample) {
      ++foreign_;
      return;
    }
    if (vehicle_.view().empty()) vehicle_ = sample->header.vehicle;
    if (sample->header.vehicle == vehicle_) into.push_back(*sample);
  }

  Recorded& out_;
  Name vehicle_;
  std::set<std::string> others_;
  std::uint64_t foreign_ = 0;
};

}  // namespace

Recorded read_recorded(const std::string& file, const std::string& vehicle) {
  record::Reader reader = open_recording(file);
  Recorded out;
  Gatherer gatherer(out, Name(vehicle));
  record::Selection selection;
  selection.topics = {kTruth, kNavState};
  for_each_kind([&](auto kind) { selection.topics.emplace_back(kind.kTopic); });
  const record::Outcome outcome =
      reader.read(selection, [&](const record::Channel& channel, const record::Message& message) {
        gatherer.take(channel.topic, message.data);
        return true;
      });
  const bool found = gatherer.finish();
  for (const std::string& problem : outcome.problems)
    std::fprintf(stderr, "fathom: %s: %s\n", file.c_str(), problem.c_str());
  if (gatherer.foreign() > 0) {
    std::fprintf(stderr, "fathom: %s: %llu samples are none of their topics' types\n", file.c_str(),
                 static_cast<unsigned long long>(gatherer.foreign()));
  }
  if (!found) {
    throw Failure(ExitCode::bad_input, file + ": no samples and no navigation states" +
                                           (vehicle.empty() ? "" : " of vehicle " + vehicle) +
                                           ", expected topics fathom/v1/imu, fathom/v1/nav_state or others");
  }
  return out;
}

void write_recorded(const std::string& folder, const Recorded& recorded) {
  dataset::write(folder, recorded.data, {recorded.epoch_ns, false});
  const std::filesystem::path path(folder);
  if (!recorded.states.empty()) {
    dataset::NavCsv states(path / "nav.csv", recorded.epoch_ns);
    for (const NavState& state : recorded.states) states.add(state);
    states.close();
  }
  const nlohmann::json about{{"utc_of_start", to_iso8601(recorded.epoch_ns, 9)}};
  write_text((path / "import.json").string(), about.dump(2) + "\n");
}

}  // namespace fathom::cli
