#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "archive/layout.hpp"
#include "archive/reader.hpp"
#include "archive/writer.hpp"
#include "estimation/engine/anticipation.hpp"
#include "estimation/engine/past/past.hpp"
#include "estimation/navigator/navigator.hpp"

namespace fathom::estimation {

/// Receives the verdicts as they are given.
class VerdictSink {
 public:
  /// `measurement` has the number of this verdict, and whether it is final; `previous` is the kind of the one
  /// before it, or of this one when it is the first.
  virtual void judged(const Measurement& measurement, const Judgement& judgement, VerdictKind previous) = 0;

 protected:
  ~VerdictSink() = default;
};

/// Keeps the inertial steps, events and snapshots of the last horizon_s and puts every event at its own
/// instant. The state is a function of the sorted events alone: an event that comes late takes the navigator
/// back to the newest snapshot before it, and everything since is applied again in the one order of
/// Measurement::key(). All storage is made by the constructor.
///
/// Snapshots stand snapshot_interval_s apart, and just before the stamps at which late measurements are
/// expected. While those come that were not expected there, the younger ones stand closer, by an eighth of
/// their age: most measurements are late by tens of milliseconds, and then little more than that is repeated.
/// Where snapshots stand changes the work and never the result.
///
/// An event that lies more than replay_steps_per_sample steps back is not made up for within one inertial
/// sample: a second navigator starts from the snapshot and takes that many steps with each sample, while the
/// first goes on without the event. As soon as the second has caught up it takes the first one's place. Then
/// the state is that function of the sorted events again.
///
/// The first verdict of an event is given when it acts for the first time, another one when a repetition
/// judges it to be of another kind, and the final one when nothing that may still come can act before it: it
/// has left the horizon, or the room that there is for events, and no second navigator is behind it.
class History {
 public:
  enum class Placing : std::uint8_t { taken, late, duplicate, from_the_future, not_started };

  explicit History(const Setup& setup);

  [[nodiscard]] const Navigator& navigator() const { return present(); }
  [[nodiscard]] bool started() const { return started_; }
  /// Every event that is held, oldest first.
  template <class Visit>
  void for_each_event(Visit&& visit) const {
    for (std::size_t rank = 0; rank < event_count_; ++rank) visit(pool_[order_[rank]]);
  }

  /// Takes an event in; it acts with the next step.
  Placing insert(const Measurement& measurement, VerdictSink& sink);
  /// One inertial interval, with all the repetition that late events ask for.
  void advance(const ImuStep& step, VerdictSink& sink);
  /// Lets late events act now instead of with the next steps; those after the present instant are given up.
  /// All verdicts are final then: what comes later and is older is late.
  void settle(VerdictSink& sink);
  /// Lets the present instant be this one, with no past.
  void begin(TimeNs now_ns, VerdictSink& sink);
  void begin_given(const InitialState& initial, TimeNs now_ns, VerdictSink& sink);
  void rebase(TimeNs now_ns, double unobserved_s, VerdictSink& sink);
  /// Back to before the first sample.
  void clear(VerdictSink& sink);

  // history_archive.cpp
  /// What the state follows from: the oldest navigator that is held, and the steps and events since.
  void write(archive::Writer& archive) const;
  /// That of another history of an equal setup, whose newest step ends at `newest_ns`. Why not, with nothing
  /// changed, when it is none; else empty.
  [[nodiscard]] std::string read(archive::Reader& archive, TimeNs newest_ns, VerdictSink& sink);
  void layout(archive::Layout& archive) const;

  /// Steps done again because of late events, since construction.
  [[nodiscard]] std::uint64_t repeated_steps() const { return repeated_steps_; }
  /// A late event is still being made up for.
  [[nodiscard]] bool catching_up() const { return catching_up_; }

 private:
  /// Of which instant a snapshot is. Apart from the navigators, tens of kB each: the search goes over these
  /// with every inertial sample.
  struct Mark {
    std::uint64_t after_step = 0;  ///< number of steps applied
    TimeNs now_ns = 0;
    TimeNs kept_until_ns = 0;  ///< an instrument is expected to be stamped just behind it until then
    std::uint16_t place = 0;   ///< in navigators_
  };

  // history_archive.cpp
  struct Candidate;
  void read_steps(archive::Reader& archive, Candidate& out) const;
  void read_events(archive::Reader& archive, Candidate& out) const;
  void take_over(const Candidate& found, VerdictSink& sink);

