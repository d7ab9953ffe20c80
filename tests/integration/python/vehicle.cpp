// A vehicle whose every value is known, for programs in Python. Usage: python_vehicle DOMAIN PROFILES_DIR
// Tells on its output the routes, orders and positions that it hears, and does what the lines of its input
// say until they end: `states on`, `states off` (at 50 Hz), `statuses` (of alignment and monitor, and an
// alarm, once).
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/nav_state.hpp"
#include "samples/position/fix.hpp"
#include "samples/status/health.hpp"
#include "samples/status/route.hpp"

namespace fathom {
namespace {

SampleHeader header(const Name& sensor, TimeNs now_ns, std::uint64_t sequence) {
  return {"auv", sensor, now_ns, now_ns + 1234, sequence};
}

// client_test.py holds what arrives against the same figures.
NavState state(TimeNs now_ns, std::uint64_t sequence) {
  NavState out;
  out.header = header("fusion", now_ns, sequence);
  out.mode = NavMode::dead_reckoning;
  out.alignment = AlignmentPhase::aligned;
  out.latitude_rad = 0.635;
  out.longitude_rad = 2.2235;
  out.altitude_m = 18.5;
  out.depth_m = 2.25;
  out.altitude_above_bottom_m = 31.5;
  out.velocity_N_m_s = {1.5, -0.5, 0.125};
  out.q_NB = {0.965925826289068, 0.0, 0.0, 0.258819045102521};
  out.rpy_rad = {0.01, -0.02, 0.523598775598299};
  out.angular_rate_B_rad_s = {0.001, 0.002, 0.003};
  out.specific_force_B_m_s2 = {0.1, 0.2, -9.8};
  out.position_covariance_N_m2 = {1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 4.0};
  out.velocity_covariance_N_m2_s2 = {0.01, 0.001, 0.002, 0.001, 0.02, 0.003, 0.002, 0.003, 0.04};
  out.rpy_sigma_rad = {0.001, 0.002, 0.01};
  out.gps_outage_s = 61.5;
  out.reset_counter = 7;
  out.last_reset_delta_N_m = {0.5, -0.25, 0.0};
  return out;
}

AlignmentStatus alignment(TimeNs now_ns) {
  AlignmentStatus out;
  out.header = header("fusion", now_ns, 1);
  out.phase = AlignmentPhase::coarse;
  out.in_phase_s = 12.5;
  out.condition_count = 2;
  out.conditions[0] = {"pitch_rad", 0.02, 0.05, 3.0, 5.0, false};
  out.conditions[1] = {"speed_m_s", 0.75, 1.0, 6.0, 5.0, true};
  out.rpy_sigma_rad = {0.01, 0.02, 0.3};
  out.time_to_aligned_s = 40.0;
  const std::string advice = "Go straight ahead.";
  std::copy(advice.begin(), advice.end(), out.advice.begin());
  return out;
}

MonitorStatus monitor(TimeNs now_ns) {
  MonitorStatus out;
  out.header = header("monitor", now_ns, 1);
  out.known = true;
  out.mode = NavMode::inertial;
  out.alignment = AlignmentPhase::fine;
  out.nav_state_age_s = 0.25;
  out.gps_outage_active = true;
  out.gps_outage_severity = Severity::critical;
  out.gps_outage_since_ns = 1'700'000'000'123'456'789;
  out.gps_outage_s = 61.5;
  out.gps_outage_longest_s = 70.0;
  out.gps_outage_total_s = 131.5;
  out.gps_outage_count = 2;
  out.alarms_active = 3;
  out.alarms_unacknowledged = 1;
  out.sensors = {{"gps0", Presence::stale, 61.5, 0.0}, {"imu", Presence::present, 0.01, 100.0}};
  out.services = {{"fusion", Presence::present, 0.5, 1.0}};
  out.receivers = {{"gps0", true, Severity::warning, 1'700'000'000'000'000'000, 61.5, 70.0, 131.5, 2}};
  return out;
}

Alarm alarm(TimeNs now_ns) {
  Alarm out;
  out.header = header("", now_ns, 1);
  out.alarm = "gps_outage";
  out.severity = Severity::warning;
  out.active = true;
  out.since_ns = 1'700'000'000'123'456'789;
  out.text = "No GPS for 61.5 s – 한국어.";
  out.value = 61.5;
  out.limit = 30.0;
  return out;
}

void tell(const Route& route, const bus::SampleInfo&) {
  std::printf("route %s %s %u %u %u", route.header.vehicle.c_str(), route.header.sensor.c_str(), route.active,
              route.repeats ? 1U : 0U, route.mission_count);
  for (const RouteWaypoint& point : route.waypoints) {
    std::printf(" %s %.17g %.17g %g %g", point.name.c_str(), point.latitude_rad, point.longitude_rad,
                point.depth_m, point.speed_m_s);
  }
  std::puts("");
  std::fflush(stdout);
}

void tell_order(const Command& order, const bus::SampleInfo&) {
  std::printf("order %s %s %s %s %.17g %.17g %g %g %d\n", order.header.vehicle.c_str(),
              order.header.sensor.c_str(), std::string(to_string(order.kind)).c_str(),
              order.target.empty() ? "-" : order.target.c_str(), order.latitude_rad, order.longitude_rad,
              order.depth_m, order.sigma_m, order.confirmed ? 1 : 0);
  std::fflush(stdout);
}

void tell_fix(const FixSample& fix, const bus::SampleInfo&) {
  std::printf("fix %s %s %.17g %.17g %g %g %.0f\n", fix.header.vehicle.c_str(), fix.header.sensor.c_str(),
              fix.latitude_rad, fix.longitude_rad, fix.sigma_m, fix.depth_m,
              to_seconds(fix.header.received_ns - fix.header.stamp_ns));
  std::fflush(stdout);
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) {
  using namespace fathom;
  if (argc != 3) return 2;
  bus::ParticipantOptions options;
  options.name = "python_vehicle";
  options.domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
  options.profiles_dir = argv[2];
  bus::Participant participant(options);
  bus::Writer<NavState> states(participant);
  bus::Writer<AlignmentStatus> alignments(participant);
  bus::Writer<MonitorStatus> monitors(participant);
  bus::Writer<Alarm> alarms(participant);
  const bus::Reader<Route> routes(participant, tell);
  const bus::Reader<Command> orders(participant, tell_order);
  const bus::Reader<FixSample> fixes(participant, tell_fix);
  const SystemClock clock;

  std::atomic<bool> speaking{false};
  std::atomic<bool> ending{false};
  std::thread speaker([&] {
    std::uint64_t sequence = 0;
    while (!ending) {
      if (speaking) states.write(state(clock.utc_ns(), ++sequence));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "states on") speaking = true;
    if (line == "states off") speaking = false;
    if (line == "statuses") {
      alignments.write(alignment(clock.utc_ns()));
      monitors.write(monitor(clock.utc_ns()));
      alarms.write(alarm(clock.utc_ns()));
    }
  }
  ending = true;
  speaker.join();
}
