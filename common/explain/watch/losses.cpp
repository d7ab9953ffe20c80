#include <algorithm>
#include <array>
#include <vector>

#include "base/median.hpp"
#include "explain/watch/silence.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// A source is missed when it gave nothing for ten of its usual steps, and for five seconds: shorter losses
// are what filters are made for.
constexpr double kSteps = 10.0;
constexpr double kLeastLoss_s = 5.0;
constexpr std::size_t kEnough = 5;  // used ones, before a usual step means anything
constexpr double kWet_m = 0.5;      // an antenna is under water

/// A stretch in which nothing of a source was used.
struct Unused {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
};

/// What is left of a stretch without the times in which the instrument itself was silent.
std::vector<Unused> without(const Unused& whole, const std::vector<Silence>& silences) {
  std::vector<Unused> out;
  TimeNs from_ns = whole.from_ns;
  for (const Silence& one : silences) {
    if (one.end_ns <= from_ns || one.begin_ns >= whole.to_ns) continue;
    if (one.begin_ns > from_ns) out.push_back({from_ns, one.begin_ns});
    from_ns = one.end_ns;
  }
  if (from_ns < whole.to_ns) out.push_back({from_ns, whole.to_ns});
  return out;
}

std::uint64_t within(const Judged& rows, const Unused& one) {
  return static_cast<std::uint64_t>(std::count_if(rows.begin(), rows.end(), [&](const VerdictRow* row) {
    return row->stamp_ns > one.from_ns && row->stamp_ns < one.to_ns;
  }));
}

/// Whether fusion judged other sources meanwhile: it was there.
bool judging(const History& history, std::size_t stream, const Unused& one) {
  std::size_t count = 0;
  for (const VerdictRow& row : history.verdicts())
    count += row.stream != stream && row.stamp_ns > one.from_ns && row.stamp_ns < one.to_ns ? 1U : 0U;
  return count >= kEnough;
}

/// Looks through one source.
class Losses {
 public:
  Losses(const History& history, const Track& track, std::size_t number, Findings& out)
      : history_(history),
        track_(track),
        number_(number),
        stream_(history.streams()[number]),
        rows_(judged(history, number)),
        out_(out) {}

  void all() {
    std::vector<TimeNs> used;
    for (const VerdictRow* row : rows_)
      if (row->kind == VerdictKind::used) used.push_back(row->stamp_ns);
    if (used.size() < kEnough) return;
    std::vector<double> steps;
    for (std::size_t k = 1; k < used.size(); ++k) steps.push_back(to_seconds(used[k] - used[k - 1]));
    const DurationNs bound_ns = from_seconds(std::max(kLeastLoss_s, kSteps * median(steps)));
    const std::vector<Silence> silent = silences(history_, stream_, bound_ns);
    for (const Silence& one : silent)
      if (one.end_ns > used.front()) silence(one);
    // Up to the end of the recording, too, as far as states and their verdicts go.
    if (!track_.rows().empty()) used.push_back(track_.rows().back()->at_ns);
    for (std::size_t k = 1; k < used.size(); ++k) {
      if (used[k] - used[k - 1] < bound_ns) continue;
      for (const Unused& one : without({used[k - 1], used[k]}, silent))
        if (one.to_ns - one.from_ns >= bound_ns) unused(one, k + 1 == used.size() && one.to_ns == used[k]);
    }
  }

 private:
  void silence(const Silence& one) {
    Finding found = begun({one.begin_ns, one.end_ns}, one.to_end);
    found.word = "silent";
    found.said = bridge_said(history_, found.subject, one.begin_ns, one.end_ns);
    found.evidence = {{"fathom/v1/" + std::string(to_string(stream_.kind)), 0, "no samples in this time"}};
    // A slow instrument gives less than one in a second.
    const std::uint64_t count = within(rows_, {one.begin_ns, one.end_ns});
    if (static_cast<double>(count) > to_seconds(one.length_ns()))
      found.figures.push_back({"afterwards", static_cast<double>(count)});
    say(std::move(found));
  }

  void unused(const Unused& one, bool to_end) {
    Finding found = begun(one, to_end);
    std::array<std::uint64_t, kVerdictKinds> counts{};
    for (const VerdictRow* row : rows_)
      if (row->stamp_ns > one.from_ns && row->stamp_ns < one.to_ns)
        ++counts[static_cast<std::size_t>(row->kind)];
    const auto most = std::max_element(counts.begin(), counts.end());
    if (*most == 0) {
      // Where fusion was gone nothing is known against the instrument.
      if (!judging(history_, number_, one)) return;
      found.word = "not_judged";
    } else {
      found.word = to_string(static_cast<VerdictKind>(std::distance(counts.begin(), most)));
      found.figures.push_back({"count", static_cast<double>(*most)});
    }
    found.evidence.push_back({"fathom/v1/verdict", *most, found.word});
    say(std::move(found));
  }

  [[nodiscard]] Finding begun(const Unused& one, bool to_end) const {
    Finding found{
        .kind = Kind::lost, .subject = stream_.sensor.str(), .begin_ns = one.from_ns, .end_ns = one.to_ns};
    found.figures = {{"for_s", to_seconds(one.to_ns - one.from_ns)},
                     {"to_end", to_end ? 1.0 : 0.0},
                     {"kind", static_cast<double>(stream_.kind)}};
    return found;
  }

  void say(Finding found) {
    const StateRow* before = track_.at(found.begin_ns);
    const StateRow* after = track_.at(found.end_ns - 1);
    if (before != nullptr && after != nullptr) {
      found.figures.push_back({"sigma_before_m", before->sigma_m});
      found.figures.push_back({"sigma_after_m", after->sigma_m});
    }
    const StateRow* middle = track_.at(found.begin_ns + (found.end_ns - found.begin_ns) / 2);
    if (stream_.kind == SourceKind::gps && middle != nullptr && middle->depth_m > kWet_m) {
      found.figures.push_back({"depth_m", middle->depth_m});
      found.weight = Weight::note;
    }
    out_.push_back(std::move(found));
  }

  const History& history_;
  const Track& track_;
  std::size_t number_;
  const Stream& stream_;
  Judged rows_;
  Findings& out_;
};

}  // namespace

void watch_losses(const History& history, const Track& track, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i)
    if (history.streams()[i].kind != SourceKind::imu) Losses(history, track, i, out).all();
}

}  // namespace fathom::explain
