#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace fathom::sim {

/// A span of the run, seconds since its start: [from_s, to_s).
struct Window {
  double from_s = 0.0;
  double to_s = 0.0;
};

[[nodiscard]] inline bool inside(const std::vector<Window>& windows, double t_s) {
  return std::any_of(windows.begin(), windows.end(),
                     [t_s](const Window& window) { return t_s >= window.from_s && t_s < window.to_s; });
}

/// Where the device bytes of a sensor leave the simulator.
struct LinkConfig {
  enum class Type { pty, tcp_server, udp };
  Type type = Type::udp;
  std::string path;                   ///< pty: name of the link below the simulator's link_dir
  std::string address = "127.0.0.1";  ///< tcp_server: bound; udp: sent to
  int port = 0;
  bool operator==(const LinkConfig&) const = default;
};

/// What every sensor has.
struct SensorCommon {
  static constexpr bool kAlwaysHeard = false;  ///< a monitor may expect it wherever the vehicle is
  static constexpr bool kTalksOn = false;      ///< in dropouts it sends that it has nothing
  bool enabled = false;
  std::string protocol;  ///< of the device bytes; empty: the sensor has no device output
  LinkConfig link;
  double rate_hz = 1.0;
  double phase_s = 0.0;                            ///< of the first sample
  double latency_s = 0.0;                          ///< from validity to the last byte sent
  double stamp_late_s = 0.0;                       ///< its stamp is later than validity by this
  double jitter_s = 0.0;                           ///< uniform, on top of the latency
  double dropout_probability = 0.0;                ///< per sample
  double outlier_probability = 0.0;                ///< per sample
  std::vector<Window> dropouts;                    ///< nothing usable in these spans
  std::array<double, 3> lever_B_m{0.0, 0.0, 0.0};  ///< sensor relative to the body origin
};

/// A simulated instrument of a kind: what it measures how well, and where its bytes go. Of each kind in
/// sensors/, with kDescription; beside it stand the error model and the device.
template <class Sample>
struct SimulatedSensor;

}  // namespace fathom::sim
