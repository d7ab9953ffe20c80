#pragma once

#include <optional>
#include <vector>

#include "archive/layout.hpp"
#include "archive/reader.hpp"
#include "archive/writer.hpp"
#include "estimation/engine/past/keyframe.hpp"
#include "estimation/navigator/navigator.hpp"

namespace fathom::estimation {

/// The instant that a measurement speaks of: its stamp, less the latency of its sensor.
[[nodiscard]] TimeNs instant_of(const Setup& setup, const SampleHeader& header, int sensor);
/// The instant at which a measurement acts. It is a function of the sample alone, so that every engine has
/// the same: a fix that was older than half of the horizon when it was given (received_ns) acts then, through
/// what is remembered; all else acts at its own instant.
[[nodiscard]] TimeNs acting_of(const Setup& setup, const SampleHeader& header, int sensor);

/// What an engine remembers beyond its horizon, for fixes that come minutes late: keyframes of the filter and
/// what it did between them (LATE-1..4). A keyframe is made where one is due, and at each instant at which a
/// late fix acts, so that what is remembered is, like the state, a function of the sorted events: a navigator
/// that is taken back makes the keyframes since anew. All storage is made by the constructor; none where
/// nothing is to be remembered.
class Past {
 public:
  /// Keyframes within the time that is remembered, at most; with more states there are fewer, so that a state
  /// that is saved stays below two megabytes.
  static constexpr std::uint64_t kMostKept = 30;
  /// Beyond these: those at which late fixes act,
  static constexpr std::uint64_t kForFixes = 8;
  /// and room for a navigator that is behind the newest.
  static constexpr std::uint64_t kMargin = 24;
  static constexpr int kMostFixes = Passage::kColumns / kFixRows;

  explicit Past(const Setup& setup);

  [[nodiscard]] bool on() const { return !frames_.empty(); }
  /// How far apart keyframes are.
  [[nodiscard]] DurationNs interval_ns() const { return interval_ns_; }
  /// At the end of each step: keeps the way, and makes a keyframe where one is due.
  void follow(Navigator& navigator, Leg& leg);
  /// Nothing leads from before to what comes.
  static void forget(Leg& leg);
  /// Lets a late fix act at the present instant.
  Judgement judge(Navigator& navigator, Leg& leg, const Measurement& measurement);

  // past_archive.cpp: what `leg` can be asked for.
  void write(const Leg& leg, archive::Writer& archive) const;
  void layout(archive::Layout& archive) const;
  /// Read, but not yet taken over.
  struct Candidate {
    explicit Candidate(int states) : leg(states) {}
    Leg leg;
    std::vector<Keyframe> frames;  ///< the newest last
  };
  void read(archive::Reader& archive, TimeNs now_ns, Candidate& out) const;
  void take_over(const Candidate& found, Leg& leg);

 private:
  class View;

  [[nodiscard]] Keyframe& frame(std::uint64_t number) { return frames_[number % frames_.size()]; }
  [[nodiscard]] const Keyframe& frame(std::uint64_t number) const { return frames_[number % frames_.size()]; }
  /// Number of the first keyframe that a navigator can be asked for.
  [[nodiscard]] std::uint64_t oldest(const Leg& leg) const;
  /// Ends the leg here and begins the next.
  void close(Navigator& navigator, Leg& leg);
  /// Which two keyframes an instant lies between; none where it is not remembered.
  [[nodiscard]] std::optional<LateFix> place(const Leg& leg, TimeNs instant_ns) const;
  /// The filter's state of then, between those two.
  [[nodiscard]] FilterState state_at(const LateFix& where, TimeNs instant_ns) const;
  /// Weight times what the fix sees of the error of a keyframe joins its columns, from `first` on.
  void join(const LateFix& fix, double weight, const Keyframe& at, int first);
  /// (LATE-3): from the fix, which is the first in the columns, to the present. False where it asks for more
  /// than is remembered.
  bool look_back(const Leg& leg, const LateFix& fix);
  /// (LATE-4): that fix acts, whose columns begin with `first`.
  void act(const LateFix& fix, int first);

  const Setup* setup_;
  std::uint64_t kept_ = 0;
  DurationNs interval_ns_ = 0;
  std::array<int, kFixStates> states_{};  ///< that a fix sees; -1: not a state
  std::vector<Keyframe> frames_;          ///< ring, by number
  std::uint64_t made_ = 0;                ///< the most keyframes that any navigator has made
  // Of look_back().
  Passage::Columns columns_;
  Passage::Square sums_;
  Passage::Vector mean_;
};

}  // namespace fathom::estimation
