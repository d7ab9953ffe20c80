#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/forecast.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {

inline constexpr TimeNs kStart_ns = 1'700'000'000 * kNsPerSecond;
inline constexpr DurationNs kPeriod_ns = 10 * kNsPerMillisecond;
inline constexpr double kStillLatitude_rad = 0.635;
inline constexpr double kStillLongitude_rad = 2.22;
// Gravity at this latitude on the ellipsoid, by Somigliana's formula.
inline constexpr double kStillGravity_m_s2 = 9.798;

/// The instruments of a vehicle that lies still and level, heading north, on their topics.
class StillVehicle {
 public:
  explicit StillVehicle(std::uint32_t domain, TimeNs start_ns = kStart_ns)
      : start_ns_(start_ns), participant_(presence(domain, "still_vehicle")) {}

  [[nodiscard]] bool heard() const {
    return imu_.matched_readers() > 0 && gps_.matched_readers() > 0 && dvl_.matched_readers() > 0 &&
           depth_.matched_readers() > 0 && command_.matched_readers() > 0;
  }
  bus::Participant& participant() { return participant_; }

  [[nodiscard]] TimeNs now_ns() const { return start_ns_ + ticks_ * kPeriod_ns; }
  ImuSample imu(const Name& sensor = "imu") {
    ImuSample sample;
    sample.header = header(sensor);
    sample.header.sequence = static_cast<std::uint64_t>(ticks_);
    sample.angular_rate_B_rad_s = {7.292115e-5 * std::cos(kStillLatitude_rad), 0.0,
                                   -7.292115e-5 * std::sin(kStillLatitude_rad)};
    sample.specific_force_B_m_s2 = {0.0, 0.0, -kStillGravity_m_s2};
    return sample;
  }
  GpsSample gps() {
    GpsSample sample;
    sample.header = header("gps");
    sample.fix = GpsFix::fix_3d;
    sample.latitude_rad = kStillLatitude_rad;
    sample.longitude_rad = kStillLongitude_rad;
    sample.altitude_m = 18.5;
    sample.velocity_N_m_s = {0.0, 0.0, 0.0};
    return sample;
  }
  DvlSample dvl() {
    DvlSample sample;
    sample.header = header("dvl");
    sample.velocity_D_m_s = {0.0, 0.0, 0.0};
    return sample;
  }
  Command command(CommandKind kind, const Name& target = {}) {
    Command out;
    out.header = header("operator");
    out.kind = kind;
    out.target = target;
    return out;
  }
  void write(const ImuSample& sample) { imu_.write(sample); }
  void write(const GpsSample& sample) { gps_.write(sample); }
  void write(const DvlSample& sample) { dvl_.write(sample); }
  void write(const DepthSample& sample) { depth_.write(sample); }
  void write(const Command& command) { command_.write(command); }

  /// One inertial sample a tick, four times as fast as on a vehicle; GPS and DVL five times a vehicle second.
  void run(int ticks, bool aided = true) {
    for (int i = 0; i < ticks; ++i) {
      ++ticks_;
      write(imu());
      if (aided && ticks_ % 20 == 0) {
        write(gps());
        write(dvl());
      }
      std::this_thread::sleep_for(std::chrono::microseconds(2500));
    }
  }
  [[nodiscard]] int ticks() const { return ticks_; }

  SampleHeader header(const Name& sensor) {
    SampleHeader out;
    out.vehicle = "auv";
    out.sensor = sensor;
    out.stamp_ns = now_ns();
    out.received_ns = now_ns();
    out.sequence = ++sequence_;
    return out;
  }

 private:
  TimeNs start_ns_;
  int ticks_ = 0;
  std::uint64_t sequence_ = 0;
  bus::Participant participant_;
  bus::Writer<ImuSample> imu_{participant_};
  bus::Writer<GpsSample> gps_{participant_};
  bus::Writer<DvlSample> dvl_{participant_};
  bus::Writer<DepthSample> depth_{participant_};
  bus::Writer<Command> command_{participant_};
};

/// Everything that fusion says.
class FusionEar {
  template <class F>
  auto with(F&& function) const {
    const std::lock_guard lock(mutex_);
    return function();
  }

 public:
  explicit FusionEar(bus::Participant& participant)
      : states_(participant, [this](const NavState& s, const bus::SampleInfo&) { keep(states, s); }),
        verdicts_(participant, [this](const Verdict& v, const bus::SampleInfo&) { keep(verdicts, v); }),
        details_(participant, [this](const NavDetail& d, const bus::SampleInfo&) { keep(details, d); }),
        alignments_(participant,
                    [this](const AlignmentStatus& a, const bus::SampleInfo&) { keep(alignments, a); }),
        forecasts_(participant, [this](const Forecast& f, const bus::SampleInfo&) { keep(forecasts, f); }),
        services_(participant,
                  [this](const ServiceStatus& s, const bus::SampleInfo&) { keep(services, s); }) {}

