#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/name.hpp"
#include "base/time.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/replication.hpp"

namespace fathom::fusion {

/// The part of a navigation state by which two engines are compared.
struct StateMark {
  TimeNs stamp_ns = 0;
  std::uint64_t sequence = 0;
  std::array<double, 3> position_rad_m{};  ///< latitude, longitude, altitude
  std::array<double, 3> velocity_N_m_s{};
  std::array<double, 4> q_NB{};
};
[[nodiscard]] StateMark mark_of(const NavState& state);
/// Whether two marks look the same to a reader: they have the same number, and agree within a millimetre, a
/// millimetre per second and 10 microradians. Unknown equals unknown.
[[nodiscard]] bool alike(const StateMark& a, const StateMark& b);
/// Whether there is a position to compare. Without one, two engines at different points of their alignment
/// may look alike.
[[nodiscard]] bool has_position(const StateMark& mark);

/// The lateness of a sample: how much later it came than the quickest one of the last seconds. The two
/// clocks, of arrival and of the stamps, need not agree.
class Lateness {
 public:
  [[nodiscard]] DurationNs of(TimeNs stamp_ns, TimeNs now_ns);

 private:
  static constexpr DurationNs kWindow_ns = 2 * kNsPerSecond;
  static constexpr DurationNs kStep_ns =
      60 * kNsPerSecond;  // a clock was set, as no bridge keeps samples so long
  bool begun_ = false;
  TimeNs begun_ns_ = 0;
  DurationNs least_ns_ = 0;   ///< least now - stamp in this window
  DurationNs before_ns_ = 0;  ///< in the window before it
};

/// One of several fusion services on a vehicle: whether it may publish its navigation state, or has to be
/// silent until it knows what the others know.
///
/// The service whose navigation state is delivered leads. DDS settles that (exclusive ownership), for every
/// reader alike. Engines that took in the same samples have equal states. So each service compares the
/// leader's state with its own state of the same stamp, and goes through these phases:
///
/// - listening: after the start, and after a gap in which samples were lost and another service may have
///   taken over. It publishes nothing. When it hears a leader it is behind. When it hears none for
///   `listen_ns` it is in step and leads.
/// - behind: it hears a leader whose state differs. It publishes nothing and asks for the leader's state.
///   It is in step after `kAlikeNeeded` equal states in a row. It is also in step when the leader is silent
///   for `silence_ns`, because navigation from what it has is better than none.
/// - in step: it publishes, with three exceptions: states that are long past, states that the leader has
///   published already, and states during a hold. A hold begins when this service was late and a weaker one
///   was delivered instead: it leaves the lead to the weaker one for a while. States that are late are
///   published all the same when no other service was delivered for `silence_ns` and they do not become less
///   late: nobody has newer ones.
///
/// A service in step falls behind in three cases. Its states differ from the leader's for `quarrel_ns`, which
/// is longer than late measurements make a difference (at once if it has just begun alone). Another service
/// in step lacks fewer samples. Or it has just begun alone, and finds another one that was in step before.
///
/// Pure and not thread-safe; `now_ns` is monotonic.
class Replica {
 public:
  struct Options {
    DurationNs listen_ns = 0;
    DurationNs silence_ns = 0;
    DurationNs quarrel_ns = 0;
    DurationNs gap_ns = 0;    ///< without a state of its own, in which another service may have taken over
    DurationNs late_ns = 0;   ///< a state this late after the samples' usual arrival is not for guidance
    DurationNs pause_ns = 0;  ///< between two of its states, after which DDS delivers a weaker service
    DurationNs hold_ns = 0;   ///< without such a pause, before it takes the lead back from the weaker service
    /// Silence of the weaker service after which it takes the lead back at once. It is longer than the pauses
    /// of a busy machine, because a change of the leader costs guidance a deadline without a state.
    DurationNs hold_silence_ns = 0;
    std::int32_t strength = 0;  ///< its ownership strength, by which DDS chooses whom it delivers
  };
  static constexpr int kAlikeNeeded = 10;

