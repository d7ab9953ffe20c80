// What a source said last, once the source is silent.

#include "health/freshness.hpp"

#include <functional>

#include <gtest/gtest.h>

#include "health/vehicle_health.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

constexpr double kImuLimit_s = 2.0;   // of 100 Hz
constexpr double kGpsLimit_s = 30.0;  // as configured
constexpr double kServiceLimit_s = 3.0;

HealthConfig with_limits() {
  HealthConfig out;
  out.sensors = {{"imu", SourceKind::imu, 100.0},
                 {"gps", SourceKind::gps, 2.0, kGpsLimit_s},
                 {"usbl", SourceKind::usbl, 0.2}};
  out.services = {{"fusion", Severity::critical}, {"gps_bridge", Severity::warning}};
  out.service.missing_s = kServiceLimit_s;
  return out;
}

TEST(Freshness, IsTheLimitBeyondWhichASensorIsMissing) {
  const Freshness fresh(with_limits().sensors, with_limits().service);
  EXPECT_EQ(fresh.limit_s(SourceKind::imu, "imu"), kImuLimit_s);
  EXPECT_EQ(fresh.limit_s(SourceKind::gps, "gps"), kGpsLimit_s);
  EXPECT_EQ(fresh.limit_s(SourceKind::usbl, "usbl"), 50.0);
  EXPECT_EQ(fresh.limit_s(SourceKind::dvl, "gps"), 20.0) << "nobody expects it";
  const TimeNs heard_ns = at(10.0).monotonic_ns;
  EXPECT_TRUE(fresh.of_sensor(SourceKind::imu, "imu", heard_ns, at(11.9)));
  EXPECT_FALSE(fresh.of_sensor(SourceKind::imu, "imu", heard_ns, at(12.1)));
  EXPECT_TRUE(fresh.of_sensor(SourceKind::imu, "imu", heard_ns, at(19.9), 10.0));
  EXPECT_TRUE(fresh.of_service(heard_ns, at(12.9)));
  EXPECT_FALSE(fresh.of_service(heard_ns, at(13.1)));
}

/// A vehicle whose source speaks until 30 s and is silent then.
class ASilentSource : public ::testing::Test {
 protected:
  /// Whether the alarm stands while the source speaks, stays until `limit_s` of silence and goes then.
  void expect_held_for(double limit_s, const Name& alarm, const std::function<void(double)>& speak) {
    constexpr double kEnd_s = 30.0;
    int tick = 0;
    const auto until = [&](double end_s) {
      for (; 0.1 * tick < end_s; ++tick) {
        if (0.1 * tick <= kEnd_s) speak(0.1 * tick);
        health.evaluate(at(0.1 * tick));
      }
    };
    until(kEnd_s + limit_s - 0.5);
    EXPECT_TRUE(alarmed(health.alarms(), alarm)) << alarm.str();
    until(kEnd_s + limit_s + 5.0);  // some alarms stay a little longer, against flicker
    EXPECT_FALSE(alarmed(health.alarms(), alarm)) << alarm.str();
  }
  VehicleHealth health{with_limits(), at(0.0)};
};

TEST_F(ASilentSource, StampsNothingAheadOfTheClock) {
  expect_held_for(kImuLimit_s, "clock_ahead:imu",
                  [&](double t) { health.heard(SourceKind::imu, header("imu", t + 3.0), at(t)); });
}

TEST_F(ASilentSource, RepeatsNoFix) {
  expect_held_for(kGpsLimit_s, "gps_frozen:gps", [&](double t) {
    health.add(nav(t), at(t));
    GpsSample fix = gps(t);
    fix.latitude_rad = 0.6;
    health.add(fix, at(t));
  });
}

TEST_F(ASilentSource, IsNotJammed) {
  expect_held_for(kGpsLimit_s, "gps_jammed:gps", [&](double t) {
    GpsSample fix = gps(t);
    fix.jamming = GpsJamming::warning;
    health.add(fix, at(t));
  });
}

TEST_F(ASilentSource, IsNotDisputed) {
  expect_held_for(kGpsLimit_s, "gps_disputed:gps", [&](double t) {
    health.add(verdict(SourceKind::gps, VerdictKind::disputed, t, "gps"), at(t));
  });
}

TEST_F(ASilentSource, DisbelievesNoDevice) {
  std::uint64_t implausible = 0;
  expect_held_for(kServiceLimit_s, "device_clock:gps_bridge", [&](double t) {
    ServiceStatus status = life_sign("gps_bridge", t);
    status.counters.push_back({"time_implausible", ++implausible});
    health.add(status, at(t));
  });
}

TEST_F(ASilentSource, SaysNothingOfInstruments) {
  for (const auto& [condition, alarm] :
       {std::pair("implausible_dvl_unit", "implausible"), std::pair("noise_of_dvl", "noisy:dvl"),
        std::pair("bias_of_gyro_x", "biased:gyro_x")}) {
    health = VehicleHealth(with_limits(), at(0.0));
    expect_held_for(kServiceLimit_s, alarm, [&](double t) {
      AlignmentStatus status;
      status.header = header("fusion", t);
      status.phase = AlignmentPhase::aligned;
      status.condition_count = 1;
      status.conditions[0].name = condition;
      status.conditions[0].value = 2.0;
      status.conditions[0].limit = 1.0;
      health.add(status, at(t));
    });
  }
}

}  // namespace
}  // namespace fathom::health
