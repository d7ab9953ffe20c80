#pragma once

#include <map>
#include <string>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"

namespace fathom::health {

/// Who knocks on the network, by what services count in their life signs and by whom the monitor itself sees:
/// "stranger_refused", somebody who proved no identity, and "permission_refused", an identity that tried what
/// it may not, where the network is protected; "malformed_datagram", bytes that would have ended or blocked a
/// service; "state_refused", a navigation engine's state that is broken or does not come from the one that
/// leads.
/// All are warnings, active while it goes on and for kWindowS after.
class IntruderWatch {
 public:
  static constexpr double kWindowS = 30.0;

  void add(const ServiceStatus& status, const Instant& now);
  /// Those present now whom this host does not speak to, each in words.
  void strangers(std::vector<std::string> present, const Instant& now);
  void report(AlarmBook& book, const Instant& now) const;

 private:
  static constexpr std::size_t kMaxServices = 64;  ///< names come from the network: bounded

  /// One kind of refusal.
  struct Refusals {
    std::map<Name, std::uint64_t> counted;  ///< by service, since its start
    std::map<Name, TimeNs> rose_ns;         ///< monotonic, when a service last counted one
    TimeNs since_ns = 0;                    ///< monotonic, of the first within the window
  };
  static void follow(Refusals& refusals, const Name& service, std::uint64_t value, const Instant& now);
  static void warn(AlarmBook& book, const Refusals& refusals, const char* key, const char* what,
                   const Instant& now);
  /// Names of the services that counted one within the window, in words; empty: none did.
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
