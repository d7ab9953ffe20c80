#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "console/http/answer.hpp"
#include "console/http/fan_out.hpp"
#include "console/http/request.hpp"
#include "console/orders/orders.hpp"
#include "console/orders/roles.hpp"

namespace fathom::console {

/// What the console answers: the page's files, map tiles, live events, orders. Who may have what stands in
/// the table of routes and is decided before a route is asked. No sockets. Any thread.
class Site {
 public:
  struct Options {
    std::string title;  ///< vehicle, for the page
    bool orders_enabled = false;
    bool view_needs_token = false;
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
  /// What somebody has to show for a route.
  enum class Need : std::uint8_t {
    nothing,  ///< it says nothing about the vehicle
    view,     ///< a token where `view_needs_token` is on
    order,    ///< the token of an operator
  };
  /// A request with who sent it.
  struct Asked {
    const Request& request;
    const Identity& who;
    const std::string& peer;
  };
  struct Route {
    std::string_view method;   ///< GET stands for HEAD as well
    std::string_view path;     ///< what ends in '/' takes everything below
    std::string_view example;  ///< a path that this route takes
    Need need;
    Answer (Site::*answer)(const Asked& asked) const;
  };
  /// The first that fits counts.
  [[nodiscard]] static std::span<const Route> routes();

  Site(Options options, Hooks hooks, FanOut& events);

  /// `peer`: the address it came from.
  [[nodiscard]] Answer answer(const Request& request, const std::string& peer) const;

 private:
  [[nodiscard]] Answer dispatched(const Request& request, const std::string& peer) const;
  [[nodiscard]] Answer refuse(int status, const char* reason, const char* text,
                              const std::string& peer) const;
  [[nodiscard]] Answer session(const Asked& asked) const;
  [[nodiscard]] Answer live(const Asked& asked) const;
  [[nodiscard]] Answer order(const Asked& asked) const;
  [[nodiscard]] Answer tile(const Asked& asked) const;
  [[nodiscard]] Answer file(const Asked& asked) const;

  Options options_;
  Hooks hooks_;
  FanOut& events_;
};

}  // namespace fathom::console
