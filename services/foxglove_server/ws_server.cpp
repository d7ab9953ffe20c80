#include "foxglove_server/ws_server.hpp"

#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/clock.hpp"
#include "foxglove_server/session.hpp"
#include "runtime/refusal_log.hpp"

namespace fathom::foxglove {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::seconds kRetry{2};

/// The value of "token" in a target like "/?token=abc"; tokens are of printable characters that need no
/// escape but may come with one.
std::string token_in(std::string_view target) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return "";
  std::string_view rest = target.substr(query + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find('&');
    const std::string_view one = rest.substr(0, end);
    if (one.starts_with("token=")) {
      std::string out;
      const std::string_view value = one.substr(6);
      for (std::size_t i = 0; i < value.size(); ++i) {
        const auto digit = [](char c) {
          return c >= '0' && c <= '9'   ? c - '0'
                 : c >= 'a' && c <= 'f' ? c - 'a' + 10
                 : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                        : -1;
        };
        if (value[i] == '%' && i + 2 < value.size() && digit(value[i + 1]) >= 0 && digit(value[i + 2]) >= 0) {
          out += static_cast<char>(16 * digit(value[i + 1]) + digit(value[i + 2]));
          i += 2;
        } else {
          out += value[i];
        }
      }
      return out;
    }
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  return "";
}

}  // namespace

struct WsServer::Impl final : Host {
  Impl(Options options_in, Handlers handlers_in)
      : options_(std::move(options_in)),
        handlers(std::move(handlers_in)),
        offer(advertisement(options_.channels)) {
    if (!options_.certificate_file.empty()) {
      try {
        tls.emplace(asio::ssl::context::tls_server);
        tls->set_options(asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1);
        tls->use_certificate_chain_file(options_.certificate_file);
        tls->use_private_key_file(options_.key_file, asio::ssl::context::pem);
      } catch (const std::exception& error) {
        throw std::runtime_error(options_.certificate_file + ", " + options_.key_file + ": " + error.what());
      }
    }
    asio::post(io, [this] { listen(); });
    thread = std::thread([this] { io.run(); });
  }
  ~Impl() override {
    asio::post(io, [this] {
      for (Client* client : clients) client->end();
      io.stop();
    });
    thread.join();
  }

  void listen() {
    try {
      const tcp::endpoint here(asio::ip::make_address(options_.address),
                               static_cast<std::uint16_t>(options_.port));
      acceptor.open(here.protocol());
      acceptor.set_option(asio::socket_base::reuse_address(true));
      acceptor.bind(here);
      acceptor.listen();
    } catch (const std::exception& error) {
      return retry(error.what());
    }
    {
      const std::lock_guard lock(mutex);
      shown.trouble.clear();
    }
    handlers.say(false, "clients of Foxglove find it at " + std::string(tls ? "wss://" : "ws://") +
                            options_.address + ":" + std::to_string(options_.port));
    accept();
  }
  void retry(const std::string& why) {
    beast::error_code ignored;
    acceptor.close(ignored);
    bool is_new = false;
    {
      const std::lock_guard lock(mutex);
      is_new = shown.trouble.empty();
      shown.trouble =
          "does not listen at " + options_.address + ":" + std::to_string(options_.port) + ": " + why;
    }
    if (is_new) handlers.say(true, shown.trouble + "; it is tried again and again");
    timer.expires_after(kRetry);
    timer.async_wait([this](const beast::error_code& error) {
      if (!error) listen();
    });
  }
  void accept() {
    acceptor.async_accept([this](const beast::error_code& error, tcp::socket socket) {
      if (error) return error == asio::error::operation_aborted ? void() : retry(error.message());
      beast::error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      if (tls) {
        std::make_shared<Session<beast::ssl_stream<beast::tcp_stream>>>(*this, std::move(socket), *tls)
            ->start();
      } else {
        std::make_shared<Session<beast::tcp_stream>>(*this, std::move(socket))->start();
      }
      accept();
    });
  }

  [[nodiscard]] const Options& options() const override { return options_; }

