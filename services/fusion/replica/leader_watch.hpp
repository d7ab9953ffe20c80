#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/name.hpp"
#include "base/time.hpp"
#include "bus/participant.hpp"
#include "samples/status/replication.hpp"

namespace fathom::fusion {

/// A watch over who leads: the service whose navigation state DDS delivers and whose status says so. An
/// engine takes over a state of that service only. Pure and not thread-safe; `now_ns` is monotonic, `writer`
/// is the writer of the sample.
class LeaderWatch {
 public:
  /// `patience_ns`: how long a state and a status count.
  explicit LeaderWatch(DurationNs patience_ns) : patience_ns_(patience_ns) {}

  /// Takes a navigation state of another instance that DDS delivered.
  void heard(const Name& instance, const WriterGuid& writer, TimeNs now_ns);
  /// Takes the status of another instance.
  void told(const ReplicaStatus& status, const WriterGuid& writer, TimeNs now_ns);
  struct Objection {
    std::string why;      ///< why the state is not taken, in words; empty when it is
    bool forged = false;  ///< no change of leadership explains it
  };
  /// The objection to a state of an engine that claims to come from `instance`.
  [[nodiscard]] Objection objection(const Name& instance, const WriterGuid& writer, TimeNs now_ns) const;

 private:
  using Participant = std::array<std::uint8_t, 12>;
  static constexpr std::size_t kMost = 16;  // statuses of participants; further ones are ignored
  struct Account {
    Name instance;
    bool leads = false;
    TimeNs told_ns = 0;
    std::optional<TimeNs> leads_since_ns;  ///< when it last began to claim the lead
    std::optional<TimeNs> led_ns;          ///< when it last claimed the lead
  };
  [[nodiscard]] static Participant of(const WriterGuid& writer);
  [[nodiscard]] bool fresh(TimeNs at_ns, TimeNs now_ns) const { return now_ns - at_ns <= patience_ns_; }

  DurationNs patience_ns_;
  Name leader_;
  std::optional<Participant> led_by_;  ///< none: nobody was heard yet
  TimeNs heard_ns_ = 0;
  std::map<Participant, Account> accounts_;
};

}  // namespace fathom::fusion
