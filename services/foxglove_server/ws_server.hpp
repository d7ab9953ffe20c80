#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "foxglove/protocol.hpp"

namespace fathom::foxglove {

using Payload = std::shared_ptr<const std::vector<std::uint8_t>>;

struct Message {
  TimeNs received_ns = 0;
  Payload bytes;
};

/// Tells clients of the Foxglove protocol what they subscribe to, on one thread. A slow client loses its
/// oldest messages, one that takes nothing for 30 s or asks for more than it takes is let go, and nobody else
/// notices.
class WsServer {
 public:
  struct Options {
    std::string address;
    int port = 0;
    std::size_t most_clients = 16;
    std::size_t queue_bytes = 4'000'000;  ///< of each client
    std::string certificate_file;         ///< PEM; empty: in clear
    std::string key_file;
    std::string name;     ///< shown to people
    std::string session;  ///< clients forget what they know when it changes
    std::vector<Channel> channels;
  };
  struct Handlers {
    /// Whether who shows this token (empty: none) may look.
    std::function<bool(std::string_view token)> may_look;
    /// The first subscription to a channel came, or the last one went.
    std::function<void(std::uint32_t channel, bool is_wanted)> wanted;
    /// What a later subscriber to a channel has missed and has to know.
    std::function<std::vector<Message>(std::uint32_t channel)> kept;
    std::function<void(bool is_trouble, const std::string& text)> say;
  };
  struct Status {
    std::string trouble;  ///< why it does not listen; empty when it does
    std::uint64_t clients = 0;
    std::uint64_t messages = 0;
    std::uint64_t dropped = 0;  ///< messages that slow clients did not take
    std::uint64_t refused = 0;  ///< clients
  };

  /// Handlers run on the server's thread. Throws std::runtime_error for a certificate or key that cannot be
  /// used.
  WsServer(Options options, Handlers handlers);
  ~WsServer();
  WsServer(const WsServer&) = delete;
  WsServer& operator=(const WsServer&) = delete;

  /// To all who subscribed to the channel. Returns at once; any thread.
  void publish(std::uint32_t channel, Message message);
  [[nodiscard]] Status status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::foxglove
