// One fault a line, a whole vehicle around it, and exactly the alarms that it must raise.

#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "geo/wgs84.hpp"
#include "health/vehicle_health.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

using Alarms = std::set<std::string>;
constexpr double kSpeed_m_s = 2.0;
constexpr WriterGuid kBridge{1};
constexpr WriterGuid kBridgeRestarted{2};
constexpr WriterGuid kRogue{9};

/// A vehicle that goes north at 2 m/s; every stream with the age and the noise of a real one. A fault changes
/// what a fix says, or adds to it.
class FaultyVehicle {
 public:
  bool fusion_alive = true;
  bool fusion_refuses_gps = false;
  bool moored = false;
  bool water_layer = false;
  double host_clock_set_s = 0.0;
  WriterGuid writer = kBridge;
  std::uint32_t bridge_pid = 10;
  std::uint64_t bridge_time_steps = 0;
  std::uint64_t bridge_time_implausible = 0;
  std::function<void(GpsSample&, double t)> spoil;             ///< every fix before it is published
  std::function<void(const GpsSample&, const Instant&)> also;  ///< after it was

  VehicleHealth health{of_three_instruments(), at(0.0), [](const WriterGuid& id) {
                         return id == kRogue ? std::string("rogue (process 99 on host far)")
                                             : std::string("gps_bridge (process 10 on host near)");
                       }};

  /// What was raised since the last call.
  Alarms run_for(double seconds) {
    raised_.clear();
    for (const std::int64_t end = tick_ + std::llround(seconds * 100.0); tick_ < end; ++tick_) step();
    return raised_;
  }
  [[nodiscard]] Instant now() const { return at(0.01 * static_cast<double>(tick_)); }
  [[nodiscard]] std::string text(const Name& alarm) const {
    const Alarm* found = health.alarms().find(alarm);
    return found == nullptr ? std::string() : found->text;
  }
  [[nodiscard]] bool active(const Name& alarm) const {
    const Alarm* found = health.alarms().find(alarm);
    return found != nullptr && found->active;
  }

 private:
  /// A repeatable number in (-1, 1).
  double noise() {
    seed_ = seed_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(static_cast<std::int64_t>(seed_)) / 9.3e18;
  }

  GpsSample fix(double t, double speed_m_s) {
    const double age_s = 0.1 + 0.05 * noise();
    GpsSample sample = gps(t - age_s);
    const double error_m = moored ? 0.0 : 1.5;  // a receiver at rest may hold its position
    const geo::Geodetic where = geo::moved_by(
        {0.6, 2.2, 20.0}, {north_m_ - age_s * speed_m_s + error_m * noise(), error_m * noise(), 0});
    sample.latitude_rad = where.latitude_rad;
    sample.longitude_rad = where.longitude_rad;
    sample.velocity_N_m_s = {speed_m_s + 0.05 * noise(), 0.05 * noise(), 0.0};
    sample.position_sigma_N_m = {1.5, 1.5, 3.0};
    return sample;
  }

  void step() {
    const double t = 0.01 * static_cast<double>(tick_);
    const Instant now = this->now();
    const double speed_m_s = moored ? 0.0 : kSpeed_m_s;
    north_m_ += 0.01 * speed_m_s;
    health.heard(SourceKind::imu, header("imu", t), now, kBridge);
    if (fusion_alive) {
      NavState state = nav(t);
      state.velocity_N_m_s = {speed_m_s + 0.02 * noise(), 0.02 * noise(), 0.0};
      state.velocity_covariance_N_m2_s2 = {4e-4, 0, 0, 0, 4e-4, 0, 0, 0, 4e-4};
      health.add(state, now);
    }
    if (tick_ % 20 == 0) {
      DvlSample dvl;
      dvl.header = header("dvl", t - 0.05);
      dvl.velocity_D_m_s = {speed_m_s + 0.01 * noise(), 0.01 * noise(), 0.0};
      health.add(dvl, now, kBridge);
      if (water_layer) {
        dvl.mode = DvlMode::water;
        health.add(dvl, now, kBridge);
      }
    }
    if (tick_ % 50 == 0) {
      GpsSample sample = fix(t, speed_m_s);
      if (spoil) spoil(sample, t);
      health.add(sample, now, writer);
      if (fusion_alive) {
        health.add(verdict(SourceKind::gps, fusion_refuses_gps ? VerdictKind::rejected : VerdictKind::used, t,
                           "gps"),
                   now);
      }
      if (also) also(sample, now);
    }
    if (tick_ % 100 == 0) {
      if (fusion_alive) health.add(life_sign("fusion", t), now);
      ServiceStatus bridge = life_sign("gps_bridge", t, ServiceState::healthy, bridge_pid);
      bridge.utc_offset_ns = from_seconds(host_clock_set_s);
      if (bridge_time_steps > 0) bridge.counters.push_back({"time_steps", bridge_time_steps});
      if (bridge_time_implausible > 0)
        bridge.counters.push_back({"time_implausible", bridge_time_implausible++});
      health.add(bridge, now);
    }
    if (tick_ % 5 != 0) return;
    health.evaluate(now);
    for (const auto& [event, alarm] : health.take_transitions()) {
      if (!alarm.active) {
        active_.erase(alarm.alarm);
      } else if (active_.insert(alarm.alarm).second) {
        raised_.insert(alarm.alarm.str());  // what becomes more severe is not raised anew
      }
    }
  }

