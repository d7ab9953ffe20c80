#include "console/site.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/disk/regular_file.hpp"
#include "console/assets.hpp"

namespace fathom::console {
namespace {

constexpr std::size_t kMostTile = 16UL << 20U;  // far more than a picture of 512 x 512 pixels has

Answer json_answer(int status, const nlohmann::json& json) {
  Answer out;
  out.status = status;
  out.body = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return out;
}

Answer nothing_here() {
  return json_answer(404, {{"text", "There is nothing here."}});
}

bool fits(const Site::Route& route, const Request& request) {
  const std::string_view method = request.method == "HEAD" ? "GET" : std::string_view(request.method);
  if (route.method != method) return false;
  return route.path.ends_with('/') ? request.path.starts_with(route.path) : request.path == route.path;
}

/// The file of "/tiles/z/x/y.png" below the folder of tiles, e.g. "/12/3456/789.png". Digits only: nothing
/// that could lead out of it.
std::optional<std::string> tile_file(std::string_view path) {
  static constexpr std::array<std::size_t, 3> kMostDigits{2, 7, 7};
  static constexpr std::string_view kEnding = ".png";
  path.remove_prefix(std::min(path.size(), std::string_view("/tiles").size()));
  if (!path.ends_with(kEnding)) return std::nullopt;
  std::string_view rest = path.substr(0, path.size() - kEnding.size());
  for (const std::size_t most : kMostDigits) {
    if (!rest.starts_with('/')) return std::nullopt;
    rest.remove_prefix(1);
    const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
    if (digits == 0 || digits > most) return std::nullopt;
    rest.remove_prefix(digits);
  }
  if (!rest.empty()) return std::nullopt;
  return std::string(path);
}

}  // namespace

std::span<const Site::Route> Site::routes() {
  static constexpr std::array<Route, 5> kRoutes{{
      {"GET", "/api/session", "/api/session", Need::view, &Site::session},
      {"GET", "/api/live", "/api/live", Need::view, &Site::live},
      {"POST", "/api/order", "/api/order", Need::order, &Site::order},
      {"GET", "/tiles/", "/tiles/12/3456/789.png", Need::view, &Site::tile},
      {"GET", "/", "/js/main.js", Need::nothing, &Site::file},
  }};
  return kRoutes;
}

Site::Site(Options options, Hooks hooks, FanOut& events)
    : options_(std::move(options)), hooks_(std::move(hooks)), events_(events) {}

Answer Site::answer(const Request& request, const std::string& peer) const {
  try {
    return dispatched(request, peer);
  } catch (const std::exception&) {
    return refuse(500, "failed", "The console failed to answer.", peer);
  }
}

Answer Site::dispatched(const Request& request, const std::string& peer) const {
  const auto all = routes();
  const auto route =
      std::find_if(all.begin(), all.end(), [&](const Route& one) { return fits(one, request); });
  if (route == all.end()) return nothing_here();
  // A token that is wrong is refused wherever one counts, none only where one is needed.
  Identity who;
  if (route->need != Need::nothing) {
    who = options_.tokens.whois(request.bearer());
    if (!request.authorization.empty() && who.role == Role::nobody)
      return refuse(401, "wrong_token", "The token is not known here.", peer);
  }
  if (route->need == Need::view && options_.view_needs_token && who.role == Role::nobody)
    return refuse(401, "no_token", "This console shows itself only to those with a token.", peer);
  return (this->*route->answer)({request, who, peer});
}

Answer Site::refuse(int status, const char* reason, const char* text, const std::string& peer) const {
  hooks_.refused({status, reason}, peer);
  return json_answer(status, {{"text", text}});
}

Answer Site::session(const Asked& asked) const {
  return json_answer(200, {{"vehicle", options_.title},
                           {"name", asked.who.name},
                           {"role", to_string(asked.who.role)},
                           {"orders", options_.orders_enabled},
                           {"tiles", !options_.tiles_dir.empty()},
                           {"waypoints", nlohmann::json::parse(options_.waypoints_json, nullptr, false)}});
}

Answer Site::live(const Asked& asked) const {
  Answer out;
  out.type = "text/event-stream";
  if (asked.request.method == "HEAD") return out;
  // Whoever shows a token is counted by it, wherever from; all others by their address.
  const std::string viewer = asked.who.name.empty() ? "from " + asked.peer : "token " + asked.who.name;
  auto [client, refused] = events_.join(viewer);
  if (refused == FanOut::Refused::all_taken)
    return refuse(503, "too_many_clients", "Too many pages are open already.", asked.peer);
  if (refused == FanOut::Refused::viewer_has_enough)
    return refuse(429, "too_many_streams_of_one", "You have too many pages open already; close one.",
                  asked.peer);
  out.stream = std::move(client);
  // The queue exists before the snapshot is taken: between the two nothing is missed.
  out.body = "event: snapshot\ndata: " + hooks_.snapshot() + "\n\n";
  return out;
}

Answer Site::order(const Asked& asked) const {
  const OrderJudgement judgement = hooks_.order(asked.request.body, asked.who, asked.peer);
  nlohmann::json answer{{"text", judgement.text}, {"confirm", judgement.confirm}};
  if (!judgement.verdict.empty()) answer["verdict"] = judgement.verdict;
  return json_answer(judgement.status, answer);
}

Answer Site::tile(const Asked& asked) const {
  const auto file = tile_file(asked.request.path);
  if (!file || options_.tiles_dir.empty()) return nothing_here();
  auto bytes = read_regular_file(options_.tiles_dir + *file, kMostTile);
  if (!bytes) return nothing_here();
  Answer out;
  out.type = "image/png";
  out.cache = options_.view_needs_token ? "private, max-age=3600" : "max-age=3600";
  out.body = std::move(bytes.value());
  return out.body.empty() ? nothing_here() : out;
}

Answer Site::file(const Asked& asked) const {
  const Asset* asset = find_asset(asked.request.path);
  if (asset == nullptr) return nothing_here();
  Answer out;
  out.type = asset->type;
  out.etag = asset->etag;
  out.cache = "no-cache";  // asked for again, answered with 304 when it is the same
  if (asked.request.if_none_match.find(asset->etag) != std::string::npos) {
    out.status = 304;
  } else {
    out.asset = asset->bytes;
  }
  return out;
}

}  // namespace fathom::console
