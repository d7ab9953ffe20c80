#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/clock.hpp"
#include "base/name.hpp"
#include "bus/participant.hpp"
#include "samples/status/route.hpp"

namespace fathom {

/// Publishes one program's route: after each change, but ten times a second at most, and once a second
/// without a change. Its thread starts with the first route. All functions may be called from any thread.
class RoutePublisher {
 public:
  /// `vehicle` gives the vehicle's name, empty while it is unknown. Routes wait until it is known.
  RoutePublisher(bus::Participant& participant, const Clock& clock, std::string name,
                 std::function<Name()> vehicle)
      : participant_(participant), clock_(clock), name_(std::move(name)), vehicle_(std::move(vehicle)) {}
  ~RoutePublisher();
  RoutePublisher(const RoutePublisher&) = delete;
  RoutePublisher& operator=(const RoutePublisher&) = delete;

  /// Never blocks on the network. Throws std::invalid_argument for a route with a fault, and
  /// std::runtime_error when the network did not take the route before it.
  void publish(Route route);

 private:
  void run();

  bus::Participant& participant_;
  const Clock& clock_;
  std::string name_;
  std::function<Name()> vehicle_;
  std::mutex mutex_;  ///< of all that follows
  std::condition_variable changed_;
  std::optional<Route> route_;
  bool fresh_ = false;  ///< differs from the published one
  bool stopping_ = false;
  std::string trouble_;  ///< why publishing failed; thrown at the next call
  std::thread thread_;
};

}  // namespace fathom
