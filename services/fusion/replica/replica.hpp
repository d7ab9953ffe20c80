#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/name.hpp"
#include "base/time.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/replication.hpp"
#include "samples/verdict.hpp"

namespace fathom::fusion {

/// What two engines are compared by.
struct StateMark {
  TimeNs stamp_ns = 0;
  std::uint64_t sequence = 0;
  std::array<double, 3> position_rad_m{};  ///< latitude, longitude, altitude
  std::array<double, 3> velocity_N_m_s{};
  std::array<double, 4> q_NB{};
};
[[nodiscard]] StateMark mark_of(const NavState& state);
/// Nobody who hears one after the other could tell that they are two: of the same number, and within a
/// millimetre, a millimetre per second and 10 microradians. Unknown equals unknown.
[[nodiscard]] bool alike(const StateMark& a, const StateMark& b);
/// There is a position to compare. Before that two engines may look alike that are at different points of
/// their alignment.
[[nodiscard]] bool has_position(const StateMark& mark);

/// How much later than the quickest of the last seconds a sample has come, by a clock that has nothing to do
/// with that of the stamps.
class Lateness {
 public:
  [[nodiscard]] DurationNs of(TimeNs stamp_ns, TimeNs now_ns);

 private:
  static constexpr DurationNs kWindow_ns = 2 * kNsPerSecond;
  static constexpr DurationNs kStep_ns =
      60 * kNsPerSecond;  // no bridge keeps samples so long: a clock was set
  bool begun_ = false;
  TimeNs begun_ns_ = 0;
  DurationNs least_ns_ = 0;   ///< now - stamp, in this window
  DurationNs before_ns_ = 0;  ///< in the one before
};

/// What one of several fusion services may do: speak, or hold its tongue until it knows what the others know.
///
/// The one whose navigation state is heard leads; that is settled by DDS (exclusive ownership), for everybody
/// alike. The states of engines that took in the same samples are equal, so whoever hears another one lead
/// compares it with its own state at the same stamp. From that follow the phases:
///
///   listening  after its start, and after a silence with samples lost in it in which another one may have
///              gone on: says nothing
///              until it hears a leader (then: behind) or none for `listen_ns` (then: in step, it leads)
///   behind     hears a leader that is not like it: says nothing, asks for the leader's state; in step once
///              `kAlikeNeeded` states in a row are alike, or when the leader is silent for `silence_ns`:
///              navigation from what it has is better than none
///   in step    speaks, except of what is long past or has been said, and except that one which was late and
///              hears a weaker one speak for it since leaves the lead to that one for a while; goes behind
///              when it has not been like
///   the leader for `quarrel_ns` (longer than late
///              measurements make a difference; at once if it has just begun alone), when a replica in step
///              lacks fewer samples, or when it has just begun alone and finds one that was in step before
///
/// Pure and not thread-safe; `now_ns` is monotonic.
class Replica {
 public:
  struct Options {
    DurationNs listen_ns = 0;
    DurationNs silence_ns = 0;
    DurationNs quarrel_ns = 0;
    DurationNs gap_ns = 0;    ///< without a state of its own: another one may have taken over in it
    DurationNs late_ns = 0;   ///< behind the samples' usual time of arrival: of the past, not for guidance
    DurationNs pause_ns = 0;  ///< between two of its states, after which a weaker one is heard
    DurationNs hold_ns = 0;   ///< without such a pause, until it takes the lead back from the weaker one
    /// Of the weaker one, for which it takes the lead back at once. Longer than the pauses of a busy machine:
    /// a change of the leader costs guidance a deadline without a state.
    DurationNs hold_silence_ns = 0;
    std::int32_t strength = 0;  ///< of its own, by which DDS chooses who is heard
  };
  static constexpr int kAlikeNeeded = 10;

  Replica(const Options& options, TimeNs now_ns);

  /// The engine has a new state. Whether it is to be published.
  [[nodiscard]] bool own(const NavState& state, TimeNs now_ns);
  /// A state was heard by which everybody navigates; `self`: it was this one's.
  void heard(const NavState& state, bool self, TimeNs now_ns);
  /// Another one's account of itself.
  void told(const ReplicaStatus& peer, TimeNs now_ns);
  /// How many other writers of the navigation state are there.
  void others(int count, TimeNs now_ns);
  /// The engine has taken the state of another one, which lacked `missed` samples.
  void caught_up(std::uint64_t missed);
  /// Samples that never arrived.
  void missed(std::uint64_t count, TimeNs now_ns);

