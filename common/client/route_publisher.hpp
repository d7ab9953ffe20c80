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

/// Keeps the vehicle network told of one program's route: on change, but ten times a second at most, and once
/// a second, on a thread of its own that starts with the first route. All functions from any thread.
class RoutePublisher {
 public:
  /// `vehicle` gives the vehicle's name, empty while it is not known; routes wait until it is.
  RoutePublisher(bus::Participant& participant, const Clock& clock, std::string name,
                 std::function<Name()> vehicle)
      : participant_(participant), clock_(clock), name_(std::move(name)), vehicle_(std::move(vehicle)) {}
  ~RoutePublisher();
  RoutePublisher(const RoutePublisher&) = delete;
  RoutePublisher& operator=(const RoutePublisher&) = delete;

  /// Never blocks on the network. Throws std::invalid_argument for a route with a fault, and
  /// std::runtime_error when the network would not take the one before.
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
  bool fresh_ = false;  ///< another one than published
  bool stopping_ = false;
  std::string trouble_;  ///< why publishing failed; told to the next caller
  std::thread thread_;
};

}  // namespace fathom
