#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimation/engine/imu_preprocessor.hpp"
#include "estimation/engine/order.hpp"
#include "estimation/filter/adjoint.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"

namespace fathom::estimation {

/// Fixed-interval smoother over the models of FusionEngine, for recorded data: every navigation state from
/// all measurements before and after it.
///
/// Forward, each measurement is applied at its own instant, however late it arrived, so that nothing needs to
/// be repeated and no state needs to be cloned. Backward, the adjoint of the filter (adjoint.hpp) goes along
/// each inertial step, update and reset. The forward pass keeps a snapshot of the navigator every `segment`
/// steps and nothing else; the way back repeats one segment at a time with everything written down. Memory so
/// grows with the recording by the steps and measurements themselves and one snapshot a segment.
class Smoother {
 public:
  /// Throws std::invalid_argument with the text of EngineConfig::validate() when that is not empty.
  explicit Smoother(const EngineConfig& config);
  Smoother(const Smoother&) = delete;
  Smoother& operator=(const Smoother&) = delete;

  /// Starts from a given state, as FusionEngine::start_from(); before the first sample.
  void start_from(const InitialState& state) { start_ = state; }

  /// Samples of one recording. Inertial samples in the order of arrival; the others at any time, but where
  /// the inertial unit begins a new time axis (ImuPreprocessor), each while its own axis is the present one.
  void add(const ImuSample& sample);
  template <Aiding Sample>
  void add(const Sample& sample) {
    take(EventSample(sample), kSourceOf<Sample>);
  }
  /// An order, at its stamp. Empty when it is taken; else why not.
  [[nodiscard]] std::string add(const Command& command);

  struct Output {
    /// Exactly one verdict of each measurement, a final one, in the order of their instants.
    std::function<void(const Verdict&)> verdict;
    /// Exactly one of each order that was taken: those before the first inertial sample, behind the last or
    /// given twice are not done.
    std::function<void(const OrderOutcome&)> outcome;
    /// The forward pass, one state per accepted inertial sample, in the order of time.
    std::function<void(const NavState&)> filtered;
    /// What the forward pass estimated, once, at its end.
    std::function<void(const NavDetail&)> detail;
    /// One state per accepted inertial sample, the newest first.
    std::function<void(const NavState&)> smoothed;
    /// Share of the work done, 0 to 1.
    std::function<void(double)> progress;
  };
  /// Both passes over all that was added. Every part of `output` may be empty.
  void run(const Output& output);

 private:
  /// An accepted inertial sample.
  struct Tick {
    ImuPreprocessor::Outcome outcome = ImuPreprocessor::Outcome::step;
    std::uint32_t axis = 0;  ///< number of time axes before this one
    TimeNs stamp_ns = 0;
    TimeNs received_ns = 0;
    double unobserved_s = 0.0;
    ImuStep step;
  };
  struct Event {
    std::uint32_t axis = 0;
    Measurement measurement;
  };
  struct Snapshot {
    std::size_t tick = 0;   ///< the first that it has not seen
    std::size_t event = 0;  ///< likewise
    bool started = false;
    Navigator navigator;
  };
  struct Segment;

  void take(const EventSample& sample, SourceKind source);
  void sort_events();
  void refuse(const SampleHeader& header, SourceKind source, VerdictKind kind);
  /// One tick with its events; what becomes of them goes to the verdicts and outcomes of `output`.
  void advance(Snapshot& at, const Output& output) const;
  /// What became of an event.
  static void tell(const Event& event, const Judgement& judgement, const Output& output);
  void fill(const Navigator& navigator, std::size_t tick, NavState& out) const;
  void smooth(const Snapshot& from, std::size_t end, Segment& segment, Adjoint& adjoint,
              const std::function<void(const NavState&)>& smoothed) const;

  Setup setup_;
  ImuPreprocessor intake_;
  std::optional<InitialState> start_;
  std::uint32_t axis_ = 0;
  std::vector<Tick> ticks_;
  std::vector<Event> events_;
  std::vector<Verdict> refused_;   ///< before the first pass: not configured, or refused inertial samples
  std::vector<int> shown_states_;  ///< those whose covariance a NavState tells
};

}  // namespace fathom::estimation