  [[nodiscard]] bool matched() const {
    return states_.matched_writers() > 0 && verdicts_.matched_writers() > 0;
  }
  [[nodiscard]] std::size_t state_count() const {
    return with([&] { return states.size(); });
  }
  [[nodiscard]] NavState last_state() const {
    return with([&] { return states.back(); });
  }
  [[nodiscard]] std::vector<NavState> all_states() const {
    return with([&] { return states; });
  }
  /// Measurements of which this was said first.
  [[nodiscard]] int count(SourceKind source, VerdictKind kind) const {
    return with([&] {
      int n = 0;
      for (const Verdict& v : verdicts) n += v.source == source && v.kind == kind && v.revision == 0 ? 1 : 0;
      return n;
    });
  }
  /// Verdicts on the measurement of that sequence number.
  [[nodiscard]] std::vector<Verdict> of(SourceKind source, std::uint64_t sequence) const {
    return with([&] {
      std::vector<Verdict> out;
      for (const Verdict& v : verdicts) {
        if (v.source == source && v.header.sequence == sequence) out.push_back(v);
      }
      return out;
    });
  }
  /// How many final verdicts there are on what that source measured at an instant.
  [[nodiscard]] int finals(SourceKind source, TimeNs stamp_ns) const {
    return with([&] {
      int n = 0;
      for (const Verdict& v : verdicts)
        n += v.source == source && v.header.stamp_ns == stamp_ns && v.is_final ? 1 : 0;
      return n;
    });
  }
  /// What was said of the measurements of that stamp, for messages.
  [[nodiscard]] std::string told(TimeNs stamp_ns) const {
    return with([&] {
      std::string out;
      for (const Verdict& v : verdicts) {
        if (v.header.stamp_ns != stamp_ns || v.source == SourceKind::imu) continue;
        out += "\n  " + std::string(to_string(v.source)) + " #" + std::to_string(v.header.sequence) + " " +
               std::string(to_string(v.kind)) + ", revision " + std::to_string(v.revision) +
               (v.is_final ? ", final" : "");
      }
      return out;
    });
  }
  /// Who wrote what was judged.
  [[nodiscard]] std::set<std::string> writers(SourceKind source) const {
    return with([&] {
      std::set<std::string> out;
      for (const Verdict& v : verdicts) {
        if (v.source == source) out.insert(v.writer.str());
      }
      return out;
    });
  }
  [[nodiscard]] std::optional<ServiceStatus> service() const {
    return with([&] {
      std::optional<ServiceStatus> out;
      for (const ServiceStatus& s : services) {
        if (s.header.sensor == Name("fusion")) out = s;
      }
      return out;
    });
  }
  [[nodiscard]] std::size_t slow_count() const {
    return with([&] { return std::min({details.size(), alignments.size(), forecasts.size()}); });
  }
  [[nodiscard]] NavDetail last_detail() const {
    return with([&] { return details.back(); });
  }

 private:
  template <class T>
  void keep(std::vector<T>& list, const T& value) {
    const std::lock_guard lock(mutex_);
    list.push_back(value);
  }
  mutable std::mutex mutex_;
  std::vector<NavState> states;
  std::vector<Verdict> verdicts;
  std::vector<NavDetail> details;
  std::vector<AlignmentStatus> alignments;
  std::vector<Forecast> forecasts;
  std::vector<ServiceStatus> services;
  bus::Reader<NavState> states_;
  bus::Reader<Verdict> verdicts_;
  bus::Reader<NavDetail> details_;
  bus::Reader<AlignmentStatus> alignments_;
  bus::Reader<Forecast> forecasts_;
  bus::Reader<ServiceStatus> services_;
};

/// The real fathom-fusion with its shipped configuration, told where it starts.
class FusionTest : public ::testing::Test {
 protected:
  void start(std::uint32_t domain, std::vector<std::string> sets = {}, TimeNs start_ns = kStart_ns) {
    setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
    vehicle = std::make_unique<StillVehicle>(domain, start_ns);
    ear = std::make_unique<FusionEar>(vehicle->participant());
    sets.insert(sets.begin(), "checkpoint.path=");  // unless the test says where
    sets.push_back("bus.domain=" + std::to_string(domain));
    sets.push_back("start.mode=given");
    sets.push_back(
        R"(start.state={"latitude_deg":36.38282,"longitude_deg":127.19663,"altitude_m":18.5,"rpy_deg":[0,0,0]})");
    arguments = {"--config", source_dir() + "/deploy/config/fusion.json"};
    for (const std::string& set : sets) {
      arguments.push_back("--set");
      arguments.push_back(set);
    }
    launch();
  }
  /// As it was started before.
  void launch() {
    fusion = std::make_unique<Process>("fathom-fusion", arguments);
    ASSERT_TRUE(wait_until([&] { return vehicle->heard() && ear->matched(); }, 20.0)) << fusion->err();
  }
  void TearDown() override {
    if (!fusion) return;
    EXPECT_TRUE(fusion->running()) << fusion->err();
    fusion->kill(SIGTERM);
    EXPECT_EQ(fusion->wait(), 0) << fusion->err();
  }
  /// Waits for the only verdict on a measurement.
  VerdictKind verdict_on(SourceKind source, std::uint64_t sequence) {
    EXPECT_TRUE(wait_until([&] { return !ear->of(source, sequence).empty(); }, 5.0))
        << to_string(source) << " " << sequence;
    const auto found = ear->of(source, sequence);
    EXPECT_EQ(found.size(), 1U);
    return found.empty() ? VerdictKind::used : found.front().kind;
  }

  std::vector<std::string> arguments;
  std::unique_ptr<StillVehicle> vehicle;
  std::unique_ptr<FusionEar> ear;
  std::unique_ptr<Process> fusion;
};

}  // namespace fathom::test
