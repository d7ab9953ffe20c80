// Publishes a navigation state at 50 Hz until it is ended. Usage: client_publisher DOMAIN PROFILES_DIR
#include <chrono>
#include <cstdlib>
#include <numbers>
#include <thread>

#include "base/clock.hpp"
#include "bus/writer.hpp"
#include "samples/nav_state.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  if (argc != 3) return 2;
  bus::ParticipantOptions options;
  options.name = "client_publisher";
  options.domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
  options.profiles_dir = argv[2];
  bus::Participant participant(options);
  bus::Writer<NavState> writer(participant);
  const SystemClock clock;
  NavState state;
  state.header.vehicle = "auv";
  state.header.sensor = "fusion";
  state.mode = NavMode::dead_reckoning;
  state.alignment = AlignmentPhase::aligned;
  state.latitude_rad = 36.4 * std::numbers::pi / 180.0;
  state.longitude_rad = 127.4 * std::numbers::pi / 180.0;
  state.altitude_m = 18.5;
  state.velocity_N_m_s = {1.0, 0.0, 0.0};
  state.q_NB = {1.0, 0.0, 0.0, 0.0};
  state.position_covariance_N_m2 = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  state.rpy_sigma_rad = {0.001, 0.001, 0.01};
  for (;;) {
    state.header.stamp_ns = clock.utc_ns();
    ++state.header.sequence;
    writer.write(state);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}