  Alarms raised_;
  std::set<Name> active_;
  std::int64_t tick_ = 0;
  double north_m_ = 0.0;
  std::uint64_t seed_ = 1;
};

class FaultMatrix : public ::testing::Test {
 protected:
  FaultMatrix() { EXPECT_EQ(vehicle.run_for(30.0), Alarms{}); }
  FaultyVehicle vehicle;
};

TEST_F(FaultMatrix, CleanHour) {
  EXPECT_EQ(vehicle.run_for(3600.0), Alarms{});
}

TEST_F(FaultMatrix, CleanAtItsMooring) {
  vehicle.moored = true;
  EXPECT_EQ(vehicle.run_for(600.0), Alarms{}) << "a receiver at rest may repeat its position";
}

TEST_F(FaultMatrix, NoFix) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.fix = GpsFix::none; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_outage"});
}

TEST_F(FaultMatrix, FusionDead) {
  vehicle.fusion_alive = false;
  EXPECT_EQ(vehicle.run_for(20.0), (Alarms{"nav_state_missing", "service_missing:fusion"}));
  vehicle.spoil = [](GpsSample& fix, double) { fix.fix = GpsFix::none; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_outage"});
}

/// The same place with stamps that go on and every figure of a good fix.
struct Frozen {
  bool velocity_too = false;
  std::optional<GpsSample> first{};
  void operator()(GpsSample& fix, double) {
    if (!first) first = fix;
    fix.latitude_rad = first->latitude_rad;
    fix.longitude_rad = first->longitude_rad;
    fix.altitude_m = first->altitude_m;
    fix.velocity_N_m_s = velocity_too ? first->velocity_N_m_s : std::array<double, 3>{0.0, 0.0, 0.0};
  }
};

TEST_F(FaultMatrix, FrozenFixWithFullHealth) {
  vehicle.spoil = Frozen{};
  EXPECT_EQ(vehicle.run_for(9.0), (Alarms{"gps_frozen:gps", "gps_outage"}));
  EXPECT_NEAR(vehicle.health.status(vehicle.now()).gps_outage_s, 9.0, 1.0)
      << "since the first of the frozen ones";
  vehicle.spoil = nullptr;
  vehicle.run_for(10.0);
  EXPECT_FALSE(vehicle.active("gps_frozen:gps"));
  EXPECT_FALSE(vehicle.active("gps_outage"));
}

TEST_F(FaultMatrix, FrozenFixThatClaimsToMove) {
  vehicle.fusion_alive = false;
  vehicle.run_for(20.0);
  vehicle.spoil = Frozen{true};
  EXPECT_EQ(vehicle.run_for(9.0), (Alarms{"gps_frozen:gps", "gps_outage"}));
}

TEST_F(FaultMatrix, FrozenFixWhileFusionIsDead) {
  vehicle.fusion_alive = false;
  vehicle.run_for(20.0);
  vehicle.spoil = Frozen{};
  EXPECT_EQ(vehicle.run_for(9.0), (Alarms{"gps_frozen:gps", "gps_outage"})) << "the DVL says that it moves";
}

TEST_F(FaultMatrix, AReceiverThatReportsJamming) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.jamming = GpsJamming::warning; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_jammed:gps"}) << "as long as there are fixes they count";
  vehicle.spoil = [](GpsSample& fix, double) {
    fix.jamming = GpsJamming::critical;
    fix.fix = GpsFix::none;
  };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_outage"});
  EXPECT_NE(vehicle.text("gps_jammed:gps").find("leaves it no fix"), std::string::npos);
  vehicle.spoil = [](GpsSample& fix, double) { fix.jamming = GpsJamming::none; };
  vehicle.run_for(20.0);
  EXPECT_FALSE(vehicle.active("gps_jammed:gps"));
}

