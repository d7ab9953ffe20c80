#include "bus/detail/event_book.hpp"

#include <algorithm>
#include <utility>

#include "base/clock.hpp"

namespace fathom::bus {

std::string_view to_string(BusEventKind kind) {
  switch (kind) {
    case BusEventKind::incompatible_qos:
      return "incompatible QoS";
    case BusEventKind::deadline_missed:
      return "deadline missed";
    case BusEventKind::writer_lost:
      return "writer lost";
    case BusEventKind::sample_lost:
      return "sample lost";
    case BusEventKind::write_failed:
      return "write failed";
    case BusEventKind::resource_limit:
      return "resource limit";
    case BusEventKind::invalid_sample:
      return "invalid sample";
    case BusEventKind::stranger_refused:
      return "stranger refused";
    case BusEventKind::permission_refused:
      return "permission refused";
    case BusEventKind::malformed_datagram:
      return "malformed datagram";
  }
  return "unknown";
}

namespace detail {
namespace {

std::uint64_t& counter(BusCounters& counters, BusEventKind kind) {
  switch (kind) {
    case BusEventKind::incompatible_qos:
      return counters.incompatible_qos;
    case BusEventKind::deadline_missed:
      return counters.deadline_missed;
    case BusEventKind::writer_lost:
      return counters.writer_lost;
    case BusEventKind::sample_lost:
      return counters.sample_lost;
    case BusEventKind::write_failed:
      return counters.write_failed;
    case BusEventKind::resource_limit:
      return counters.resource_limit;
    case BusEventKind::invalid_sample:
      return counters.invalid_sample;
    case BusEventKind::stranger_refused:
      return counters.stranger_refused;
    case BusEventKind::permission_refused:
      return counters.permission_refused;
    case BusEventKind::malformed_datagram:
      break;
  }
  return counters.malformed_datagram;
}

}  // namespace

EventBook::EventBook(DurationNs quiet_ns, std::function<TimeNs()> now_ns)
    : quiet_ns_(quiet_ns), now_ns_(std::move(now_ns)) {
  if (!now_ns_) now_ns_ = [] { return SystemClock().monotonic_ns(); };
}

bool EventBook::is_past(BusEventKind kind, const std::optional<TimeNs>& over_ns) const {
  const bool flickers = kind == BusEventKind::deadline_missed;
  return over_ns && (!flickers || now_ns_() - *over_ns >= quiet_ns_);
}

bool EventBook::forget_one(BusEventKind kind, Faults& faults) const {
  const auto past = std::find_if(faults.begin(), faults.end(),
                                 [&](const auto& fault) { return is_past(kind, fault.second); });
  if (past == faults.end()) return false;
  faults.erase(past);
  return true;
}

void EventBook::report(BusEventKind kind, const std::string& topic, const std::string& subject,
                       const std::string& detail, std::uint64_t occurrences) {
  BusEvent event{kind, topic, detail};
  {
    const std::lock_guard lock(mutex_);
    counter(counters_, kind) += occurrences;
    Faults& faults = reported_[kind];
    const auto known = faults.find({topic, subject});
    if (known != faults.end()) {
      const bool again = is_past(kind, known->second);
      known->second.reset();
      if (!again) return;
    } else if (faults.size() < kMostOfAKind || forget_one(kind, faults)) {
      faults[{topic, subject}];
    } else {
      if (!overfull_.insert(kind).second) return;
      event = {kind, "",
               "there are more than " + std::to_string(kMostOfAKind) +
                   " of them: further ones are counted and not told"};
    }
  }
  const std::lock_guard lock(handler_mutex_);
  if (handler_) {
    handler_(event);
  } else if (backlog_.size() < kBacklog) {
    backlog_.push_back(std::move(event));
  }
}

void EventBook::recovered(BusEventKind kind, const std::string& topic, const std::string& subject) {
  const std::lock_guard lock(mutex_);
  Faults& faults = reported_[kind];
  const auto at = faults.find({topic, subject});
  if (at != faults.end() && !at->second) at->second = now_ns_();
}

BusCounters EventBook::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

void EventBook::set_handler(std::function<void(const BusEvent&)> handler) {
  const std::lock_guard lock(handler_mutex_);
  handler_ = std::move(handler);
  if (!handler_) return;
  for (const BusEvent& event : std::exchange(backlog_, {})) handler_(event);
}

}  // namespace detail
}  // namespace fathom::bus
