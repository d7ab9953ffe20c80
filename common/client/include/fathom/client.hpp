#pragma once

/// Navigation for guidance software, in a few lines:
///
///   #include <fathom/client.hpp>
///
///   fathom::Client navigation({.domain = 0, .vehicle = "auv"});
///   while (running) {
///     const auto health = navigation.health();
///     if (health.ok) steer(*navigation.latest());
///     else hold(health.reason);
///   }
///
/// People see on the operator console where it is going, if it says so when that changes:
///
///   navigation.publish_route({.active = 0, .waypoints = {{.name = "A", .latitude_rad = 0.63,
///                                                         .longitude_rad = 2.22}}});
///
/// Positions are WGS-84 in radians, velocities north-east-down in m/s, q_NB turns body (forward-right-down)
/// into north-east-down. Unknown values are NaN.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/time.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/nav_state.hpp"
#include "samples/position/fix.hpp"
#include "samples/status/health.hpp"
#include "samples/status/route.hpp"

namespace fathom {

#ifdef FATHOM_CLIENT_DDS_DIR
inline constexpr const char* kClientProfiles = FATHOM_CLIENT_DDS_DIR;
#else
inline constexpr const char* kClientProfiles = "";
#endif

/// What a navigation state has to fulfil for health().ok.
struct HealthLimits {
  double max_age_s = 0.5;              ///< since the state arrived
  double max_horizontal_95_m = 50.0;   ///< radius that holds the true position with 95 % probability
  double max_heading_sigma_rad = 0.1;  ///< one sigma
  bool need_aligned = true;            ///< the alignment phase must be `aligned`
};

/// How to take part in a protected vehicle network (DDS Security).
struct ClientSecurity {
  std::string
      folder{};  ///< credentials as `fathom keygen` makes; empty: $FATHOM_SECURITY_DIR, else not protected
  std::string identity = "guidance";  ///< whose credentials in the folder
};

struct ClientOptions {
  std::uint32_t domain = 0;
  std::string vehicle{};          ///< empty: the first vehicle heard, and only that one from then on
  std::string name = "guidance";  ///< how this program shows up on the vehicle network
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses bound, nothing else is
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  /// Folder of the QoS XML. Empty: $FATHOM_DDS_DIR, else the folder that was installed with the package.
  std::string profiles_dir{};
  ClientSecurity security{};
  HealthLimits limits{};
  /// For accelerated simulations; must outlive the client. None: the host's clock.
  const Clock* clock = nullptr;
  /// Filled in by the installed package.
  std::string package_profiles_dir = kClientProfiles;
  /// "address:port" of discovery servers, where the vehicle uses them; `peers` are not used then.
  std::vector<std::string> discovery_servers{};
};

/// Whether guidance may rely on the navigation state, and if not, why.
struct NavHealth {
  bool ok = false;
  bool heard = false;    ///< a state has been received at all
  bool fresh = false;    ///< not older than max_age_s
  bool usable = false;   ///< the mode gives a position, and position, velocity and attitude are finite
  bool aligned = false;  ///< phase `aligned`
  bool certain = false;  ///< within the limits of uncertainty
  NavMode mode = NavMode::none;
  double age_s = kUnknown;
  double horizontal_95_m = kUnknown;
  double heading_sigma_rad = kUnknown;
  std::string reason;  ///< empty when ok; else one English sentence about the first thing that is wrong
};

/// Judges a state by the limits; `age_s` since its arrival, NaN when there is none. Pure.
[[nodiscard]] NavHealth judge(const std::optional<NavState>& state, double age_s, const HealthLimits& limits);

/// There is nobody on the network who takes orders, or positions.
struct NobodyListens : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Receives the navigation state of one vehicle, and says what guidance makes of it. All functions may be
/// called from any thread, also from a callback.
class Client {
 public:
  using NavStateHandler = std::function<void(const NavState&)>;
  using AlarmHandler = std::function<void(const Alarm&)>;

  /// Joins the vehicle network. Throws std::runtime_error, naming what is missing.
  explicit Client(const ClientOptions& options = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// `handler` runs for every navigation state, on a thread of the client, one at a time: be quick. Replaces
  /// the handler before; an empty one ends the calls. No call to the old handler begins once this has
  /// returned, unless this is called from within a handler.
  ///
  /// header.sensor says which fusion service it is from: several may stand by for each other. What comes from
  /// one of them up to ten seconds behind newer states of another one is left out.
  void on_nav_state(NavStateHandler handler);
  /// Likewise for alarms of the monitor: raised, escalated, cleared, acknowledged, and every few seconds
  /// again.
  void on_alarm(AlarmHandler handler);

  /// The newest state, however old; nothing before the first one.
  [[nodiscard]] std::optional<NavState> latest() const;
  /// Seconds since a state with a new stamp last arrived, by a clock that no correction of UTC moves; NaN
  /// before the first one. In vehicle time where options.clock is accelerated.
  [[nodiscard]] double age_s() const;
  /// Waits until a state newer than the last one returned arrives, at most so long (host time).
  [[nodiscard]] std::optional<NavState> wait_next(double timeout_s);

  /// Shows people the waypoints that this program follows: at once, and again each second until the next
  /// call or the end of the client. May be called at any rate; what changed goes out ten times a second. The
  /// header is filled in here, with options.name as the publisher; a route without waypoints says that it
  /// follows nothing. Does not wait for the network. Throws std::invalid_argument for a route that nobody
  /// could draw, naming what is wrong and what was expected, and std::runtime_error when the network did not
  /// take the one before.
  void publish_route(Route route);

  /// Gives navigation an order as operators do: a position, a new alignment, a source on or off, an alarm
  /// acknowledged. The header is filled in here: by the vehicle's time, with options.name as who orders.
  /// Waits at most so long (host time) for somebody who takes orders. A position further away than navigation
  /// can believe is held by fusion until it is ordered once more with `confirmed`. Throws
  /// std::invalid_argument naming what was expected, NobodyListens, and std::runtime_error, also where this
  /// identity may not order on a protected network. Not from a callback.
  void order(const Command& command, double timeout_s = 5.0);
  /// Tells a position: navigation judges it like any other measurement. header.stamp_ns says when the vehicle
  /// was there, up to two hours ago, 0: now; header.sensor who says so, empty: options.name. As of order().
  void tell(const FixSample& fix, double timeout_s = 5.0);

  [[nodiscard]] NavHealth health() const;
  /// What alignment waits for and what would help; nothing before the first status.
  [[nodiscard]] std::optional<AlignmentStatus> alignment() const;
  /// The monitor's view; nothing before the first one.
  [[nodiscard]] std::optional<MonitorStatus> monitor() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom
