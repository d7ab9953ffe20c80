#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimation/engine/order.hpp"
#include "estimation/engine_config.hpp"
#include "estimation/navigator/measurement.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/forecast.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/usbl.hpp"
#include "samples/verdict.hpp"

namespace fathom::estimation {

/// Inertial navigation aided by whatever the vehicle carries: alignment, strapdown mechanisation, error-state
/// filter, gates, and a history that puts late measurements where they belong.
///
/// Pure: no clock, thread, file or logger; time comes from the stamps. Not thread-safe: one owner, or a mutex
/// around it. Nothing is allocated after construction.
///
/// Order. Inertial samples must come in order (others are refused with a verdict). Aiding samples may come in
/// any order: as long as each arrives within `horizon_s` of the newest inertial sample, the state after the
/// next inertial sample is the same to the last bit whatever the order was. Aiding samples are taken in at
/// once and judged with the next inertial sample at or after their stamp.
///
/// The promise holds with the next inertial sample after which catching_up() is false: at once for a
/// measurement that lies no more than `replay_steps_per_sample` steps back, and never later than 32 inertial
/// samples after the first one that lies further back; finish() waits for neither. It is made of the
/// measurements that were taken in: more than `measurement_capacity` of them within the horizon shorten it,
/// what is older gets the verdict late. Orders act at their stamps, like measurements. Of two samples of
/// one sensor (of a DVL, of one layer; of an acoustic one, of one beacon) with the same stamp the one with
/// the lower sequence number counts, and of two with the same number as well the one that came first.
///
/// Fixes that somebody tells (FixSample) may be older than the horizon: such a one acts at the instant at
/// which it was told, header.received_ns, as if it had come in time (engine/past). What that needs is
/// remembered for late_fix_memory_s, where a sensor of that kind is configured; a fix of before is late.
///
/// Bounded work. An inertial sample costs one step, and when older measurements came in since the last one,
/// at most twice `replay_steps_per_sample` repeated steps and those of snapshot_interval_s; the last of 32 as
/// above, at most horizon_s + snapshot_interval_s of steps and measurements.
///
/// Verdicts. The first one of an aiding sample is given with the inertial sample with which it is judged, or
/// at once when it is refused. When a late neighbour changes the judgement, the state follows, and another
/// verdict is given: of the next revision, with the kind that was said before. Only the kind counts: that
/// test ratio and innovation move within it is not said again. Exactly one verdict of each sample is final:
/// the first, when the sample is refused without being taken in, else one more, with the innovation and test
/// ratio that it has in the end, once no sample that may still come can act before it. That is horizon_s
/// after its stamp; when the room for measurements runs out; when inertial samples begin anew after a gap; or
/// in finish(). The final verdicts are, like the state, a function of the sorted samples. Inertial samples
/// get a verdict, a final one, only when they are refused.
class FusionEngine {
 public:
  /// Throws std::invalid_argument with the text of EngineConfig::validate() when that is not empty.
  explicit FusionEngine(const EngineConfig& config);
  ~FusionEngine();
  FusionEngine(FusionEngine&&) noexcept;
  FusionEngine& operator=(FusionEngine&&) noexcept;
  FusionEngine(const FusionEngine&) = delete;
  FusionEngine& operator=(const FusionEngine&) = delete;

  /// True when nav_state() is new: the sample was accepted. NavState is given from the first accepted sample
  /// on; its mode says what it is worth.
  bool add(const ImuSample& sample);
  /// `writer`: who published it, for its verdicts.
  template <Aiding Sample>
  void add(const Sample& sample, const Name& writer = {}) {
    take(EventSample(sample), kSourceOf<Sample>, writer);
  }
  /// Of a kind that only informs: what is published goes by it from the next inertial sample on, nothing is
  /// estimated with it, and it gets a verdict, a final one, only when it is refused for its stamp.
  template <Informing Sample>
  void add(const Sample& sample, const Name& writer = {}) {
    inform(sample, writer);
  }

  /// Why a command is none that this engine follows, in words; empty when it is one.
  [[nodiscard]] std::string objection(const Command& command) const;
  /// set_position, realign, enable_source, disable_source, mark_at_rest: takes effect at its stamp, which may
  /// be `horizon_s` before or after the newest inertial sample. Empty when it is taken; else why not.
  [[nodiscard]] std::string apply(const Command& command);
  /// What became of an order, oldest first; the last 64 are kept.
  bool next_outcome(OrderOutcome& outcome);

  /// Forgets everything and starts from a given state with the first inertial sample at or after its stamp.
  void start_from(const InitialState& state);

  /// At the end of a recording: every measurement that still waits gets its verdict. Late ones act now, and
  /// nav_state() follows; those stamped after the newest inertial sample are from_the_future. All verdicts
  /// are final then, and an older measurement that is still added is late.
  void finish();

  /// At the newest accepted inertial sample. header.sequence counts navigation states.
  [[nodiscard]] const NavState& nav_state() const;

  /// The oldest verdict not yet taken. Drain after each call: when more than 1024 wait, beside two for each
  /// of `measurement_capacity`, the oldest is dropped and counted.
  bool next_verdict(Verdict& verdict);
  [[nodiscard]] std::uint64_t verdicts_dropped() const;

  /// Inertial steps done again for the sake of late measurements, since construction.
  [[nodiscard]] std::uint64_t repeated_steps() const;
  /// A late measurement that lies more than `replay_steps_per_sample` steps back has not acted in nav_state()
  /// yet.
  [[nodiscard]] bool catching_up() const;

  void fill(NavDetail& detail) const;
  void fill(AlignmentStatus& status) const;
  /// Growth of the uncertainty if position fixes stop now, the vehicle goes on as in the last two minutes,
  /// and the other aiding goes on as it is, or is lost as well: by propagating the covariance (FC-1). A few
  /// milliseconds of work for each aiding sensor.
  void fill(Forecast& forecast);
  /// The same in two parts: a copy of the present, some tens of microseconds, and the work, which another
  /// thread may do while the engine goes on, until the next of either fill() or take_forecast().
  void take_forecast();
  void fill_taken(Forecast& forecast);
  /// Of the same: radius that holds 95 % of the horizontal errors `after_s` from now; unknown without
  /// navigation.
  [[nodiscard]] double forecast_horizontal_95_m(double after_s);

  /// Appends everything that navigation follows from, delayed measurements included, as an archive
  /// (common/archive): an engine of an equal configuration that restores it, of whatever build, does from
  /// there on what this one does, to the last bit, but for what either publishes while it is catching up.
  /// Left out are verdicts not yet taken and the motion that the forecast remembers. False, with nothing
  /// appended, before the first inertial sample.
  [[nodiscard]] bool save(std::vector<std::byte>& out) const;
  /// The bytes may be anybody's. Empty when done; else, with nothing changed, which field is wrong, what it
  /// is and what was expected. Nothing more is said of the measurements that this engine held before: the
  /// state holds its own.
  [[nodiscard]] std::string restore(std::span<const std::byte> image);

  /// Covariance of position (m, N), velocity and attitude error phi of the point of the IMU.
  [[nodiscard]] Eigen::Matrix<double, 9, 9> navigation_covariance() const;

 private:
  void take(const EventSample& sample, SourceKind source, const Name& writer);
  void inform(const AnySample& sample, const Name& writer);

  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::estimation
