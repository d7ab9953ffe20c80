#include "health/gps/gps_outage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "health/gps/receivers.hpp"
#include "health/text.hpp"
#include "samples/gps_quality.hpp"

namespace fathom::health {
namespace {

constexpr std::size_t kMostUnjudged = 64;

bool is_refusal(VerdictKind kind) {
  return kind == VerdictKind::rejected || kind == VerdictKind::disputed || kind == VerdictKind::frozen ||
         kind == VerdictKind::out_of_range || kind == VerdictKind::unknown_frame ||
         kind == VerdictKind::from_the_future || kind == VerdictKind::late ||
         kind == VerdictKind::source_disabled;
}

}  // namespace

bool is_usable(const GpsSample& sample) {
  return sample.fix >= GpsFix::fix_3d && is_accurate(sample) && std::isfinite(sample.latitude_rad) &&
         std::isfinite(sample.longitude_rad) && std::abs(sample.latitude_rad) <= std::numbers::pi / 2;
}

void GpsOutage::add(const GpsSample& sample, const Instant& now, bool believed) {
  const Name& name = sample.header.sensor;
  auto found = receivers_.find(name);
  if (found == receivers_.end()) {
    if (receivers_.size() >= kMaxReceivers) return;
    found = receivers_.emplace(name, Receiver{OutageClock(config_.outage)}).first;
  }
  Receiver& receiver = found->second;
  const bool repeated = receiver.heard && sample.header.stamp_ns == receiver.last_stamp_ns;
  receiver.heard = true;
  receiver.last_stamp_ns = sample.header.stamp_ns;
  if (repeated) return;
  if (!believed || !is_usable(sample)) {
    unusable(name, receiver);
    return;
  }
  if (receiver.unjudged.size() == kMostUnjudged) receiver.unjudged.pop_front();
  receiver.unjudged.push_back({sample.header.stamp_ns, now.monotonic_ns});
  receiver.clock.usable(now.monotonic_ns);
  if (!counts(name)) return;
  overall_.usable(now.monotonic_ns);
  overall_source_ = name;
}

void GpsOutage::add(const Verdict& verdict) {
  if (verdict.source != SourceKind::gps) return;
  const bool refused = is_refusal(verdict.kind);
  if (!refused && verdict.kind != VerdictKind::used) return;
  const auto found = receivers_.find(verdict.header.sensor);
  if (found == receivers_.end()) return;
  Receiver& receiver = found->second;
  auto& unjudged = receiver.unjudged;
  const auto fix = std::find_if(unjudged.begin(), unjudged.end(),
                                [&](const Unjudged& one) { return one.stamp_ns == verdict.header.stamp_ns; });
  if (fix == unjudged.end()) {
    if (refused) unusable(found->first, receiver);
    return;
  }
  if (!refused) {
    receiver.refusing = false;
    receiver.taken_ns = fix->monotonic_ns;
  } else {
    if (!receiver.refusing) {
      // What came before the first refusal stands; where nothing did, this fix is where it began.
      receiver.refusing = true;
      if (fix != unjudged.begin()) receiver.taken_ns = std::prev(fix)->monotonic_ns;
      if (receiver.taken_ns == 0) receiver.taken_ns = fix->monotonic_ns;
    }
    doubt(found->first, receiver.taken_ns);
    unusable(found->first, receiver);
  }
  unjudged.erase(unjudged.begin(), std::next(fix));
}

void GpsOutage::add(const NavState& state, const Instant& now) {
  fusion_heard_ = fusion_heard_ || state.mode != NavMode::none;
  if (std::isfinite(state.gps_outage_s) && state.gps_outage_s >= 0.0 && state.gps_outage_s < 1e9)
    overall_.told(now.monotonic_ns - from_seconds(state.gps_outage_s));
}

std::vector<GpsOutageBook> GpsOutage::books(const Instant& now) const {
  std::vector<GpsOutageBook> out;
  const auto put = [&](const Name& name, const OutageClock& clock) {
    if (!clock.ever_usable()) return;
    GpsOutageBook book{name, clock.record()};
    book.record.last_usable_ns += now.utc_ns - now.monotonic_ns;
    out.push_back(book);
  };
  put({}, overall_);
  for (const auto& [name, receiver] : receivers_) put(name, receiver.clock);
  return out;
}

void GpsOutage::resume(const std::vector<GpsOutageBook>& books, const Instant& now) {
  for (const GpsOutageBook& book : books) {
    OutageRecord record = book.record;
    record.last_usable_ns -= now.utc_ns - now.monotonic_ns;
    if (book.receiver.empty()) {
      if (!overall_.ever_usable()) overall_.resume(record, now.monotonic_ns);
      continue;
    }
    if (receivers_.contains(book.receiver) || receivers_.size() >= kMaxReceivers) continue;
    receivers_.emplace(book.receiver, Receiver{OutageClock(config_.outage)})
        .first->second.clock.resume(record, now.monotonic_ns);
  }
}

bool GpsOutage::known(const Instant& now) const {
  if (!config_.expected || overall_.known() || overall_.active()) return true;
  if (!overall_.ever_usable() && fusion_heard_) return true;
  return now.monotonic_ns - start_.monotonic_ns >= from_seconds(config_.outage.limit_s);
}

bool GpsOutage::counts(const Name& receiver) const {
  return config_.receivers.empty() ||
         std::find(config_.receivers.begin(), config_.receivers.end(), receiver) != config_.receivers.end();
}

void GpsOutage::unusable(const Name& name, Receiver& receiver) {
  receiver.clock.unusable();
  // One receiver without a fix says nothing while another one has it.
  if (name == overall_source_) overall_.unusable();
}

void GpsOutage::evaluate(const Instant& now) {
  overall_.evaluate(now.monotonic_ns);
  grade(overall_, overall_severity_, now);
  for (auto& [name, receiver] : receivers_) {
    receiver.clock.evaluate(now.monotonic_ns);
    grade(receiver.clock, receiver.severity, now);
  }
}

void GpsOutage::doubt(const Name& name, TimeNs since_monotonic_ns) {
  const auto found = receivers_.find(name);
  if (found == receivers_.end()) return;
  found->second.clock.doubt(since_monotonic_ns);
  if (name != overall_source_) return;
  // What the other receivers gave in the meantime remains.
  TimeNs believed_ns = since_monotonic_ns;
  for (const auto& [other, receiver] : receivers_) {
    if (other != name && counts(other) && receiver.clock.ever_usable() && !receiver.clock.active()) {
      believed_ns = std::max(believed_ns, receiver.clock.last_usable_ns());
    }
  }
  overall_.doubt(believed_ns);
}

void GpsOutage::grade(const OutageClock& clock, Severity& severity, const Instant& now) const {
  if (!clock.active()) {
    severity = Severity::notice;
    return;
  }
  const double outage_s = clock.now_s();
  const Severity by_length = outage_s >= config_.critical_s  ? Severity::critical
                             : outage_s >= config_.warning_s ? Severity::warning
                                                             : Severity::notice;
  severity = std::max({severity, by_length, forecast_.severity(now)});
}

ReceiverOutage GpsOutage::describe(const Name& name, const OutageClock& clock, Severity severity,
                                   const Instant& now) {
  ReceiverOutage out;
  out.name = name;
  out.active = clock.active();
  out.severity = severity;
  if (out.active) out.since_ns = now.utc_ns - (now.monotonic_ns - clock.last_usable_ns());
  out.outage_s = clock.now_s();
  out.longest_s = clock.longest_s();
  out.total_s = clock.total_s();
  out.count = clock.count();
  return out;
}

std::vector<ReceiverOutage> GpsOutage::receivers(const Instant& now) const {
  std::vector<ReceiverOutage> out;
  out.reserve(receivers_.size());
  for (const auto& [name, receiver] : receivers_) {
    out.push_back(describe(name, receiver.clock, receiver.severity, now));
  }
  return out;
}

const OutageClock* GpsOutage::receiver(const Name& name) const {
  const auto found = receivers_.find(name);
  return found == receivers_.end() ? nullptr : &found->second.clock;
}

void GpsOutage::report(AlarmBook& book, const Instant& now) const {
  report_outage(book, now, "gps_outage", overall_, overall_severity_, "from any receiver");
  if (config_.per_receiver_alarms && receivers_.size() > 1) {
    for (const auto& [name, receiver] : receivers_) {
      report_outage(book, now, alarm_key("gps_outage", name.view()), receiver.clock, receiver.severity,
                    "from " + name.str());
    }
  }
  const Name no_fix = "gps_no_fix";
  const double waited_s = to_seconds(now.monotonic_ns - start_.monotonic_ns);
  if (config_.expected && !overall_.ever_usable() && waited_s >= config_.first_fix_limit_s) {
    book.hold(
        {.key = no_fix,
         .severity = Severity::warning,
         .text = sentence("There has been no usable GPS fix since the start %s ago (limit %s).",
                          duration_text(waited_s).c_str(), duration_text(config_.first_fix_limit_s).c_str()),
         .value = waited_s,
         .limit = config_.first_fix_limit_s,
         .began_ago_s = waited_s},
        now);
  } else {
    book.release(no_fix, now);
  }
}

void GpsOutage::report_outage(AlarmBook& book, const Instant& now, const Name& key, const OutageClock& clock,
                              Severity severity, const std::string& who) const {
  if (!clock.active()) {
    book.release(key, now, clock.known());
    return;
  }
  const double outage_s = clock.now_s();
  const double to_limit_s = forecast_.time_to_limit_s(now);
  const std::string forecast =
      std::isfinite(to_limit_s)
          ? sentence("; %s is forecast in %s", forecast_.limit().c_str(), duration_text(to_limit_s).c_str())
          : std::string();
  book.hold({.key = key,
             .severity = severity,
             .text = sentence("No usable GPS fix %s for %s (limit %s)%s.", who.c_str(),
                              duration_text(outage_s).c_str(), duration_text(config_.outage.limit_s).c_str(),
                              forecast.c_str()),
             .value = outage_s,
             .limit = config_.outage.limit_s,
             .began_ago_s = outage_s,
             .clear_hold_s = 0.0},  // the clock has its own hysteresis
            now);
}

}  // namespace fathom::health
