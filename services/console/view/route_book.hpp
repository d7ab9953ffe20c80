#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "health/instant.hpp"
#include "samples/status/route.hpp"

namespace fathom::console {

/// A route for the map, with its age.
struct RouteLine {
  Route route;
  double age_s = kUnknown;  ///< since it was last said, by the console's own clock
  bool old = false;         ///< not refreshed any more, or its publisher is gone
};

/// The routes of everybody who guides one vehicle. Pure: times are arguments. Memory is bounded whatever
/// comes from the network. Not thread-safe.
class RouteBook {
 public:
  static constexpr std::size_t kMostRoutes = 16;
  /// Three of a publisher's periods, as the deadline of the topic.
  static constexpr double kOldS = 3.0;
  /// A route this old is of no use to anybody.
  static constexpr double kForgottenS = 600.0;

  /// Why a route was refused besides RouteFault, in `refused`.
  static constexpr std::size_t kTooMany = kRouteFaults;

  /// Takes over a route or refuses it; the sentence says why, and nothing is said about a good one.
  [[nodiscard]] std::optional<std::string> add(const Route& route, const health::Instant& at);

  /// What changed so that it should be shown at once, since the last call.
  [[nodiscard]] bool take_changed();
  /// Everything that is followed, by name. An empty route is not followed.
  [[nodiscard]] std::vector<RouteLine> lines(const health::Instant& at);

  /// Refused since start: by RouteFault, then kTooMany.
  [[nodiscard]] const std::array<std::uint64_t, kRouteFaults + 1>& refused() const { return refused_; }
  /// The word of an index of refused().
  [[nodiscard]] static std::string_view word(std::size_t index);

 private:
  struct Heard {
    Route route;
    TimeNs at_ns = 0;  ///< monotonic
  };
  void forget(TimeNs monotonic_ns);

  std::map<Name, Heard> routes_;
  std::array<std::uint64_t, kRouteFaults + 1> refused_{};
  bool changed_ = false;
};

}  // namespace fathom::console
