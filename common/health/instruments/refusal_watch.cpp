#include "health/instruments/refusal_watch.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "base/median.hpp"
#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr std::size_t kMaxSources = 64;  // names come from the network: bounded
constexpr double kMissed = 2.0;          // periods; then one measurement did not come

bool is_disagreement(VerdictKind kind) {
  // A disputed receiver has an alarm of its own, DisputeWatch's; it is refused all the same.
  return kind == VerdictKind::rejected || kind == VerdictKind::disputed || kind == VerdictKind::frozen ||
         kind == VerdictKind::unknown_frame || kind == VerdictKind::from_the_future ||
         kind == VerdictKind::late;
}

}  // namespace

void RefusalWatch::add(const Verdict& verdict, const Instant& now) {
  auto found = sources_.find({verdict.source, verdict.header.sensor});
  if (found == sources_.end()) {
    if (sources_.size() >= kMaxSources) return;
    found = sources_.emplace(std::pair(verdict.source, verdict.header.sensor), Source{}).first;
  }
  Source& source = found->second;
  if (verdict.kind == VerdictKind::used) {
    source.refused = 0;
  } else if (verdict.source == SourceKind::gps && verdict.kind == VerdictKind::frozen) {
    source.refused = 0;  // FixWatch raises the alarm of a frozen fix
  } else if (is_disagreement(verdict.kind)) {
    refuse(source, verdict, now);
  }
}

void RefusalWatch::add(const NavState& state) {
  if (state.header.stamp_ns == nav_stamp_ns_) return;
  nav_stamp_ns_ = state.header.stamp_ns;
  for (auto& [id, source] : sources_)
    if (id.first == SourceKind::imu) source.refused = 0;
}

void RefusalWatch::refuse(Source& source, const Verdict& verdict, const Instant& now) {
  if (source.refused == 0) {
    source.since_ns = now.monotonic_ns;
    source.pauses = 0;
  } else if (verdict.header.stamp_ns != source.stamp_ns) {  // models may judge parts of one measurement
    source.pauses_s[source.pauses++ % source.pauses_s.size()] = to_seconds(now.monotonic_ns - source.last_ns);
  }
  if (source.refused < std::numeric_limits<int>::max()) ++source.refused;
  source.last_ns = now.monotonic_ns;
  source.stamp_ns = verdict.header.stamp_ns;
  source.kind = verdict.kind;
  source.model = verdict.model;
}

double RefusalWatch::period_s(const Source& source) {
  const std::size_t known = std::min(source.pauses, source.pauses_s.size());
  const auto begin = source.pauses_s.begin();
  return known == 0 ? 0.0 : median({begin, begin + static_cast<std::ptrdiff_t>(known)});
}

void RefusalWatch::report(AlarmBook& book, const Instant& now) const {
  // One controller may tell several kinds under one name, and that name one alarm.
  std::set<Name> held;
  for (const auto& [id, source] : sources_) {
    const Name key = alarm_key("refused", id.second.view());
    const double for_s = to_seconds(now.monotonic_ns - source.since_ns);
    // A sensor that fell silent is no longer refused: it is missing, which is another alarm.
    const bool current = fresh_.of_sensor(id.first, id.second, source.last_ns, now,
                                          std::max(config_.limit_s, kMissed * period_s(source)));
    if (source.refused < config_.minimum || for_s < config_.limit_s || !current) continue;
    held.insert(key);
    const std::string model = source.model.empty() ? "" : " (" + source.model.str() + ")";
    book.hold({.key = key,
               .severity = Severity::warning,
               .text = sentence("Fusion has refused all %d measurements of %s%s for %s, the last as %s.",
                                source.refused, id.second.c_str(), model.c_str(),
                                duration_text(for_s).c_str(), std::string(to_string(source.kind)).c_str()),
               .value = for_s,
               .limit = config_.limit_s,
               .began_ago_s = for_s},
              now);
  }
  for (const auto& [id, source] : sources_) {
    const Name key = alarm_key("refused", id.second.view());
    if (!held.contains(key)) book.release(key, now);
  }
}

}  // namespace fathom::health
