#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom::runtime {

enum class LinkType : std::uint8_t { udp = 0, tcp_client = 1, serial = 2 };

/// Where somebody is with whom bytes are exchanged.
struct ByteLinkConfig {
  LinkType type = LinkType::udp;
  std::string address = "127.0.0.1";  ///< udp, tcp_client: numeric
  int port = 14'550;
  int bind_port = 0;   ///< udp: of this host; 0: any
  std::string path;    ///< serial
  int baud = 115'200;  ///< serial; 8 data bits, no parity, 1 stop bit
};

struct LinkStatus {
  std::string name;     ///< "udp 127.0.0.1:14550"
  std::string trouble;  ///< why there is no connection; empty when there is one
  std::uint64_t bytes_sent = 0;
  std::uint64_t bytes_dropped = 0;  ///< that the other side did not take
  std::uint64_t bytes_received = 0;
};

/// Bytes there and back, on a thread of its own. What breaks is opened again after 0.1 to 5 s, for ever.
/// Nobody waits for a slow receiver: what waits for it is bounded, and whole pieces are left out.
class ByteLink {
 public:
  using BytesHandler = std::function<void(std::span<const std::uint8_t> bytes)>;
  /// Changes between well and trouble, of many the newest (Reopening); who is not heard.
  using Say = std::function<void(bool is_trouble, const std::string& text)>;

  /// The handlers run on the link's thread. Nothing runs before start().
  ByteLink(ByteLinkConfig config, BytesHandler on_bytes, Say say);
  ~ByteLink();
  ByteLink(const ByteLink&) = delete;
  ByteLink& operator=(const ByteLink&) = delete;

  /// Once, when all that the handlers use is there.
  void start();

  /// Lets a piece leave; returns at once. Any thread, also from a handler.
  void send(std::vector<std::uint8_t> piece);
  [[nodiscard]] LinkStatus status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::runtime
