#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "blackbox/store.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/monitor_config.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "sim/simulation.hpp"

namespace fathom::test {

/// A vehicle whose instruments are simulated, navigated by the real engine, watched by the real monitor's
/// judgement and recorded by the real recorder's writer, in one process and faster than real time. What is
/// done to it stands in no recording.
class Stage {
 public:
  static constexpr TimeNs kEpochNs = 1'700'000'000 * kNsPerSecond;

  /// `configured`: the vehicle that the services are told of, where it is another one.
  explicit Stage(sim::Scenario scenario, std::uint64_t seed, const sim::Scenario* configured = nullptr);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Changes a sample before it is published, t_s being the time of its stamp; false: it never is.
  std::function<bool(AnySample& sample, double t_s)> spoil;
  /// Samples that another process of the name of the bridge publishes besides.
  std::function<std::vector<AnySample>(const AnySample& sample, double t_s)> besides;
  /// Something to do at a time.
  void at(double t_s, std::function<void()> what) { what_.emplace(t_s, std::move(what)); }

  // What can happen to services.
  void kill_fusion();
  /// `resumed`: from what the killed one knew.
  void start_fusion(bool resumed);
  void kill_bridge(const std::string& service) { silent_[service] = true; }
  void start_bridge(const std::string& service);
  /// What a service says of itself from now on, in its life signs; empty: it is well.
  void let_say(const std::string& service, const std::string& text) { unwell_[service] = text; }
  void set_clock(double step_s) { utc_offset_ns_ += from_seconds(step_s); }
  void add_standby();
  void take_over();

  /// Runs and closes the file.
  void run(double duration_s, const std::filesystem::path& file);

 private:
  struct Fusion;
  struct Service {
    std::uint32_t pid = 0;
    TimeNs started_ns = 0;
  };

  void deliver(const AnySample& sample, bool second);
  void give(Fusion& fusion, const AnySample& sample, const std::string& writer);
  void life();
  void watch();
  template <class T>
  void record(const T& sample, const char* topic, const char* type, const std::string& writer,
              std::uint32_t pid, bool latched = false);
  [[nodiscard]] std::string process_of(const std::string& service, std::uint32_t pid) const;

  sim::Scenario scenario_;
  sim::Simulation simulation_;
  config::FusionConfig fusion_config_;
  config::MonitorConfig monitor_config_;
  std::unique_ptr<health::VehicleHealth> monitor_;
  std::unique_ptr<blackbox::Store> store_;
  std::map<std::string, std::uint32_t> origins_;
  std::multimap<double, std::function<void()>> what_;
  std::vector<std::unique_ptr<Fusion>> fusions_;
  std::vector<std::byte> kept_;
  std::map<std::string, Service> services_;
  std::map<std::string, bool> silent_;
  std::map<std::string, std::string> unwell_;
  DurationNs utc_offset_ns_ = 0;
  TimeNs now_ns_ = kEpochNs;
  std::uint32_t next_pid_ = 1000;
  std::uint64_t sequence_ = 0;
};

}  // namespace fathom::test