  [[nodiscard]] ReplicaPhase phase() const { return phase_; }
  /// Its navigation state is the one heard, or would be if anybody listened.
  [[nodiscard]] bool leads() const { return phase_ == ReplicaPhase::in_step && !follows_; }
  [[nodiscard]] bool wants_state() const { return phase_ == ReplicaPhase::behind; }
  /// The instance heard last, when it is another one.
  [[nodiscard]] const Name& leader() const { return leader_; }
  /// Why it is behind.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// For how long it has been in step; 0 when it is not.
  [[nodiscard]] DurationNs in_step_ns(TimeNs now_ns) const;
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  [[nodiscard]] std::uint64_t times_caught_up() const { return caught_up_; }
  [[nodiscard]] std::uint64_t times_unprepared() const { return unprepared_; }

 private:
  void compare(const StateMark& own, const StateMark& other, TimeNs now_ns);
  void differs(TimeNs now_ns, const char* how);
  void fall_behind(std::string reason);
  void come_in_step(TimeNs now_ns);
  /// The lead passed to a weaker one, and does not pass back yet.
  [[nodiscard]] bool holds_its_tongue(TimeNs now_ns) const;
  [[nodiscard]] bool is_weaker(const Name& instance, TimeNs now_ns) const;
  [[nodiscard]] std::optional<std::uint64_t> missed_by(const Name& instance, TimeNs now_ns) const;

  struct Peer {
    ReplicaStatus status;
    TimeNs told_ns = 0;
  };

  Options options_;
  ReplicaPhase phase_ = ReplicaPhase::listening;
  TimeNs since_ns_;  ///< of listening
  TimeNs in_step_since_ns_ = 0;
  bool began_alone_ = false;   ///< it came in step because it heard nobody
  TimeNs own_ns_ = 0;          ///< when the engine had its last state; 0: none yet
  TimeNs other_ns_ = 0;        ///< when another one was last heard; 0: never
  TimeNs other_stamp_ns_ = 0;  ///< of what it said
  TimeNs alone_ns_ = 0;        ///< when the last of the others left; 0: not since the last state of its own
  int others_ = 0;
  bool follows_ = false;              ///< another one is heard
  std::optional<TimeNs> yielded_ns_;  ///< since when a weaker one is heard, or when it was late itself since
  Name leader_;
  std::string reason_;
  int alike_ = 0;         ///< in a row
  TimeNs unlike_ns_ = 0;  ///< since when not; 0: alike
  Lateness lateness_;
  bool missed_lately_ = false;  ///< samples, since the last state of its own
  bool took_state_ = false;     ///< since it fell behind
  std::uint64_t missed_ = 0;
  TimeNs missed_ns_ = 0;  ///< when the last one was noticed
  std::uint64_t caught_up_ = 0;
  std::uint64_t unprepared_ = 0;
  std::map<Name, Peer> peers_;              ///< bounded
  std::array<StateMark, 512> own_marks_{};  ///< ring
  std::size_t own_count_ = 0;
  std::array<StateMark, 64> waiting_{};  ///< states of the leader that this one has not come to yet; ring
  std::size_t waiting_first_ = 0;
  std::size_t waiting_count_ = 0;
};

/// Counts the samples that never came, by the sequence numbers of those that did.
class SampleGaps {
 public:
  /// A source and its sensor.
  using Stream = std::pair<SourceKind, Name>;
  using Table = std::map<Stream, std::uint64_t>;

  /// The number of samples between the last one of that stream and this one. A lower number than before is
  /// another beginning.
  [[nodiscard]] std::uint64_t note(SourceKind source, const SampleHeader& header);
  /// The last number of each stream.
  [[nodiscard]] const Table& last() const { return last_; }
  /// Streams of which nothing has arrived yet go on from there.
  void go_on_from(const Table& table);

 private:
  static constexpr std::size_t kMost = 64;  // streams; further ones are not watched
  Table last_;
};

}  // namespace fathom::fusion
