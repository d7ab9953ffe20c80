#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>

#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "fusion/life_sign.hpp"
#include "fusion/replica/verdict_relay.hpp"
#include "host/service_host.hpp"

namespace fathom::fusion {

/// Publishes the engine's verdicts, and counts them. Where several fusion services share a vehicle, the one
/// that leads speaks; the others listen to it, and one that takes over says what it had no time for.
///
/// What holds there: as long as both have the same samples, each measurement has one final verdict, except
/// that one which both say or hear at the same moment, while the lead passes between two that live, may be
/// said twice, and that one which was sent as the service died, and lost on the way, is not said again.
class VerdictDesk {
 public:
  /// `mutex` guards the engine. `speaks`: whether this service is the one that is heard; none where there is
  /// only one.
  VerdictDesk(host::ServiceHost& host, std::mutex& mutex, estimation::FusionEngine& engine,
              std::function<bool()> speaks);

  /// All that the engine has given. One thread at a time does so for all, so that those of one measurement
  /// keep their order; the engine is not held while they are written. Mutex not held.
  void publish();
  /// One that the engine does not know of, a final one. Mutex not held.
  void publish(const Verdict& verdict);
  /// Of the inertial samples. Mutex held.
  void set_imu_writer(const WriterGuid& writer) { imu_writer_ = writer; }
  /// The engine goes on from another state. Mutex held.
  void begin_anew() { relay_.clear(); }
  /// Mutex held.
  [[nodiscard]] VerdictFigures figures() const;

 private:
  /// How many there are to be written. Mutex held.
  std::size_t take(std::span<Verdict> batch, bool aloud);
  void count(const Verdict& verdict);
  [[nodiscard]] bool aloud() const { return !speaks_ || speaks_(); }

  host::ServiceHost& host_;
  std::mutex& mutex_;
  estimation::FusionEngine& engine_;
  const std::function<bool()> speaks_;
  bool publishing_ = false;  ///< a thread is in publish()
  VerdictRelay relay_;
  VerdictFigures figures_;
  WriterGuid imu_writer_{};
  bus::Writer<Verdict> verdicts_;
  std::optional<bus::Reader<Verdict>> others_;  ///< where there are several; ends first
};

}  // namespace fathom::fusion