TEST_F(FaultMatrix, AReceiverThatReportsSpoofing) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.spoofing = GpsSpoofing::indicated; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_spoofed:gps"}) << "a sign is no proof: its fixes count";
  vehicle.spoil = [](GpsSample& fix, double) { fix.spoofing = GpsSpoofing::affirmed; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_outage"});
  EXPECT_EQ(vehicle.health.alarms().find("gps_spoofed:gps")->severity, Severity::critical);
  vehicle.spoil = nullptr;
  vehicle.run_for(20.0);
  EXPECT_FALSE(vehicle.active("gps_spoofed:gps"));
  EXPECT_FALSE(vehicle.active("gps_outage"));
}

TEST_F(FaultMatrix, EveryFixTwice) {
  vehicle.also = [this](const GpsSample& fix, const Instant& now) { vehicle.health.add(fix, now, kBridge); };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"duplicate_stamps:gps"});
  vehicle.also = nullptr;
  vehicle.run_for(15.0);
  EXPECT_FALSE(vehicle.active("duplicate_stamps:gps"));
}

TEST_F(FaultMatrix, AWaterLayerBesideTheBottomIsNoSecondPing) {
  vehicle.water_layer = true;
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{});
}

TEST_F(FaultMatrix, OneFixForEver) {
  std::optional<GpsSample> first;
  vehicle.spoil = [&first](GpsSample& fix, double) { fix = first ? *first : *(first = fix); };
  EXPECT_EQ(vehicle.run_for(10.0), (Alarms{"duplicate_stamps:gps", "gps_outage"}));
}

TEST_F(FaultMatrix, SecondWriterThatAgrees) {
  vehicle.also = [this](GpsSample fix, const Instant& now) {
    fix.header.stamp_ns += 1;
    vehicle.health.add(fix, now, kRogue);
  };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"second_writer:gps"});
  EXPECT_NE(
      vehicle.text("second_writer:gps").find("gps_bridge (process 10 on host near) and rogue (process 99"),
      std::string::npos)
      << vehicle.text("second_writer:gps");
  vehicle.also = nullptr;
  vehicle.run_for(40.0);
  EXPECT_FALSE(vehicle.active("second_writer:gps"));
}

TEST_F(FaultMatrix, SecondWriterSomewhereElse) {
  vehicle.also = [this](GpsSample fix, const Instant& now) {
    fix.header.stamp_ns += 20 * kNsPerMillisecond;
    fix.latitude_rad += 130.0 / 6.37e6;
    vehicle.health.add(fix, now, kRogue);
  };
  EXPECT_EQ(vehicle.run_for(20.0), (Alarms{"gps_disagrees:gps", "second_writer:gps"}));
}

TEST_F(FaultMatrix, SecondSensorThatNobodyExpects) {
  vehicle.also = [this](GpsSample fix, const Instant& now) {
    fix.header.sensor = "gps_x";
    vehicle.health.add(fix, now, kRogue);
  };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"second_writer:gps_x"});
  EXPECT_NE(vehicle.text("second_writer:gps_x").find("rogue (process 99 on host far)"), std::string::npos);
}

TEST_F(FaultMatrix, ABridgeThatWasRestartedIsNoSecondWriter) {
  vehicle.writer = kBridgeRestarted;
  vehicle.bridge_pid = 11;
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"service_restarted:gps_bridge"});
}

TEST_F(FaultMatrix, DeviceClockSetBack) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.header.stamp_ns -= 3 * kNsPerSecond; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"clock_jump:gps"});
  EXPECT_NEAR(vehicle.health.alarms().find("clock_jump:gps")->value, -3.0, 0.2);
}

