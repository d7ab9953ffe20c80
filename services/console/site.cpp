#include "console/site.hpp"

#include <charconv>
#include <fstream>
#include <sstream>

#include <httplib.h>
#include <nlohmann/json.hpp>

#include "console/assets.hpp"

namespace fathom::console {
namespace {

using namespace std::chrono_literals;
// A stream that takes nothing for this long is given up; its browser asks again when it is back.
constexpr auto kWritePatience = 15s;
constexpr auto kStreamPatience = 1s;

/// A request that was read already, and the way back to its sender.
class JudgedStream : public httplib::Stream {
 public:
  JudgedStream(std::string request, std::string peer, Connection& connection)
      : request_(std::move(request)), peer_(std::move(peer)), connection_(connection) {}
  [[nodiscard]] bool is_readable() const override { return at_ < request_.size(); }
  [[nodiscard]] bool is_writable() const override { return !broken_; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = std::min(size, request_.size() - at_);
    request_.copy(to, count, at_);
    at_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    broken_ = broken_ || !connection_.write({from, size}, kWritePatience);
    return broken_ ? -1 : static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip = peer_;
    port = 0;
  }
  void get_local_ip_and_port(std::string&, int&) const override {}
  [[nodiscard]] socket_t socket() const override { return INVALID_SOCKET; }

