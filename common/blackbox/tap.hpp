#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "blackbox/queue.hpp"
#include "bus/participant.hpp"

namespace fathom::blackbox {

/// Listens to every topic of the vehicle network and puts what comes into a queue: samples as they are on the
/// wire, one origin for each writer of a topic. Alarms that come and go and orders are events besides. Of
/// each service of this host whose life sign comes, the command line and the configuration file are enclosed,
/// and fusion's checkpoint.
class Tap {
 public:
  /// `topics`: empty: all but the engine's state, which permissions keep to fusion. A topic that cannot be
  /// listened to is left out; refused() says why. `clock` is the vehicle's. All outlive this. `host`: name of
  /// this host; `catalogue`: its folder of models of instruments.
  Tap(bus::Participant& participant, Queue& queue, const Clock& clock, const std::vector<std::string>& topics,
      std::string host, std::string catalogue);

  /// Listens to what others have begun to write and one of these patterns is: a topic, or its begin with *
  /// behind it. A line for each that cannot be listened to. Call it now and then, from one thread.
  [[nodiscard]] std::vector<std::string> look_around(const std::vector<std::string>& patterns);
  ~Tap();
  Tap(const Tap&) = delete;
  Tap& operator=(const Tap&) = delete;

  /// A line for each topic that is not listened to.
  [[nodiscard]] const std::vector<std::string>& refused() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::blackbox