  [[nodiscard]] std::pair<http::status, std::string> judge(
      const http::request<http::empty_body>& request) override {
    const auto refuse = [&](http::status status, const std::string& why) {
      const std::lock_guard lock(mutex);
      if (shown.refused++ == 0) handlers.say(true, "a client was refused: " + why);
      return std::pair(status, why);
    };
    const auto target = request.target();
    if (!handlers.may_look(token_in({target.data(), target.size()})))
      return refuse(http::status::unauthorized, "It needs a token that may look: ws://host:port/?token=...");
    if (!websocket::is_upgrade(request))
      return refuse(http::status::bad_request, "This is for clients of the Foxglove WebSocket protocol.");
    const auto offered = request[http::field::sec_websocket_protocol];
    if (chosen_subprotocol({offered.data(), offered.size()}).empty())
      return refuse(http::status::bad_request, "It needs the subprotocol foxglove.websocket.v1.");
    if (clients.size() >= options_.most_clients)
      return refuse(http::status::service_unavailable, "There are as many clients as may be.");
    return {http::status::ok, ""};
  }

  void came(Client* client) override {
    clients.insert(client);
    count_clients();
    client->send_text(server_info(options_.name, options_.session));
    client->send_text(offer);
  }
  void went(Client* client) override {
    clients.erase(client);
    count_clients();
    while (!client->channel_of.empty()) unsubscribe(client, client->channel_of.begin()->first);
  }
  void wish(Client* client, const Wish& wish) override {
    for (const Subscription& one : wish.subscribe) subscribe(client, one);
    for (const std::uint32_t id : wish.unsubscribe) unsubscribe(client, id);
  }
  void subscribe(Client* client, const Subscription& one) {
    const bool is_known = std::any_of(options_.channels.begin(), options_.channels.end(),
                                      [&](const Channel& channel) { return channel.id == one.channel; });
    if (!is_known) return client->send_text(warning("there is no channel " + std::to_string(one.channel)));
    if (client->channel_of.size() >= kMostWishes || !client->channel_of.emplace(one.id, one.channel).second)
      return client->send_text(warning("subscription " + std::to_string(one.id) + " is in use already"));
    auto& wanted_by = subscribers[one.channel];
    const bool is_first = wanted_by.empty();
    wanted_by.insert({client, one.id});
    if (is_first) return handlers.wanted(one.channel, true);
    for (const Message& message : handlers.kept(one.channel)) client->send_message(one.id, message);
  }
  void unsubscribe(Client* client, std::uint32_t id) {
    const auto found = client->channel_of.find(id);
    if (found == client->channel_of.end()) return;
    const std::uint32_t channel = found->second;
    client->channel_of.erase(found);
    subscribers[channel].erase({client, id});
    if (subscribers[channel].empty()) handlers.wanted(channel, false);
  }
  void complain(const std::string& reason, const std::string& text) override {
    if (const auto line = complaints.add(reason, text, SystemClock().monotonic_ns()))
      handlers.say(true, *line);
  }
  void count_dropped() override {
    const std::lock_guard lock(mutex);
    ++shown.dropped;
  }
  void count_clients() {
    const std::lock_guard lock(mutex);
    shown.clients = clients.size();
  }

  void deliver(std::uint32_t channel, const Message& message) {
    const auto found = subscribers.find(channel);
    if (found == subscribers.end()) return;
    // A client may go while it is sent to.
    const auto now = found->second;
    for (const auto& [client, id] : now)
      if (clients.contains(client)) client->send_message(id, message);
    const std::lock_guard lock(mutex);
    shown.messages += now.size();
  }

  const Options options_;
  const Handlers handlers;
  const std::string offer;
  std::optional<asio::ssl::context> tls;
  asio::io_context io{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io};
  runtime::RefusalLog complaints;
  std::set<Client*> clients;
  std::map<std::uint32_t, std::set<std::pair<Client*, std::uint32_t>>> subscribers;
  mutable std::mutex mutex;
  Status shown;
  std::thread thread;
};

WsServer::WsServer(Options options, Handlers handlers)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(handlers))) {}
WsServer::~WsServer() = default;

void WsServer::publish(std::uint32_t channel, Message message) {
  boost::asio::post(impl_->io, [impl = impl_.get(), channel, message = std::move(message)] {
    impl->deliver(channel, message);
  });
}

WsServer::Status WsServer::status() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->shown;
}

}  // namespace fathom::foxglove
