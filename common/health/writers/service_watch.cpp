#include "health/writers/service_watch.hpp"

#include <algorithm>
#include <utility>

#include "health/text.hpp"

namespace fathom::health {
namespace {

StreamLimits life_sign_limits(const ServiceWatchConfig& config) {
  // One life sign is enough to be back: it carries the state.
  return {kUnknown, std::min(2.0, config.missing_s), config.missing_s, 1};
}

std::string reason_of(const std::string& text) {
  if (text.empty()) return "without giving a reason";
  std::string reason = text.substr(0, 120);
  if (reason.back() == '.') reason.pop_back();
  return reason;
}

/// Whether two reasons differ in more than their numbers.
bool is_another(const std::string& one, const std::string& other) {
  const auto words = [](std::string text) {
    std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
    return text;
  };
  return words(one) != words(other);
}

}  // namespace

ServiceWatch::ServiceWatch(const std::vector<ExpectedService>& expected, const ServiceWatchConfig& config,
                           double startup_s, const Instant& start)
    : config_(config), startup_s_(startup_s) {
  for (const ExpectedService& service : expected) {
    if (services_.size() >= kMaxServices) break;
    index_.emplace(service.name, services_.size());
    services_.push_back({service, true, StreamWatch(life_sign_limits(config), start.monotonic_ns)});
  }
}

ServiceWatch::Service* ServiceWatch::find_or_make(const Name& name, const Instant& now) {
  if (const auto found = index_.find(name); found != index_.end()) return &services_[found->second];
  Service fresh{{name}, false, StreamWatch(life_sign_limits(config_), now.monotonic_ns)};
  if (services_.size() < kMaxServices) {
    index_.emplace(name, services_.size());
    return &services_.emplace_back(std::move(fresh));
  }
  const auto gone = std::find_if(services_.begin(), services_.end(), [](const Service& one) {
    return !one.expected && one.stream.presence() == Presence::missing;
  });
  if (gone == services_.end()) return nullptr;
  index_.erase(gone->what.name);
  index_.emplace(name, static_cast<std::size_t>(gone - services_.begin()));
  *gone = std::move(fresh);
  return &*gone;
}

void ServiceWatch::add(const ServiceStatus& status, const Instant& now) {
  Service* service = find_or_make(status.header.sensor, now);
  if (service == nullptr) {
    unwatched_ = status.header.sensor;
    unwatched_heard_ns_ = now.monotonic_ns;
    return;
  }
  if (service->voices.hear(status, now.monotonic_ns)) service->restarted = service->stream.ever_heard();
  service->stream.heard(now.monotonic_ns);
  service->state = status.state;
  service->text = status.text;
  const bool unwell = status.state == ServiceState::degraded;
  if (unwell && !service->unwell) service->unwell_since_ns = now.monotonic_ns;
  service->unwell = unwell;
}

void ServiceWatch::evaluate(const Instant& now) {
  for (Service& service : services_) service.stream.evaluate(now.monotonic_ns);
}

bool ServiceWatch::all_heard() const {
  return std::all_of(services_.begin(), services_.end(),
                     [](const Service& service) { return !service.expected || service.stream.ever_heard(); });
}

void ServiceWatch::report(AlarmBook& book, const Instant& now) {
  for (Service& service : services_) {
    report_unwell(service, book, now);
    report_twice(service, book, now);
    if (service.expected) {
      report_missing(service, book, now);
      if (service.restarted) {
        book.event({.key = alarm_key("service_restarted", service.what.name.view()),
                    .severity = Severity::notice,
                    .text = sentence("Service %s was restarted and is now process %u.",
                                     service.what.name.c_str(), service.voices.newest_pid())},
                   now);
      }
    }
    service.restarted = false;
  }
  report_unwatched(book, now);
}

void ServiceWatch::report_twice(Service& service, AlarmBook& book, const Instant& now) const {
  service.voices.forget(now.monotonic_ns, config_.missing_s);
  const bool twice = service.voices.several();
  Condition condition;
  condition.key = alarm_key("service_twice", service.what.name.view());
  condition.severity = service.what.severity;
  if (twice) {
    condition.text =
        service.voices.sentence_about(service.what.name.c_str()) + " End the one that does not belong.";
    condition.value = static_cast<double>(service.voices.count());
    condition.limit = 1.0;
  }
  book.set(twice, condition, now);
}

void ServiceWatch::report_unwatched(AlarmBook& book, const Instant& now) const {
  const bool holds =
      unwatched_heard_ns_ != 0 && to_seconds(now.monotonic_ns - unwatched_heard_ns_) <= config_.missing_s;
  book.set(holds,
           {.key = "services_unwatched",
            .severity = Severity::warning,
            .text = sentence("More than %zu services give life signs: what %s says of itself is not heard.",
                             kMaxServices, unwatched_.c_str()),
            .value = static_cast<double>(kMaxServices + 1),
            .limit = static_cast<double>(kMaxServices)},
           now);
}

void ServiceWatch::report_missing(const Service& service, AlarmBook& book, const Instant& now) const {
  const bool unseen = !service.stream.ever_heard();
  const double limit_s = unseen ? std::max(startup_s_, config_.missing_s) : config_.missing_s;
  const double silent_s = service.stream.silent_s(now.monotonic_ns);
  const char* how = unseen                                    ? ", never since the start"
                    : service.state == ServiceState::stopping ? " after it had announced its end"
                                                              : "";
  book.set(unseen ? silent_s > limit_s : service.stream.presence() == Presence::missing,
           {.key = alarm_key("service_missing", service.what.name.view()),
            .severity = service.what.severity,
            .text = sentence("There was no life sign of service %s for %s%s (limit %s).",
                             service.what.name.c_str(), duration_text(silent_s).c_str(), how,
                             duration_text(limit_s).c_str()),
            .value = silent_s,
            .limit = limit_s,
            .began_ago_s = silent_s},
           now);
}

void ServiceWatch::report_unwell(Service& service, AlarmBook& book, const Instant& now) const {
  const double for_s = service.unwell ? to_seconds(now.monotonic_ns - service.unwell_since_ns) : 0.0;
  const bool present = service.stream.presence() == Presence::present;
  const Name key = alarm_key("service_unwell", service.what.name.view());
  if (!service.unwell || !present || for_s < config_.degraded_hold_s) {
    service.first_reason.clear();
    book.release(key, now);
    return;
  }
  // A service that recovers has milder reasons in the end. The alarm keeps what began it.
  std::string why = reason_of(service.text);
  if (service.first_reason.empty() || !is_another(service.first_reason, why)) {
    service.first_reason = why;
  } else {
    why = service.first_reason.substr(0, 80) + ", then " + why.substr(0, 60);
  }
  book.hold({.key = key,
             .severity = Severity::warning,
             .text = sentence("Service %s has been unwell for %s: %s.", service.what.name.c_str(),
                              duration_text(for_s).c_str(), why.c_str()),
             .value = for_s,
             .limit = config_.degraded_hold_s,
             .began_ago_s = for_s},
            now);
}

std::vector<WatchedItem> ServiceWatch::items(const Instant& now) const {
  std::vector<WatchedItem> items;
  items.reserve(services_.size());
  for (const Service& service : services_) {
    items.push_back({service.what.name, service.stream.presence(), service.stream.age_s(now.monotonic_ns),
                     service.stream.rate_hz(now.monotonic_ns)});
  }
  return items;
}

}  // namespace fathom::health
