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

/// Knows who leads: whose navigation state DDS delivers, and who says so in its account of itself. A state is
/// taken from there only. Pure and not thread-safe; `now_ns` is monotonic, `writer` that of the sample.
class LeaderWatch {
 public:
  /// `patience_ns`: for which a state and an account count.
  explicit LeaderWatch(DurationNs patience_ns) : patience_ns_(patience_ns) {}

  /// A navigation state of another instance was delivered.
  void heard(const Name& instance, const WriterGuid& writer, TimeNs now_ns);
  /// An account of another instance.
  void told(const ReplicaStatus& status, const WriterGuid& writer, TimeNs now_ns);
  struct Objection {
    std::string why;      ///< the state is not taken, in words; empty when it is
    bool forged = false;  ///< no change of leadership explains it
  };
  /// To a state that this instance is said to send.
  [[nodiscard]] Objection objection(const Name& instance, const WriterGuid& writer, TimeNs now_ns) const;

 private:
  using Participant = std::array<std::uint8_t, 12>;
  static constexpr std::size_t kMost = 16;  // accounts of participants; further ones are not heard
  struct Account {
    Name instance;
    bool leads = false;
    TimeNs told_ns = 0;
    std::optional<TimeNs> leads_since_ns;  ///< when it last began to say so
    std::optional<TimeNs> led_ns;          ///< when it last said so
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
