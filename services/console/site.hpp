#pragma once

#include <functional>
#include <memory>
#include <string>

#include "console/connection.hpp"
#include "console/fan_out.hpp"
#include "console/http_server.hpp"
#include "console/orders.hpp"
#include "console/request.hpp"
#include "console/roles.hpp"

namespace fathom::console {

/// What the console answers: the page's files, map tiles, live events, orders.
class Site {
 public:
  struct Options {
    std::string title;  ///< vehicle, for the page
    bool orders_enabled = false;
    bool view_needs_token = false;
    bool secure = false;         ///< answers go through TLS
    std::string tiles_dir;       ///< empty: none
    std::string waypoints_json;  ///< an array for the map
    TokenBook tokens;
  };
  struct Hooks {
    std::function<std::string()> snapshot;  ///< JSON of the history, any thread
    std::function<OrderJudgement(const std::string& body, const Identity& who, const std::string& peer)>
        order;
    std::function<void(const Refusal& refusal, const std::string& peer)> refused;
  };
  Site(Options options, Hooks hooks, FanOut& events);
  ~Site();
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// One request whose head and host were judged. False: the connection ends with it. Any thread.
  [[nodiscard]] bool serve(const RequestHead& head, const std::string& body, const std::string& peer,
                           Connection& connection);
  /// Live streams end; nothing is served from then on.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::console
