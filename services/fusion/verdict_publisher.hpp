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

/// Publishes the engine's verdicts, and counts them. Where several fusion services share a vehicle, only the
/// leader publishes. The others listen to it, and one that takes over publishes what the leader had no time
/// for.
///
/// Each measurement has one final verdict as long as both services have the same samples, with two
/// exceptions. A verdict may be published twice when the lead passes between two services that live and both
/// publish it at the same moment. A verdict may be missing when it was sent as the leader died and was lost
/// on the way.
class VerdictPublisher {
 public:
  /// `mutex` guards the engine. `speaks`: whether this service leads; empty where there is only one.
  VerdictPublisher(host::ServiceHost& host, std::mutex& mutex, estimation::FusionEngine& engine,
                   std::function<bool()> speaks);

  /// Publishes every verdict that the engine has given. One thread at a time does so for all, so that the
  /// verdicts of one measurement keep their order. The mutex is free while they are written. Mutex not held.
  void publish();
  /// Publishes a final verdict on a sample that the engine was not given. Mutex not held.
  void publish(const Verdict& verdict);
  /// Who publishes the inertial samples that the engine is given. Mutex held.
  void set_imu_writer(const Name& writer) { imu_writer_ = writer; }
  /// Forgets what was not published, because the engine goes on from another state. Mutex held.
  void begin_anew() { relay_.clear(); }
  /// Mutex held.
  [[nodiscard]] VerdictFigures figures() const;

 private:
  /// Fills `batch` with verdicts to be published, and returns how many. Mutex held.
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
  Name imu_writer_;
  bus::Writer<Verdict> verdicts_;
  std::optional<bus::Reader<Verdict>> others_;  ///< where there are several services; destroyed first
};

}  // namespace fathom::fusion
