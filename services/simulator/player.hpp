#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/clock.hpp"
#include "sim/device_encoder.hpp"
#include "simulator/device_link.hpp"
#include "simulator/measurement_source.hpp"

namespace fathom::simulator {

/// Counts since the start.
struct PlayerStatus {
  std::uint64_t messages = 0;
  double latest_s = 0.0;  ///< how late the latest message of the last second left, vehicle time
  bool finished = false;  ///< the recording has come to its end
  std::map<std::string, std::uint64_t> messages_of;  ///< by kind of sensor
  std::map<std::string, LinkCounters> links;         ///< by where readers find them
};

/// Sends every measurement's bytes on its device's link at the instant of its arrival, and hands out the
/// truth at its own instant. One thread, paced by the vehicle's clock; a step of the host's UTC does not
/// disturb it.
class Player {
 public:
  using TruthHandler = std::function<void(const Truth&)>;

  /// Opens the links: throws LinkError. `clock` must outlive the player.
  Player(std::unique_ptr<MeasurementSource> source, const sim::Scenario& scenario, TimeNs epoch_ns,
         const std::string& link_dir, int port_offset, const Clock& clock, TruthHandler on_truth);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  [[nodiscard]] PlayerStatus status() const;
  /// One line per device: kind, protocol, where.
  [[nodiscard]] const std::vector<std::string>& devices() const { return devices_; }

 private:
  struct Outgoing {
    TimeNs due_ns = 0;
    std::uint64_t order = 0;  ///< among equals
    int kind = -1;            ///< index into kinds_; -1: truth
    std::vector<std::uint8_t> bytes;
    Truth truth;
  };
  struct Kind {
    std::string name;
    DeviceLink* link = nullptr;
  };

  void run();
  void fetch(TimeNs until_ns);
  void send(const Outgoing& outgoing, TimeNs now_ns);
  [[nodiscard]] TimeNs vehicle_now() const;
  /// False when told to stop.
  bool wait_until(TimeNs vehicle_ns) const;

  const Clock& clock_;
  TimeNs epoch_ns_;
  DurationNs monotonic_to_utc_ns_;
  std::unique_ptr<MeasurementSource> source_;
  sim::DeviceEncoder encoder_;
  TruthHandler on_truth_;
  std::map<std::string, std::unique_ptr<DeviceLink>> links_;
  std::vector<Kind> kinds_;
  std::vector<std::string> devices_;
  std::vector<Outgoing> queue_;  ///< heap, the next due on top
  std::uint64_t order_ = 0;
  bool exhausted_ = false;

  mutable std::mutex mutex_;  ///< guards status_
  PlayerStatus status_;
  TimeNs worst_since_ns_ = 0;
  double worst_s_ = 0.0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace fathom::simulator
