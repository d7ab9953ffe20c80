#pragma once

// A client of the server. Only ws_server.cpp includes this: Boost.Beast is heavy.

#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include "foxglove_server/ws_server.hpp"

namespace fathom::foxglove {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

/// What a client may ask of the server, on its thread.
class Host {
 public:
  virtual ~Host() = default;
  [[nodiscard]] virtual const WsServer::Options& options() const = 0;
  /// Empty when it may come in; else status and why not.
  [[nodiscard]] virtual std::pair<http::status, std::string> judge(
      const http::request<http::empty_body>& request) = 0;
  virtual void came(class Client* client) = 0;
  virtual void went(class Client* client) = 0;
  virtual void wish(class Client* client, const Wish& wish) = 0;
  /// A line for the log about what a client does; there are few reasons.
  virtual void complain(const std::string& reason, const std::string& text) = 0;
  virtual void count_dropped() = 0;
};

class Client {
 public:
  virtual ~Client() = default;
  virtual void send_text(std::string text) = 0;
  virtual void send_message(std::uint32_t subscription, const Message& message) = 0;
  virtual void end() = 0;
  std::map<std::uint32_t, std::uint32_t> channel_of;  ///< by the client's own subscription numbers
};

/// Next: beast::tcp_stream, or one of TLS on it.
template <class Next>
class Session final : public Client, public std::enable_shared_from_this<Session<Next>> {
 public:
  static constexpr std::chrono::seconds kHandshake{10};
  static constexpr std::chrono::seconds kPatience{30};
  static constexpr std::size_t kLongestRequest = 16 * 1024;
  static constexpr std::size_t kLongestText = 64 * 1024;

  template <class... Arguments>
  explicit Session(Host& host, Arguments&&... arguments)
      : host_(host), ws_(std::forward<Arguments>(arguments)...) {
    parser_.header_limit(kLongestRequest);
    parser_.body_limit(0);
  }

  void start() {
    beast::get_lowest_layer(ws_).expires_after(kHandshake);
    if constexpr (std::is_same_v<Next, beast::tcp_stream>) {
      read_request();
    } else {
      ws_.next_layer().async_handshake(boost::asio::ssl::stream_base::server,
                                       [self = this->shared_from_this()](const beast::error_code& error) {
                                         if (!error) self->read_request();
                                       });
    }
  }

  void send_text(std::string text) override {
    if (over_) return;
    // What a client has to know is never left out: who asks for more and more of it and takes none goes.
    if (text_bytes_ > host_.options().queue_bytes) {
      host_.complain("deaf", "a client takes none of what it asks for: it is let go");
      return end();
    }
    text_bytes_ += text.size();
    texts_.push_back({{}, std::move(text), nullptr});
    settle();
  }
  void send_message(std::uint32_t subscription, const Message& message) override {
    if (over_) return;
    messages_.push_back({message_head(subscription, message.received_ns), {}, message.bytes});
    message_bytes_ += messages_.back().size();
    settle();
  }
  void end() override {
    over_ = true;
    beast::error_code ignored;
    beast::get_lowest_layer(ws_).socket().close(ignored);
  }

 private:
  struct Item {
    MessageHead head{};
    std::string text;
    Payload bytes;
    [[nodiscard]] bool is_text() const { return bytes == nullptr; }
    [[nodiscard]] std::size_t size() const { return is_text() ? text.size() : head.size() + bytes->size(); }
  };

  void read_request() {
    http::async_read_header(ws_.next_layer(), buffer_, parser_,
                            [self = this->shared_from_this()](const beast::error_code& error, std::size_t) {
                              if (!error) self->answer();
                            });
  }
  void answer() {
    const auto [status, why] = host_.judge(parser_.get());
    if (status != http::status::ok) {
      auto refusal = std::make_shared<http::response<http::string_body>>(status, 11, why + "\n");
      refusal->set(http::field::content_type, "text/plain");
      refusal->keep_alive(false);
      refusal->prepare_payload();
      http::async_write(
          ws_.next_layer(), *refusal,
          [self = this->shared_from_this(), refusal](const beast::error_code&, std::size_t) { self->end(); });
      return;
    }
    const auto offered = parser_.get()[http::field::sec_websocket_protocol];
    ws_.set_option(websocket::stream_base::decorator(
        [chosen = std::string(chosen_subprotocol({offered.data(), offered.size()}))](
            websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, chosen);
        }));
    beast::get_lowest_layer(ws_).expires_never();
    ws_.set_option(websocket::stream_base::timeout{kHandshake, kPatience, true});
    ws_.read_message_max(kLongestText);
    ws_.async_accept(parser_.get(), [self = this->shared_from_this()](const beast::error_code& error) {
      if (error || self->over_) return;
      self->buffer_.clear();
      self->host_.came(self.get());
      self->read();
    });
  }
  void read() {
    ws_.async_read(buffer_, [self = this->shared_from_this()](const beast::error_code& error, std::size_t) {
      if (error || self->over_) return self->gone();
      self->hear();
      self->buffer_.clear();
      self->read();
    });
  }
  void hear() {
    if (!ws_.got_text()) return;  // messages of its own: we take none
    const auto bytes = buffer_.cdata();
    const auto wish = wish_of({static_cast<const char*>(bytes.data()), bytes.size()});
    if (!wish) {
      host_.complain("wish", "a client says what is no wish: " + wish.error().message);
      send_text(warning(wish.error().message));
      return;
    }
    host_.wish(this, wish.value());
  }

  /// The oldest messages give way. Then what waits may leave.
  void settle() {
    while (!messages_.empty() &&
           leaving_.size() + text_bytes_ + message_bytes_ > host_.options().queue_bytes) {
      message_bytes_ -= messages_.front().size();
      messages_.pop_front();
      host_.count_dropped();
    }
    if (!writing_) write();
  }
  /// Texts go first: a message makes sense to those only who know what was said before.
  void write() {
    auto& from = texts_.empty() ? messages_ : texts_;
    writing_ = !from.empty();
    if (!writing_) return;
    leaving_ = std::move(from.front());
    from.pop_front();
    (leaving_.is_text() ? text_bytes_ : message_bytes_) -= leaving_.size();
    ws_.text(leaving_.is_text());
    auto written = [self = this->shared_from_this()](const beast::error_code& error, std::size_t) {
      if (error || self->over_) return self->gone();
      self->leaving_ = {};
      self->write();
    };
    using boost::asio::buffer;
    using boost::asio::const_buffer;
    std::array<const_buffer, 2> parts{buffer(leaving_.text)};
    if (!leaving_.is_text()) parts = {buffer(leaving_.head), buffer(*leaving_.bytes)};
    ws_.async_write(parts, std::move(written));
  }
  void gone() {
    if (!std::exchange(is_gone_, true)) host_.went(this);
    end();
  }

  Host& host_;
  websocket::stream<Next, false> ws_;  // nothing is compressed
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  Item leaving_;  // while it is written
  std::deque<Item> texts_;
  std::deque<Item> messages_;
  std::size_t text_bytes_ = 0;
  std::size_t message_bytes_ = 0;
  bool writing_ = false;
  bool over_ = false;
  bool is_gone_ = false;
};

}  // namespace fathom::foxglove
