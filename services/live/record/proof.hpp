#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "config/fusion/fusion_config.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "live/record/ledger.hpp"
#include "live/record/state_pool.hpp"
#include "samples/command.hpp"
#include "samples/kinds.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/intake.hpp"
#include "samples/verdict.hpp"

namespace fathom::cli {

/// One run of a fusion service, done again. What the recording holds is put in as it comes; states and
/// verdicts may come before or after what they follow from. Where the run went on from a state that it had
/// not made itself, the proof waits for that state to be offered to the pool, and it offers what others went
/// on from.
class Proof {
 public:
  struct Begin {
    std::uint64_t entry = 0;  ///< number of the first entry in the recording
    bool afresh = false;      ///< the run made its state itself, from this entry on
    /// States that the run had under way, by their stamps: where it cannot be done again from its beginning
    /// it is from the first of these whose inertial sample it took.
    std::map<TimeNs, std::vector<std::byte>> checkpoints{};
    /// Whether a sample came when the recorder did not hear the bridge. Where it is not there the proof goes
    /// on from the next checkpoint. Empty: never.
    std::function<bool(const IntakeEntry&)> outside{};
  };
  /// The pool outlives this. `from`: the number of its first entry, and whether it began there.
  Proof(const config::FusionConfig& config, StatePool& pool, Begin begin);

  /// `writer`: who published the sample.
  void add(const AnySample& sample, const Name& writer);
  void add(const Command& order);
  void add(const IntakeRecord& intake);
  void add(const NavState& recorded);
  void add(const Verdict& recorded);
  /// At the end of the recording. Goes as far as it comes; true when that was any further than before.
  bool go_on();
  /// Waits no longer for a state that nobody offers, and looks for another one to go on from; false when it
  /// waited for none.
  bool give_up_waiting();
  /// Nothing more comes.
  void finish();

  /// The first difference, in words; empty as long as there is none.
  [[nodiscard]] const std::string& difference() const { return difference_; }
  [[nodiscard]] std::uint64_t states() const { return states_; }      ///< that were equal
  [[nodiscard]] std::uint64_t verdicts() const { return verdicts_; }  ///< likewise
  [[nodiscard]] std::uint64_t taken() const { return given_; }        ///< samples and orders
  /// States that were computed and are not in the recording, before the last one that is.
  [[nodiscard]] std::uint64_t unheard() const;
  /// How often it went on from a state that it had not made itself.
  [[nodiscard]] std::uint64_t taken_up() const { return taken_up_; }
  /// The samples that are not in the recording because the recorder did not hear their bridges: the first
  /// ones in words, and how many there are.
  [[nodiscard]] const std::vector<std::string>& lacking() const { return lacking_; }
  [[nodiscard]] std::uint64_t lacking_count() const { return lacking_count_; }
  /// The checkpoint that it went on from after the last of these; nothing where there is none.
  [[nodiscard]] std::optional<TimeNs> whole_from_ns() const { return whole_from_ns_; }
  [[nodiscard]] std::uint64_t states_before() const { return states_before_; }  ///< equal before that
  /// Whether it lacks nothing, or was done again behind all that it lacks.
  [[nodiscard]] bool is_whole() const {
    return lacking_count_ == 0 || (whole_from_ns_ && states_ > states_before_);
  }
  /// From when on it was done again; nothing: from its beginning.
  [[nodiscard]] std::optional<TimeNs> from_ns() const { return from_ns_; }
  /// What could not be done again, in words; empty when nothing is missing but what came before from_ns().
  [[nodiscard]] const std::string& missing() const { return missing_; }

 private:
  /// What tells a sample or an order from others: order or its kind, sensor, stamp, sequence.
  using Key = std::tuple<int, Name, TimeNs, std::uint64_t>;
  /// Stamp first: what is oldest makes room.
  using StateKey = std::pair<TimeNs, std::uint64_t>;
  using VerdictKey = std::tuple<TimeNs, int, Name, std::uint64_t, std::uint32_t>;

  /// False: what it names has not come yet.
  bool give(const IntakeEntry& entry);
  bool give_sample(const IntakeEntry& entry);
  bool give_order(const IntakeEntry& entry);
  bool take_up(const IntakeEntry& entry);
  [[nodiscard]] bool is_lacking(const IntakeEntry& entry) const;
  /// Goes by a sample that the recording lacks.
  void pass(const IntakeEntry& entry);
  void interrupt();
  /// Of a run that is not done again at present: whether it is from this entry on.
  bool look_for_begin(const IntakeEntry& entry);
  void begin_from(TimeNs stamp_ns, std::span<const std::byte> state);
  void lose(const std::string& why);
  [[nodiscard]] const AnySample* find(const IntakeEntry& entry) const;
  void give(const ImuSample& sample, const IntakeEntry& entry);
  void collect(bool again);
  void offer();
  void differ(const std::string& what);
  static VerdictKey key_of(const Verdict& verdict);

  estimation::FusionEngine engine_;
  StatePool& pool_;
  std::map<TimeNs, std::vector<std::byte>> checkpoints_;
  std::function<bool(const IntakeEntry&)> outside_;
  bool under_way_;          ///< the engine is where the run's was
  bool ended_ = false;      ///< the engine's end was among the entries
  std::size_t waited_ = 0;  ///< samples that came while a state was waited for
  std::optional<TimeNs> from_ns_;
  std::string missing_;
  std::vector<std::string> lacking_;
  std::uint64_t lacking_count_ = 0;
  std::optional<TimeNs> whole_from_ns_;
  std::uint64_t states_before_ = 0;  ///< that were equal before whole_from_ns_
  /// By Key: who published it, and the sample. The last ones.
  std::multimap<Key, std::pair<Name, AnySample>> samples_;
  std::deque<Key> ages_;  // of the samples, the oldest first
  std::map<Key, Command> orders_;
  std::map<std::uint64_t, IntakeEntry> entries_;  // not given yet, by their numbers
  std::uint64_t next_;
  std::size_t records_ = 0;  // lists that came
  TimeNs begin_ns_;          // of what is under way: what is recorded of later stamps follows from it
  std::vector<std::pair<TimeNs, TimeNs>> done_;  // from and to, of what was under way before
  std::optional<TimeNs> duplicates_until_ns_;
  Name imu_writer_;
  Ledger<StateKey, NavState> nav_states_;
  Ledger<VerdictKey, Verdict> judgements_;
  StateKey last_state_{};
  std::uint64_t given_ = 0;
  std::uint64_t taken_up_ = 0;
  std::uint64_t states_ = 0;
  std::uint64_t verdicts_ = 0;
  std::string difference_;
};

}  // namespace fathom::cli
