#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "config/fusion/fusion_config.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/command.hpp"
#include "samples/kinds.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/intake.hpp"
#include "samples/verdict.hpp"

namespace fathom::cli {

/// One run of a fusion service, done again. What the recording holds is put in as it comes; states and
/// verdicts may come before or after what they follow from.
class Proof {
 public:
  /// From the beginning of a run that made its state itself.
  explicit Proof(const config::FusionConfig& config);
  /// From a state that it had under way. Throws Failure when it is none of this engine.
  Proof(const config::FusionConfig& config, std::span<const std::byte> state);

  void add(const AnySample& sample);
  void add(const Command& order);
  void add(const IntakeRecord& intake);
  void add(const NavState& recorded);
  void add(const Verdict& recorded);
  /// At the end of the recording.
  void finish();

  /// The first difference, in words; empty as long as there is none.
  [[nodiscard]] const std::string& difference() const { return difference_; }
  [[nodiscard]] std::uint64_t states() const { return states_; }        ///< that were equal
  [[nodiscard]] std::uint64_t verdicts() const { return verdicts_; }    ///< likewise
  [[nodiscard]] std::uint64_t taken() const { return next_ - first_; }  ///< samples and orders
  /// States that were computed and are not in the recording, before the last one that is.
  [[nodiscard]] std::uint64_t unheard() const { return unheard_; }

 private:
  /// What tells a sample or an order from others: order or its kind, sensor, stamp, sequence.
  using Key = std::tuple<int, Name, TimeNs, std::uint64_t>;
  /// Of a verdict: source, sensor, stamp, sequence, revision.
  using VerdictKey = std::tuple<int, Name, TimeNs, std::uint64_t, std::uint32_t>;

  void go_on();
  /// False: what it names has not come yet.
  bool give(const IntakeEntry& entry);
  void collect();
  void compare(const NavState& recorded, const NavState& computed);
  void compare(const Verdict& recorded, const Verdict& computed);
  void differ(const std::string& what);
  static VerdictKey key_of(const Verdict& verdict);

  estimation::FusionEngine engine_;
  std::optional<TimeNs> from_ns_;  ///< of the state that is begun with, until its inertial sample was found
  std::map<Key, AnySample> samples_;  // of the last minute
  std::map<Key, Command> orders_;
  TimeNs newest_ns_ = 0;
  std::map<std::uint64_t, IntakeEntry> entries_;  // not given yet, by their numbers
  std::uint64_t next_ = 0;
  std::uint64_t first_ = 0;
  TimeNs begin_ns_ = std::numeric_limits<TimeNs>::min();
  Name imu_writer_;
  std::map<std::uint64_t, NavState> computed_;  // not compared yet, by sequence
  std::map<std::uint64_t, NavState> recorded_;
  // Several of a key: of a measurement that was published twice.
  std::map<VerdictKey, std::deque<Verdict>> verdicts_computed_;
  std::map<VerdictKey, std::deque<Verdict>> verdicts_recorded_;
  std::uint64_t last_state_ = 0;
  std::uint64_t unheard_ = 0;
  std::uint64_t states_ = 0;
  std::uint64_t verdicts_ = 0;
  std::string difference_;
};

}  // namespace fathom::cli
