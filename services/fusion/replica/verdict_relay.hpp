#pragma once

#include <cstddef>
#include <deque>

#include "base/time.hpp"
#include "samples/verdict.hpp"

namespace fathom::fusion {

/// Verdicts that a service which does not lead would have published lately, without those that the leader
/// published. A service that takes over publishes what is left, so that nothing is missing and nothing comes
/// twice.
///
/// Two verdicts on the same measurement are the same when both are final or both have the same revision.
/// Samples that arrived at two services in another order may get different verdicts in between, but the same
/// one in the end. Pure and not thread-safe; `now_ns` is monotonic.
class VerdictRelay {
 public:
  /// `keep_ns`: how long a verdict is kept; longer than a takeover takes.
  explicit VerdictRelay(DurationNs keep_ns) : keep_ns_(keep_ns) {}

  /// Takes a verdict that this service would have published.
  void own(const Verdict& verdict, TimeNs now_ns);
  /// Takes a verdict that another service published.
  void heard(const Verdict& verdict, TimeNs now_ns);
  /// Whether another service published, lately, what this one would publish now: the one that led before may
  /// have been further on. Each answer stands for one publication.
  [[nodiscard]] bool was_heard(const Verdict& verdict, TimeNs now_ns);
  /// Takes out the oldest verdict that nobody has published. False when there is none.
  [[nodiscard]] bool next_unsaid(Verdict& verdict, TimeNs now_ns);
  void clear();

 private:
  static constexpr std::size_t kMost = 2048;
  struct Entry {
    Verdict verdict;
    TimeNs at_ns = 0;
  };
  using Entries = std::deque<Entry>;

  /// Removes the verdict from `among` when it is there.
  [[nodiscard]] bool take_from(Entries& among, const Verdict& verdict, TimeNs now_ns) const;
  static void keep(Entries& entries, const Verdict& verdict, TimeNs now_ns);
  void forget_old(Entries& entries, TimeNs now_ns) const;

  DurationNs keep_ns_;
  Entries own_;    ///< not published by another service
  Entries heard_;  ///< published by another service before this one gave it
};

}  // namespace fathom::fusion
