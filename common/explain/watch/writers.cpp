#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// Seconds in which two processes both give samples. The last samples of one that ends and the first of its
// successor share at most one or two.
constexpr std::size_t kTogether = 3;
// A life sign comes once a second; a process whose last one came this long before is another story.
constexpr DurationNs kTakesOver_ns = 10 * kNsPerSecond;

void second_writers(const History& history, const Stream& stream, Findings& out) {
  std::map<std::uint32_t, std::uint64_t> samples;  // by writer, in shared seconds
  std::vector<TimeNs> shared;
  std::map<std::uint32_t, TimeNs> since;
  // Whoever tells a position by hand is a process of its own each time, and gone.
  std::map<std::uint32_t, std::size_t> seconds_of;
  for (const Second& one : stream.seconds) ++seconds_of[one.writer];
  const Second* before = nullptr;
  for (const Second& one : stream.seconds) {
    if (seconds_of[one.writer] < kTogether) continue;
    since.try_emplace(one.writer, one.at_ns);
    const Second* last = std::exchange(before, &one);
    if (last == nullptr || last->at_ns != one.at_ns) continue;
    if (shared.empty() || shared.back() != one.at_ns) {
      shared.push_back(one.at_ns);
      samples[last->writer] += last->count;
    }
    samples[one.writer] += one.count;
  }
  if (shared.size() < kTogether) return;
  std::vector<std::uint32_t> writers;
  for (const auto& [writer, count] : samples) writers.push_back(writer);
  std::stable_sort(writers.begin(), writers.end(), [&](auto a, auto b) { return since[a] < since[b]; });
  std::string who;
  for (std::size_t i = 0; i < writers.size(); ++i)
    who += (i == 0 ? "" : i + 1 == writers.size() ? " and " : ", ") + history.writer(writers[i]);
  std::uint64_t second = 0;
  for (std::size_t i = 1; i < writers.size(); ++i) second += samples[writers[i]];
  out.push_back({.kind = Kind::second_writer,
                 .weight = Weight::bad,
                 .subject = stream.sensor.str(),
                 .begin_ns = shared.front(),
                 .end_ns = shared.back() + kNsPerSecond,
                 .word = who,
                 .figures = {{"writers", static_cast<double>(writers.size())},
                             {"seconds", static_cast<double>(shared.size())},
                             {"samples", static_cast<double>(second)}},
                 .evidence = {{"fathom/v1/" + std::string(to_string(stream.kind)), second,
                               "samples of the second writer"}}});
}

/// How long the navigation state was silent around an instant.
double silence_s(const History& history, TimeNs near_ns) {
  DurationNs longest = 0;
  const StateRow* last = nullptr;
  for (const StateRow& row : history.states()) {
    if (last != nullptr && row.log_ns > near_ns - kTakesOver_ns && last->log_ns < near_ns + kTakesOver_ns)
      longest = std::max(longest, row.log_ns - last->log_ns);
    last = &row;
  }
  return to_seconds(longest);
}

void takeovers(const History& history, Findings& out) {
  const StateRow* last = nullptr;
  for (const StateRow& row : history.states()) {
    const StateRow* before = std::exchange(last, &row);
    if (before == nullptr || before->instance == row.instance) continue;
    out.push_back({.kind = Kind::takeover,
                   .subject = history.name(row.instance),
                   .begin_ns = before->log_ns,
                   .end_ns = row.log_ns,
                   .word = history.name(before->instance),
                   .figures = {{"silence_s", to_seconds(row.log_ns - before->log_ns)}},
                   .evidence = {{"fathom/v1/nav_state", 1, "header.sensor and writer changed"}}});
  }
}

/// Those that gave a navigation state.
std::set<std::string> fusions_of(const History& history) {
  std::set<std::string> out;
  for (const StateRow& row : history.states()) out.insert(history.name(row.instance));
  return out;
}

void restarts(const History& history, Findings& out) {
  std::map<std::uint32_t, const LifeSign*> last;
  const std::set<std::string> fusions = fusions_of(history);
  for (const LifeSign& sign : history.life_signs()) {
    const LifeSign* before = std::exchange(last[sign.service], &sign);
    if (before == nullptr || (before->started_ns == sign.started_ns && before->pid == sign.pid)) continue;
    const std::string& service = history.name(sign.service);
    const bool fusion = fusions.contains(service);
    const TimeNs begin_ns = sign.before_ns > 0 ? sign.before_ns : sign.log_ns;
    Finding found{
        .kind = Kind::restart,
        .weight = fusion ? Weight::bad : Weight::caution,
        .subject = service,
        .begin_ns = begin_ns,
        .end_ns = sign.log_ns,
        .figures = {{"silence_s", to_seconds(sign.log_ns - begin_ns)}, {"fusion", fusion ? 1.0 : 0.0}},
        .evidence = {{"fathom/v1/service_status", 1, "started_ns and pid changed"}}};
    if (fusion) {
      found.figures.push_back({"state_silence_s", silence_s(history, sign.log_ns)});
      for (const RunRow& run : history.runs()) {
        if (run.instance != sign.service && history.name(run.instance) != service) continue;
        if (run.log_ns < begin_ns) continue;
        found.word = run.resumed ? "resumed" : "anew";
        found.evidence.push_back({"fathom/v1/intake", 1, run.resumed ? "resumed" : "begun anew"});
        break;
      }
    }
    out.push_back(std::move(found));
  }
}

/// Processes that were silent and went on, or went silent for good without saying that they stop.
void stalls(const History& history, Findings& out) {
  const std::set<std::string> fusions = fusions_of(history);
  const auto say = [&](std::uint32_t service, TimeNs begin_ns, TimeNs end_ns, bool to_end) {
    const std::string& name = history.name(service);
    const bool fusion = fusions.contains(name);
    out.push_back({.kind = Kind::stalled,
                   .weight = fusion ? Weight::bad : Weight::caution,
                   .subject = name,
                   .begin_ns = begin_ns,
                   .end_ns = end_ns,
                   .figures = {{"silence_s", to_seconds(end_ns - begin_ns)},
                               {"to_end", to_end ? 1.0 : 0.0},
                               {"fusion", fusion ? 1.0 : 0.0}},
                   .evidence = {{"fathom/v1/service_status", 0, "no life signs in this time"}}});
  };
  std::map<std::uint32_t, const LifeSign*> last;
  for (const LifeSign& sign : history.life_signs()) {
    const LifeSign* before = std::exchange(last[sign.service], &sign);
    if (before == nullptr || before->started_ns != sign.started_ns || before->pid != sign.pid) continue;
    if (sign.before_ns > 0 && sign.log_ns - sign.before_ns > LifeSign::kSilence_ns)
      say(sign.service, sign.before_ns, sign.log_ns, false);
  }
  for (const auto& [service, last_ns] : history.last_life_ns()) {
    if (history.to_ns() - last_ns <= LifeSign::kSilence_ns || last_ns < history.from_ns()) continue;
    const auto sign = last.find(service);
    if (sign != last.end() && sign->second->state == ServiceState::stopping) continue;
    say(service, last_ns, history.to_ns(), true);
  }
}

}  // namespace

void watch_writers(const History& history, Findings& out) {
  for (const Stream& stream : history.streams()) second_writers(history, stream, out);
  takeovers(history, out);
  restarts(history, out);
  stalls(history, out);
}

}  // namespace fathom::explain