  Replica(const Options& options, TimeNs now_ns);

  /// Takes a new state of its own engine. Returns whether it is to be published.
  [[nodiscard]] bool own(const NavState& state, TimeNs now_ns);
  /// Takes a state that DDS delivered, which is the leader's. `self`: it is its own.
  void heard(const NavState& state, bool self, TimeNs now_ns);
  /// Takes the status of another service.
  void told(const ReplicaStatus& peer, TimeNs now_ns);
  /// Takes the number of other writers of the navigation state.
  void others(int count, TimeNs now_ns);
  /// Notes that its engine took over a state of another service, which lacked `missed` samples.
  void caught_up(std::uint64_t missed);
  /// Counts samples that never arrived.
  void missed(std::uint64_t count, TimeNs now_ns);

  [[nodiscard]] ReplicaPhase phase() const { return phase_; }
  /// Whether DDS delivers its navigation state, or would if there were a reader.
  [[nodiscard]] bool leads() const { return phase_ == ReplicaPhase::in_step && !follows_; }
  [[nodiscard]] bool wants_state() const { return phase_ == ReplicaPhase::behind; }
  /// The other service that led last.
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
  /// Whether a late state is withheld: another service has newer ones, or this one soon will.
  [[nodiscard]] bool withholds_late(DurationNs lateness_ns, TimeNs now_ns);
  /// Whether a weaker service has the lead, and keeps it for now.
  [[nodiscard]] bool leaves_the_lead(TimeNs now_ns) const;
  [[nodiscard]] bool is_weaker(const Name& instance, TimeNs now_ns) const;
  [[nodiscard]] std::optional<std::uint64_t> missed_by(const Name& instance, TimeNs now_ns) const;

  struct Peer {
    ReplicaStatus status;
    TimeNs told_ns = 0;
  };
  /// The lateness at the begin of a span of late states.
  struct Late {
    TimeNs since_ns = 0;
    DurationNs lateness_ns = 0;
    bool lasts = false;  ///< it did not become less in the span before
  };

  Options options_;
  ReplicaPhase phase_ = ReplicaPhase::listening;
  TimeNs since_ns_;  ///< of listening
  TimeNs in_step_since_ns_ = 0;
  bool began_alone_ = false;   ///< it is in step because it heard nobody
  TimeNs own_ns_ = 0;          ///< when the engine had its last state; 0: none yet
  TimeNs other_ns_ = 0;        ///< when another service was last delivered; 0: never
  TimeNs other_stamp_ns_ = 0;  ///< stamp of that state
  TimeNs alone_ns_ = 0;        ///< when the last of the others left; 0: not since the last state of its own
  int others_ = 0;
  bool follows_ = false;              ///< DDS delivers another service
  std::optional<TimeNs> yielded_ns_;  ///< since when a weaker service leads; restarted when this one is late
  Name leader_;
  std::string reason_;
  int alike_ = 0;         ///< in a row
  TimeNs unlike_ns_ = 0;  ///< since when not; 0: alike
  Lateness lateness_;
  std::optional<Late> late_;    ///< none: the last state was in time, or a gap came after it
  bool missed_lately_ = false;  ///< samples, since the last state of its own
  bool took_state_ = false;     ///< since it fell behind
  std::uint64_t missed_ = 0;
  TimeNs missed_ns_ = 0;  ///< when the last one was noticed
  std::uint64_t caught_up_ = 0;
  std::uint64_t unprepared_ = 0;
  std::map<Name, Peer> peers_;              ///< bounded
  std::array<StateMark, 512> own_marks_{};  ///< ring
  std::size_t own_count_ = 0;
  std::array<StateMark, 64>
      waiting_{};  ///< states of the leader that its own engine has not reached yet; ring
  std::size_t waiting_first_ = 0;
  std::size_t waiting_count_ = 0;
};

}  // namespace fathom::fusion