  // history_snapshots.cpp
  /// Goes back to before the earliest event that came late, or lets the second navigator do it.
  void go_back();
  /// Until when something is expected that is stamped just behind this snapshot; 0: nothing is.
  [[nodiscard]] TimeNs expected_behind(const Mark& mark) const;
  /// Something may still come that is stamped there.
  [[nodiscard]] bool is_awaited(const Mark& mark) const;
  /// The newest snapshot before an instant.
  [[nodiscard]] std::size_t snapshot_before(TimeNs stamp_ns) const;
  /// Whether a snapshot is due, `newest_ns` being the end of the newest step and `expected_until_ns` what the
  /// anticipation says.
  [[nodiscard]] bool save_due(TimeNs newest_ns, TimeNs expected_until_ns) const;
  /// Something older is expected until then: a snapshot that is made now will be undone before it is used.
  [[nodiscard]] bool goes_back_between(TimeNs newest_ns, TimeNs until_ns) const;
  void save(VerdictSink& sink, TimeNs kept_until_ns = 0);
  void thin_snapshots(TimeNs newest_ns);
  void drop_snapshot(std::size_t age_order);

  /// Gives a verdict of an event, the one after those that were given before.
  static void say(Measurement& event, const Judgement& judgement, bool is_final, VerdictSink& sink);
  /// Gives the final verdict of the next `count` events that have none; `unjudged`: of those that have not
  /// acted.
  void settle_first(std::size_t count, VerdictKind unjudged, VerdictSink& sink);
  /// Gives the final verdict of events that no event to come can precede.
  void settle_past(VerdictSink& sink);
  /// Every event gets its final verdict and is forgotten; this one, when it has not acted yet.
  void forget_past(VerdictSink& sink, VerdictKind verdict);
  /// The same without a word.
  void forget();
  /// So far ahead of the newest inertial sample an event may be stamped.
  [[nodiscard]] DurationNs future_tolerance_ns(const Measurement& measurement) const;
  [[nodiscard]] Navigator& present() { return navigators_[present_]; }
  [[nodiscard]] const Navigator& present() const { return navigators_[present_]; }
  [[nodiscard]] Leg& present_leg() { return past_.on() ? legs_[present_] : leg_without_past_; }
  /// On to the given number of steps.
  void repeat_until(std::uint64_t target, VerdictSink& sink);
  void run(Navigator& navigator, Leg& leg, const ImuStep& step, VerdictSink& sink);
  /// One event at its instant.
  Judgement act(Navigator& navigator, Leg& leg, const Measurement& event);
  /// At most so many steps of the second navigator.
  void catch_up(std::uint64_t steps, VerdictSink& sink);
  /// How many steps end at an instant or behind it; those before step `first` do not.
  [[nodiscard]] std::uint64_t steps_since(TimeNs stamp_ns, std::uint64_t first) const;
  /// The oldest instant from which steps may still be repeated.
  [[nodiscard]] TimeNs oldest_ns() const;
  void drop_before(TimeNs stamp_ns, VerdictSink& sink);
  [[nodiscard]] const Navigator& snapshot(std::size_t age_order) const {
    return navigators_[marks_[age_order].place];
  }
  [[nodiscard]] Measurement& event(std::size_t rank) { return pool_[order_[rank]]; }
  [[nodiscard]] const Judgement& judgement(std::size_t rank) const { return judgements_[order_[rank]]; }
  [[nodiscard]] std::size_t first_after(TimeNs stamp_ns) const;

  const Setup* setup_;
  DurationNs horizon_ns_;
  DurationNs snapshot_interval_ns_;
  Past past_;
  Leg leg_without_past_;  ///< of the present navigator where nothing is remembered
  bool started_ = false;
  std::uint64_t steps_done_ = 0;
  TimeNs dirty_ns_ = 0;         ///< earliest event that has not acted although its instant is past; 0: none
  std::vector<ImuStep> steps_;  ///< ring, by step number
  std::vector<Navigator> navigators_;  ///< the present one and the snapshots
  std::vector<Leg> legs_;              ///< of these; none where nothing is remembered
  std::uint16_t present_;              ///< place of the present one
  std::vector<Mark> marks_;            ///< by age, oldest first; the first snapshot_count_ are in use
  std::size_t snapshot_count_ = 0;
  std::vector<Measurement> pool_;
  std::vector<std::uint16_t> order_;  ///< ranks to places in the pool; the first event_count_ are in use
  std::size_t event_count_ = 0;
  std::size_t settled_count_ = 0;      ///< so many of the oldest have their final verdict
  std::vector<Judgement> judgements_;  ///< the newest of each place in the pool
  std::uint64_t repeated_steps_ = 0;
  std::uint64_t fine_until_step_ =
      0;  ///< snapshots stand close as long as unexpected late events keep coming
  Anticipation anticipation_;
  // The second navigator. Snapshots up to caught_up_step_ are its own, those behind it the first one's.
  bool catching_up_ = false;
  Navigator catching_;
  Leg catching_leg_;
  std::uint64_t caught_up_step_ = 0;
  int catching_for_ = 0;  ///< inertial samples
};

}  // namespace fathom::estimation
