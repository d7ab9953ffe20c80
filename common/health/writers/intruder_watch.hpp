#pragma once

#include <map>
#include <string>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"

namespace fathom::health {

/// A watch for intruders on the network, by the counters in the life signs of services and by the strangers
/// that the monitor itself sees. All alarms are warnings, active while it goes on and for kWindowS after:
///
/// - "stranger_refused": somebody on a protected network proved no identity.
/// - "permission_refused": an identity on a protected network tried what it may not do.
/// - "malformed_datagram": bytes arrived that would have ended or blocked a service.
/// - "state_refused": the state of a navigation engine is broken, or does not come from the leader.
class IntruderWatch {
 public:
  static constexpr double kWindowS = 30.0;

  void add(const ServiceStatus& status, const Instant& now);
  /// Takes over the strangers that are present now, each in words.
  void strangers(std::vector<std::string> present, const Instant& now);
  void report(AlarmBook& book, const Instant& now) const;

 private:
  static constexpr std::size_t kMaxServices = 64;  ///< names come from the network: bounded

  /// One kind of refusal.
  struct Refusals {
    std::map<Name, std::uint64_t> counted;  ///< by service, since its start
    std::map<Name, TimeNs> rose_ns;         ///< monotonic, when a service last counted one
    TimeNs since_ns = 0;                    ///< monotonic, of the first refusal within the window
  };
  static void follow(Refusals& refusals, const Name& service, std::uint64_t value, const Instant& now);
  static void warn(AlarmBook& book, const Refusals& refusals, const char* key, const char* what,
                   const Instant& now);
  /// Names of the services that counted a refusal within the window, in words; empty: none did.
  static std::string recent(const Refusals& refusals, const Instant& now);

  std::map<Name, TimeNs> started_ns_;
  Refusals strangers_;
  Refusals permissions_;
  Refusals malformed_;
  Refusals states_;
  std::vector<std::string> present_;
  TimeNs present_since_ns_ = 0;
};

}  // namespace fathom::health