TEST_F(FaultMatrix, DeviceClockSetForward) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.header.stamp_ns += 3 * kNsPerSecond; };
  EXPECT_EQ(vehicle.run_for(20.0), (Alarms{"clock_ahead:gps", "clock_jump:gps"}));
  EXPECT_NEAR(vehicle.health.alarms().find("clock_jump:gps")->value, 3.0, 0.2);
}

TEST_F(FaultMatrix, OneDamagedStampIsNoJump) {
  vehicle.spoil = [](GpsSample& fix, double t) {
    if (std::fmod(t, 5.0) < 0.01) fix.header.stamp_ns -= 4 * kNsPerSecond;
  };
  EXPECT_EQ(vehicle.run_for(60.0), Alarms{});
}

TEST_F(FaultMatrix, ABridgeThatSawItsDeviceClockJump) {
  vehicle.bridge_time_steps = 1;
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"device_clock:gps_bridge"});
}

TEST_F(FaultMatrix, ADeviceTimeThatCannotBe) {
  vehicle.bridge_time_implausible = 1;
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"device_clock:gps_bridge"});
}

TEST_F(FaultMatrix, TheHostClockIsSet) {
  vehicle.host_clock_set_s = 3600.0;
  EXPECT_EQ(vehicle.run_for(60.0), Alarms{"clock_step"});
}

TEST_F(FaultMatrix, FixesDraggedAwayWhileTheirVelocityStaysHonest) {
  const double began_s = to_seconds(vehicle.now().monotonic_ns - kBoot);
  vehicle.spoil = [began_s](GpsSample& fix, double t) { fix.longitude_rad += 5.0 * (t - began_s) / 5.3e6; };
  EXPECT_EQ(vehicle.run_for(30.0), Alarms{"gps_disagrees:gps"});
  EXPECT_NE(vehicle.text("gps_disagrees:gps").find("its own velocity"), std::string::npos);
}

TEST_F(FaultMatrix, FixesThatJumpWithoutAnyVelocity) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.velocity_N_m_s = {kUnknown, kUnknown, kUnknown}; };
  EXPECT_EQ(vehicle.run_for(30.0), Alarms{});
  vehicle.spoil = [](GpsSample& fix, double) {
    fix.velocity_N_m_s = {kUnknown, kUnknown, kUnknown};
    fix.latitude_rad += 130.0 / 6.37e6;
  };
  EXPECT_EQ(vehicle.run_for(30.0), Alarms{"gps_disagrees:gps"});
  EXPECT_NE(vehicle.text("gps_disagrees:gps").find("the navigation state"), std::string::npos);
  EXPECT_FALSE(vehicle.active("gps_disagrees:gps")) << "they move with the vehicle again";
}

TEST_F(FaultMatrix, FixesThatMoveAgainstTheVehicleWithAVelocityToMatch) {
  const double began_s = to_seconds(vehicle.now().monotonic_ns - kBoot);
  vehicle.spoil = [began_s](GpsSample& fix, double t) {
    fix.longitude_rad += 5.0 * (t - began_s) / (6.38e6 * std::cos(0.6));
    fix.velocity_N_m_s[1] += 5.0;
  };
  EXPECT_EQ(vehicle.run_for(30.0), Alarms{"gps_disagrees:gps"});
  EXPECT_NE(vehicle.text("gps_disagrees:gps").find("the navigation state"), std::string::npos);
}

TEST_F(FaultMatrix, OneWildFixIsFusionsToRefuse) {
  vehicle.spoil = [](GpsSample& fix, double t) {
    if (std::fmod(t, 20.0) < 0.01) fix.latitude_rad += 300.0 / 6.37e6;
  };
  EXPECT_EQ(vehicle.run_for(100.0), Alarms{});
}

TEST_F(FaultMatrix, FixesAfterAnOutageSomewhereElseAreNotJudgedByDisplacement) {
  vehicle.spoil = [](GpsSample& fix, double) { fix.fix = GpsFix::none; };
  EXPECT_EQ(vehicle.run_for(20.0), Alarms{"gps_outage"});
  vehicle.spoil = [](GpsSample& fix, double) { fix.latitude_rad += 700.0 / 6.37e6; };
  vehicle.fusion_refuses_gps = true;
  EXPECT_EQ(vehicle.run_for(15.0), Alarms{"refused:gps"});
  EXPECT_TRUE(vehicle.active("gps_outage")) << "fixes that fusion refuses do not end it";
}

}  // namespace
}  // namespace fathom::health
