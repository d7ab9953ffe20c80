#include "cli/solve/compare/verdict_changes.hpp"

#include <algorithm>
#include <utility>

namespace fathom::cli {

void VerdictChanges::add(std::size_t run, const Verdict& verdict) {
  const Key key{verdict.header.stamp_ns, verdict.source, verdict.header.sensor.str(),
                verdict.header.sequence};
  Judged judged{verdict.kind, verdict.model.str(), verdict.test_ratio};
  auto& waiting = waiting_[key];
  auto& others = waiting[1 - run];
  if (others.empty()) {
    waiting[run].push_back(std::move(judged));
    return;
  }
  const Judged& other = others.front();
  if (run == 0) {
    close(key, &judged, &other);
  } else {
    close(key, &other, &judged);
  }
  others.pop_front();
  if (others.empty()) waiting_.erase(key);
}

void VerdictChanges::finish() {
  for (const auto& [key, waiting] : waiting_) {
    for (const Judged& one : waiting[0]) close(key, &one, nullptr);
    for (const Judged& one : waiting[1]) close(key, nullptr, &one);
  }
  waiting_.clear();
  std::stable_sort(changes_.begin(), changes_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.t_s, a.source, a.sensor, a.sequence) < std::tie(b.t_s, b.source, b.sensor, b.sequence);
  });
  for (auto& [sensor, instants] : unchanged_) std::sort(instants.begin(), instants.end());
}

void VerdictChanges::close(const Key& key, const Judged* first, const Judged* second) {
  ++measurements_;
  const auto& [stamp_ns, source, sensor, sequence] = key;
  const double t_s = to_seconds(stamp_ns - epoch_ns_);
  if (first != nullptr && second != nullptr && first->kind == second->kind) {
    unchanged_[sensor].push_back(t_s);
    return;
  }
  report::VerdictChange& change = changes_.emplace_back();
  change.t_s = t_s;
  change.source = source;
  change.sensor = sensor;
  change.sequence = sequence;
  for (const Judged* one : {second, first})
    if (one != nullptr && !one->model.empty()) change.model = one->model;
  if (first != nullptr) {
    change.first = first->kind;
    change.test_ratio[0] = first->test_ratio;
  }
  if (second != nullptr) {
    change.second = second->kind;
    change.test_ratio[1] = second->test_ratio;
  }
}

std::vector<report::ChangedRun> VerdictChanges::runs() const {
  std::vector<report::ChangedRun> out;
  std::map<std::string, std::size_t> latest;  // of each sensor, its place in `out`
  const auto continues = [this](const report::ChangedRun& run, const report::VerdictChange& change) {
    if (run.model != change.model || run.first != change.first || run.second != change.second) return false;
    const auto unchanged = unchanged_.find(change.sensor);
    if (unchanged == unchanged_.end()) return true;
    const auto next = std::upper_bound(unchanged->second.begin(), unchanged->second.end(), run.end_s);
    return next == unchanged->second.end() || *next >= change.t_s;
  };
  for (const report::VerdictChange& change : changes_) {
    const auto found = latest.find(change.sensor);
    if (found != latest.end() && continues(out[found->second], change)) {
      out[found->second].end_s = change.t_s;
      ++out[found->second].count;
      continue;
    }
    latest[change.sensor] = out.size();
    out.push_back({change.t_s, change.t_s, 1, change.sensor, change.model, change.first, change.second});
  }
  return out;
}

}  // namespace fathom::cli
