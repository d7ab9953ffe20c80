#pragma once

#include <map>
#include <string>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "health/instruments/stream_watch.hpp"
#include "health/writers/service_voices.hpp"

namespace fathom::health {

/// An expected service.
struct ExpectedService {
  Name name;
  Severity severity = Severity::warning;
};

struct ServiceWatchConfig {
  double missing_s =
      3.0;  ///< a service without a life sign for this long is missing; they come once a second
  double degraded_hold_s = 5.0;  ///< how long a service must call itself unwell before that is an alarm
};

/// A watch over every service by its life signs. One that nobody expects may come and go, but what it says of
/// itself is an alarm as well. One that is gone makes room for another one; where all the room is taken, the
/// rest is an alarm.
class ServiceWatch {
 public:
  static constexpr std::size_t kMaxServices = 32;  // of MonitorStatus

  ServiceWatch(const std::vector<ExpectedService>& expected, const ServiceWatchConfig& config,
               double startup_s, const Instant& start);

  void add(const ServiceStatus& status, const Instant& now);
  void evaluate(const Instant& now);
  /// Whether each expected service has been heard at least once.
  [[nodiscard]] bool all_heard() const;
  /// "service_unwell:<name>" and "service_twice:<name>" of every service; "services_unwatched"; of those
  /// expected "service_missing:<name>", and the momentary notice "service_restarted:<name>".
  void report(AlarmBook& book, const Instant& now);
  [[nodiscard]] std::vector<WatchedItem> items(const Instant& now) const;

 private:
  struct Service {
    ExpectedService what;
    bool expected = false;
    StreamWatch stream;
    ServiceState state = ServiceState::starting;
    std::string text{};
    ServiceVoices voices{};  ///< heard lately
    bool unwell = false;
    TimeNs unwell_since_ns = 0;
    std::string first_reason{};  ///< why it was unwell when the alarm was raised; empty: there is no alarm
    bool restarted = false;      ///< since the last report
  };

  [[nodiscard]] Service* find_or_make(const Name& name, const Instant& now);
  void report_twice(Service& service, AlarmBook& book, const Instant& now) const;
  void report_unwatched(AlarmBook& book, const Instant& now) const;
  void report_missing(const Service& service, AlarmBook& book, const Instant& now) const;
  void report_unwell(Service& service, AlarmBook& book, const Instant& now) const;

  ServiceWatchConfig config_;
  double startup_s_;
  std::vector<Service> services_;
  std::map<Name, std::size_t> index_;
  Name unwatched_;                 ///< the last one that found no room
  TimeNs unwatched_heard_ns_ = 0;  ///< monotonic
};

}  // namespace fathom::health
