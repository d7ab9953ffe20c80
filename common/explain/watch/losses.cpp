#include <algorithm>
#include <array>
#include <map>

#include "base/median.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// A source is missed when it gave nothing for ten of its usual steps, and for five seconds: shorter losses
// are what filters are made for.
constexpr double kSteps = 10.0;
constexpr double kLeastLoss_s = 5.0;
constexpr std::size_t kEnough = 5;  // used ones, before a usual step means anything
constexpr double kWet_m = 0.5;      // an antenna is under water

/// Whether nothing arrived in the most of a stretch: what of it came afterwards, all at once, was silent too.
bool silent(const Stream& stream, TimeNs from_ns, TimeNs to_ns) {
  DurationNs heard_ns = 0;
  TimeNs last_ns = 0;
  for (const Second& one : stream.seconds) {
    if (one.at_ns == last_ns || one.at_ns + kNsPerSecond <= from_ns || one.at_ns >= to_ns) continue;
    last_ns = one.at_ns;
    heard_ns += kNsPerSecond;
  }
  return 2 * heard_ns < to_ns - from_ns;
}

/// Why nothing of a stretch was used.
std::string reason_of(const Stream& stream, const Judged& rows, TimeNs from_ns, TimeNs to_ns,
                      Finding& found) {
  std::array<std::uint64_t, kVerdictKinds> counts{};
  for (const VerdictRow* row : rows)
    if (row->stamp_ns > from_ns && row->stamp_ns < to_ns) ++counts[static_cast<std::size_t>(row->kind)];
  const auto most = std::max_element(counts.begin(), counts.end());
  if (*most == 0) return "silent";
  // A slow instrument gives less than one in a second.
  if (!stream.seconds.empty() && *most > static_cast<std::uint64_t>(to_seconds(to_ns - from_ns)) &&
      silent(stream, from_ns, to_ns)) {
    found.figures.push_back({"afterwards", static_cast<double>(*most)});
    return "silent";
  }
  const auto kind = static_cast<VerdictKind>(std::distance(counts.begin(), most));
  found.figures.push_back({"count", static_cast<double>(*most)});
  found.evidence.push_back({"fathom/v1/verdict", *most, std::string(to_string(kind))});
  return std::string(to_string(kind));
}

}  // namespace

void watch_losses(const History& history, const Track& track, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i) {
    const Stream& stream = history.streams()[i];
    if (stream.kind == SourceKind::imu) continue;
    const Judged rows = judged(history, i);
    std::vector<TimeNs> used;
    for (const VerdictRow* row : rows)
      if (row->kind == VerdictKind::used) used.push_back(row->stamp_ns);
    if (used.size() < kEnough) continue;
    std::vector<double> steps;
    for (std::size_t k = 1; k < used.size(); ++k) steps.push_back(to_seconds(used[k] - used[k - 1]));
    const double bound_s = std::max(kLeastLoss_s, kSteps * median(steps));
    // Up to the end of the recording, too, as far as states and their verdicts go.
    if (!track.rows().empty()) used.push_back(track.rows().back()->at_ns);
    for (std::size_t k = 1; k < used.size(); ++k) {
      const double for_s = to_seconds(used[k] - used[k - 1]);
      if (for_s < bound_s) continue;
      Finding found{
          .kind = Kind::lost, .subject = stream.sensor.str(), .begin_ns = used[k - 1], .end_ns = used[k]};
      found.figures = {{"for_s", for_s}, {"to_end", k + 1 == used.size() ? 1.0 : 0.0}};
      found.word = reason_of(stream, rows, used[k - 1], used[k], found);
      if (found.word == "silent") {
        found.evidence.push_back(
            {"fathom/v1/" + std::string(to_string(stream.kind)), 0, "no samples in this time"});
      }
      found.figures.push_back({"kind", static_cast<double>(stream.kind)});
      const StateRow* before = track.at(used[k - 1]);
      const StateRow* after = track.at(used[k] - 1);
      if (before != nullptr && after != nullptr) {
        found.figures.push_back({"sigma_before_m", before->sigma_m});
        found.figures.push_back({"sigma_after_m", after->sigma_m});
      }
      const StateRow* middle = track.at(used[k - 1] + (used[k] - used[k - 1]) / 2);
      if (stream.kind == SourceKind::gps && middle != nullptr && middle->depth_m > kWet_m) {
        found.figures.push_back({"depth_m", middle->depth_m});
        found.weight = Weight::note;
      }
      out.push_back(std::move(found));
    }
  }
}

}  // namespace fathom::explain
