#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
#include "health/instant.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

struct FixWatchConfig {
  double frozen_path_m = 5.0;    ///< a fix that repeats while the vehicle travels this far is frozen
  double disagreement_m = 20.0;  ///< fixes whose displacement differs this much from a velocity, within ...
  double window_s = 10.0;        ///< ... this time, disagree with that velocity
};

/// A watch for fixes that look healthy and are not.
///
/// Frozen: the reading repeats bit by bit while the stamps go on, and the vehicle moves by the receiver's own
/// velocity, the navigation state or the DVL, whichever travelled farthest. Three verdicts "frozen" of fusion
/// in a row count as well.
/// Disagreement: the displacement between fixes differs from the integral of the receiver's own velocity, or
/// of the navigation state's. Three fixes in a row decide. After a pause the window starts again, because
/// fusion judges whether the first fixes after an outage are right.
/// A receiver that counts as missing is neither.
class FixWatch {
 public:
  explicit FixWatch(const FixWatchConfig& config, Freshness fresh = {})
      : config_(config), fresh_(std::move(fresh)) {}

  /// Returns whether the fix may be used, by these checks alone.
  bool add(const GpsSample& sample, const Instant& now);
  void add(const NavState& state, const Instant& now);
  void add(const DvlSample& sample, const Instant& now);
  void add(const Verdict& verdict);

  [[nodiscard]] bool frozen(const Name& receiver) const;
  /// Monotonic instant of the first of the equal fixes.
  [[nodiscard]] TimeNs same_since_ns(const Name& receiver) const;
  /// "gps_frozen:<receiver>", "gps_disagrees:<receiver>".
  void report(AlarmBook& book, const Instant& now) const;

 private:
  using Pair = std::array<double, 2>;  ///< north, east [m]
  /// Path and displacement since the start, by one source of velocity.
  struct Travel {
    double path_m = 0.0;
    Pair moved_m{};
    Pair velocity_m_s{};
    TimeNs stamp_ns = 0;
  };
  struct Fix {
    TimeNs stamp_ns = 0;
    double latitude_rad = 0.0;
    double longitude_rad = 0.0;
    double sigma_m = 0.0;
    std::optional<Pair> own_m;  ///< unknown where the receiver gives no velocity
    std::optional<Pair> nav_m;  ///< unknown while the navigation state cannot be relied on
  };
  enum class Against { own, nav };
  struct Receiver {
    std::array<double, 3> reading{kUnknown, kUnknown, kUnknown};
    TimeNs heard_ns = 0;  ///< monotonic
    TimeNs same_since_ns = 0;
    int same = 0;
    Travel own_at_reading, own;
    double nav_path_at_reading_m = 0.0;
    double dvl_path_at_reading_m = 0.0;
    int judged_frozen = 0;  ///< by fusion, in a row
    bool frozen = false;
    double travelled_m = 0.0;  ///< while frozen
    bool own_known = false;
    std::deque<Fix> window;
    int disagreeing = 0;
    Against against = Against::own;
    double apart_m = 0.0;
    double limit_m = 0.0;
    double span_s = 0.0;
    TimeNs disagreed_ns = 0;
  };

  static void advance(Travel& travel, TimeNs stamp_ns, const Pair& velocity_m_s, double speed_m_s);
  void judge_frozen(Receiver& receiver, const GpsSample& sample, const Instant& now) const;
  void judge_displacement(Receiver& receiver, const GpsSample& sample, const Instant& now) const;
  /// Whether the displacement between two fixes differs from that of a velocity. The difference is stored in
  /// the receiver.
  bool compare(Receiver& receiver, const Fix& from, const Fix& to) const;
  [[nodiscard]] std::optional<Pair> nav_moved_at(TimeNs stamp_ns) const;

  FixWatchConfig config_;
  Freshness fresh_;
  std::map<Name, Receiver> receivers_;
  Travel nav_;
  double nav_velocity_sigma_m_s_ = kUnknown;
  std::deque<Travel> nav_history_;  ///< some states only, for fixes that arrive after newer states
  double dvl_path_m_ = 0.0;
  TimeNs dvl_stamp_ns_ = 0;
};

}  // namespace fathom::health
