#include "health/writers/intruder_watch.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr std::size_t kNamed = 3;  // services in one sentence

}  // namespace

void IntruderWatch::add(const ServiceStatus& status, const Instant& now) {
  const Name& service = status.header.sensor;
  const auto known = started_ns_.find(service);
  if (known == started_ns_.end() && started_ns_.size() >= kMaxServices) return;
  if (known == started_ns_.end() || known->second != status.started_ns) {
    // It counts from its start: what it has counted already was not told before.
    started_ns_[service] = status.started_ns;
    strangers_.counted[service] = 0;
    permissions_.counted[service] = 0;
    malformed_.counted[service] = 0;
    states_.counted[service] = 0;
  }
  follow(strangers_, service, status.counter("bus_stranger_refused"), now);
  follow(permissions_, service, status.counter("bus_permission_refused"), now);
  follow(malformed_, service, status.counter("bus_malformed_datagram"), now);
  follow(states_, service, status.counter("state_refused"), now);
}

void IntruderWatch::follow(Refusals& refusals, const Name& service, std::uint64_t value, const Instant& now) {
  if (value > refusals.counted[service]) {
    if (recent(refusals, now).empty()) refusals.since_ns = now.monotonic_ns;
    refusals.rose_ns[service] = now.monotonic_ns;
  }
  refusals.counted[service] = value;
}

std::string IntruderWatch::recent(const Refusals& refusals, const Instant& now) {
  std::string text;
  std::size_t count = 0;
  for (const auto& [service, rose_ns] : refusals.rose_ns) {
    if (to_seconds(now.monotonic_ns - rose_ns) >= kWindowS) continue;
    if (++count <= kNamed) text += (text.empty() ? "" : ", ") + service.str();
  }
  if (count > kNamed) text += " and " + std::to_string(count - kNamed) + " more";
  return text;
}

void IntruderWatch::strangers(std::vector<std::string> present, const Instant& now) {
  if (present_.empty() && !present.empty()) present_since_ns_ = now.monotonic_ns;
  present_ = std::move(present);
}

void IntruderWatch::report(AlarmBook& book, const Instant& now) const {
  const std::string counted = recent(strangers_, now);
  std::string who = "somebody who proved no identity";
  if (!present_.empty()) {
    who = present_.front();
    if (present_.size() > 1) who += ", and " + std::to_string(present_.size() - 1) + " more";
  }
  const TimeNs since_ns = counted.empty() ? present_since_ns_ : strangers_.since_ns;
  book.set(!counted.empty() || !present_.empty(),
           {.key = "stranger_refused",
            .severity = Severity::warning,
            .text = sentence("The network refuses %.150s%s%.60s.", who.c_str(),
                             counted.empty() ? "" : "; counted by ", counted.c_str()),
            .value = static_cast<double>(present_.size()),
            .limit = 0.0,
            .began_ago_s = to_seconds(now.monotonic_ns - since_ns)},
           now);
  warn(book, permissions_, "permission_refused", "A known identity tried to read or write what it may not",
       now);
  warn(book, malformed_, "malformed_datagram",
       "Somebody sends datagrams that would end a service, and are left out", now);
  warn(book, states_, "state_refused", "Fusion was sent a state that is broken or not the leader's", now);
}

void IntruderWatch::warn(AlarmBook& book, const Refusals& refusals, const char* key, const char* what,
                         const Instant& now) {
  const std::string services = recent(refusals, now);
  book.set(!services.empty(),
           {.key = key,
            .severity = Severity::warning,
            .text = sentence("%.80s; counted by %.100s, see the log there.", what, services.c_str()),
            .began_ago_s = to_seconds(now.monotonic_ns - refusals.since_ns)},
           now);
}

}  // namespace fathom::health