 private:
  std::string request_;
  std::string peer_;
  Connection& connection_;
  std::size_t at_ = 0;
  bool broken_ = false;
};

/// The library's routing and answers without its sockets: connections are accepted, limited and read
/// elsewhere.
class Router : public httplib::Server {
 public:
  Router() { svr_sock_ = 0; }  // any number but INVALID_SOCKET: streams go on until close()
  void close() { svr_sock_ = INVALID_SOCKET; }
  bool process(httplib::Stream& stream, bool keep_alive) {
    bool closed = false;
    return process_request(stream, !keep_alive, closed, nullptr) && !closed && keep_alive;
  }
};

/// What the library is given of a request: nothing that it could act upon without our knowing.
std::string rebuilt(const RequestHead& head, const std::string& body) {
  std::string out = head.method + " " + head.path + " HTTP/1.1\r\n";
  for (const char* name : {"host", "authorization", "if-none-match"}) {
    if (const auto value = head.header(name); !value.empty())
      out.append(name).append(": ").append(value).append("\r\n");
  }
  if (head.method == "POST") {
    out += "content-type: application/json\r\ncontent-length: " + std::to_string(body.size()) + "\r\n";
  }
  return out + "\r\n" + body;
}

std::string_view bearer_of(const httplib::Request& request, std::string& keep) {
  static constexpr std::string_view kScheme = "Bearer ";
  keep = request.get_header_value("authorization");
  if (keep.size() <= kScheme.size()) return {};
  return std::string_view(keep).substr(kScheme.size());
}

void put_json(httplib::Response& response, int status, const nlohmann::json& json) {
  response.status = status;
  response.set_content(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
                       "application/json");
}

}  // namespace

struct Site::Impl {
  Impl(Options options_in, Hooks hooks_in, FanOut& events_in)
      : options(std::move(options_in)), hooks(std::move(hooks_in)), events(events_in) {
    httplib::Headers headers;
    for (const auto& [name, value] : kSecurityHeaders) headers.emplace(name, value);
    if (options.secure) headers.emplace(kStrictTransport.first, kStrictTransport.second);
    router.set_default_headers(std::move(headers));
    router.set_payload_max_length(kMostBodyBytes);
    router.set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
          put_json(response, 500, {{"text", "The console failed to answer."}});
        });
    router.Get("/api/session", [this](const auto& request, auto& response) { session(request, response); });
    router.Get("/api/live", [this](const auto& request, auto& response) { live(request, response); });
    router.Post("/api/order", [this](const auto& request, auto& response) { order(request, response); });
    router.Get(R"(/tiles/(\d{1,2})/(\d{1,7})/(\d{1,7})\.png)",
               [this](const auto& request, auto& response) { tile(request, response); });
    router.Get("/.*", [](const auto& request, auto& response) { file(request, response); });
    // Whatever no route takes, a POST elsewhere above all.
    router.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty()) put_json(response, response.status, {{"text", "There is nothing here."}});
      response.set_header("Cache-Control", "no-store");
    });
  }

  void refuse(int status, const char* reason, const char* text, const httplib::Request& request,
              httplib::Response& response) {
    hooks.refused({status, reason}, request.remote_addr);
    put_json(response, status, {{"text", text}});
  }

  /// False when it was refused: a token that is wrong is refused everywhere, none only where one is needed.
  bool admit(const httplib::Request& request, httplib::Response& response, Identity& who) {
    response.set_header("Cache-Control", "no-store");
    std::string keep;
    const std::string_view token = bearer_of(request, keep);
    who = options.tokens.whois(token);
    if (!keep.empty() && who.role == Role::nobody) {
      refuse(401, "wrong_token", "The token is not known here.", request, response);
      return false;
    }
    return true;
  }
  bool admit_viewer(const httplib::Request& request, httplib::Response& response, Identity& who) {
    if (!admit(request, response, who)) return false;
    if (!options.view_needs_token || who.role != Role::nobody) return true;
    refuse(401, "no_token", "This console shows itself only to those with a token.", request, response);
    return false;
  }

  void session(const httplib::Request& request, httplib::Response& response) {
    Identity who;
    if (!admit_viewer(request, response, who)) return;
    put_json(response, 200,
             {{"vehicle", options.title},
              {"name", who.name},
              {"role", to_string(who.role)},
              {"orders", options.orders_enabled},
              {"tiles", !options.tiles_dir.empty()},
              {"waypoints", nlohmann::json::parse(options.waypoints_json, nullptr, false)}});
  }

  void live(const httplib::Request& request, httplib::Response& response) {
    Identity who;
    if (!admit_viewer(request, response, who)) return;
    const auto client = events.join();
    if (!client)
      return refuse(503, "too_many_clients", "Too many pages are open already.", request, response);
    response.set_header("X-Accel-Buffering", "no");
    // The queue exists before the snapshot is taken: between the two nothing is missed.
    response.set_chunked_content_provider(
        "text/event-stream", [this, client, begun = false](std::size_t, httplib::DataSink& sink) mutable {
          if (!begun) {
            begun = true;
            const std::string first = "event: snapshot\ndata: " + hooks.snapshot() + "\n\n";
            return sink.write(first.data(), first.size());
          }
          const Event event = client->wait(kStreamPatience);
          if (event) return sink.write(event->data(), event->size());
          if (client->closed()) sink.done();
          return true;
        });
  }

  void order(const httplib::Request& request, httplib::Response& response) {
    Identity who;
    if (!admit(request, response, who)) return;
    const OrderJudgement judgement = hooks.order(request.body, who, request.remote_addr);
    put_json(response, judgement.status, {{"text", judgement.text}});
  }

  void tile(const httplib::Request& request, httplib::Response& response) {
    response.set_header("Cache-Control", "max-age=3600");
    const auto& part = request.matches;
    std::ostringstream bytes;
    if (!options.tiles_dir.empty()) {
      // Digits only: nothing that could lead out of the folder.
      bytes << std::ifstream(options.tiles_dir + "/" + part[1].str() + "/" + part[2].str() + "/" +
                                 part[3].str() + ".png",
                             std::ios::binary)
                   .rdbuf();
    }
    if (bytes.str().empty()) {
      response.status = 404;
      return;
    }
    response.set_content(bytes.str(), "image/png");
  }

  static void file(const httplib::Request& request, httplib::Response& response) {
    const Asset* asset = find_asset(request.path);
    if (asset == nullptr) {
      response.status = 404;
      return;
    }
    const std::string etag(asset->etag);
    response.set_header("ETag", etag);
    response.set_header("Cache-Control",
                        "no-cache");  // asked for again, answered with 304 when it is the same
    if (request.get_header_value("if-none-match") == etag) {
      response.status = 304;
      return;
    }
    response.set_content(asset->bytes.data(), asset->bytes.size(), std::string(asset->type));
  }

  Options options;
  Hooks hooks;
  FanOut& events;
  Router router;
};

Site::Site(Options options, Hooks hooks, FanOut& events)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(hooks), events)) {}

Site::~Site() = default;

bool Site::serve(const RequestHead& head, const std::string& body, const std::string& peer,
                 Connection& connection) {
  JudgedStream stream(rebuilt(head, body), peer, connection);
  return impl_->router.process(stream, head.keep_alive);
}

void Site::close() {
  impl_->router.close();
}

}  // namespace fathom::console
