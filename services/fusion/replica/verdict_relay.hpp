#pragma once

#include <cstddef>
#include <deque>

#include "base/time.hpp"
#include "samples/verdict.hpp"

namespace fathom::fusion {

/// What a fusion service that does not lead would have said lately, less what the one that leads was heard to
/// say. When it takes over, it says what is left: what the other one had no time for, and nothing twice.
///
/// Two verdicts are the same when they are final both, or of the same revision, of the same measurement: what
/// arrived at the two services in another order may have been judged otherwise in between, and comes to the
/// same in the end. Pure and not thread-safe; `now_ns` is monotonic.
class VerdictRelay {
 public:
  /// `keep_ns`: what is older has been said, or concerns nobody any more. Longer than a takeover takes.
  explicit VerdictRelay(DurationNs keep_ns) : keep_ns_(keep_ns) {}

  /// It would have said this.
  void own(const Verdict& verdict, TimeNs now_ns);
  /// Another one said this.
  void heard(const Verdict& verdict, TimeNs now_ns);
  /// The oldest that nobody was heard to say; it is said now. False when there is none.
  [[nodiscard]] bool next_unsaid(Verdict& verdict, TimeNs now_ns);
  void clear();

 private:
  static constexpr std::size_t kMost = 2048;
  struct Entry {
    Verdict verdict;
    TimeNs at_ns = 0;
  };
  using Entries = std::deque<Entry>;

  /// Takes the verdict out of those where it is among them; else it joins the others.
  void cancel(Entries& among, Entries& others, const Verdict& verdict, TimeNs now_ns);
  void forget_old(Entries& entries, TimeNs now_ns) const;

  DurationNs keep_ns_;
  Entries own_;    ///< not heard
  Entries heard_;  ///< from another one, before it was its own
};

}  // namespace fathom::fusion
