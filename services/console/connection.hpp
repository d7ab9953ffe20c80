#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct ssl_st;

namespace fathom::console {

class TlsIdentity;
using SteadyTime = std::chrono::steady_clock::time_point;

/// One accepted TCP connection, closed with the object, in clear or, after secure(), by TLS. Reading and
/// writing have deadlines, and no more is read than is asked for: a peer that is slow, silent or endless
/// costs its thread for a known time and no memory.
class Connection {
 public:
  enum class Outcome { complete, closed, timed_out, oversized };

  /// Takes over a non-blocking socket.
  explicit Connection(int socket) : socket_(socket) {}
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The first byte that the peer sends, left where it is. Nothing when none came by then.
  [[nodiscard]] std::optional<unsigned char> peek(SteadyTime deadline) const;
  /// The handshake of TLS; everything after it is encrypted. `closed`: the peer left or broke the protocol.
  [[nodiscard]] Outcome secure(const TlsIdentity& identity, SteadyTime deadline);

  /// Waits for the first byte of a request. False when none came by then, or the peer is gone.
  [[nodiscard]] bool wait_for_request(SteadyTime deadline);
  /// Reads up to and including the empty line.
  [[nodiscard]] Outcome read_head(std::string& head, std::size_t most, SteadyTime deadline);
  [[nodiscard]] Outcome read_body(std::string& body, std::size_t length, SteadyTime deadline);
  /// Bytes of the next request are there already, or some of this one came before it was given up.
  [[nodiscard]] bool has_started() const { return !buffer_.empty(); }

  /// False when the peer is gone or takes nothing for `patience`.
  [[nodiscard]] bool write(std::string_view bytes, std::chrono::milliseconds patience);
  /// Ends the sending side and swallows what the peer is still sending for a moment: closing at once would
  /// tear down the answer with it.
  void linger();

 private:
  struct FreeTls {
    void operator()(ssl_st* tls) const;
  };
  /// What became of one attempt that does not wait.
  struct Step {
    std::size_t bytes = 0;  ///< 0: nothing yet, see events
    short events = 0;       ///< for poll(), before it makes sense to try again; 0 with no bytes: it is over
  };
  [[nodiscard]] Step try_receive(char* to, std::size_t size);
  [[nodiscard]] Step try_send(std::string_view bytes);
  /// By the return value of a call of the TLS library.
  [[nodiscard]] Step tls_step(int result);
  /// One read of what is there into the buffer.
  [[nodiscard]] Outcome receive(SteadyTime deadline);

  int socket_;
  std::unique_ptr<ssl_st, FreeTls> tls_;
  bool tls_broken_ = false;  ///< nothing may be said by it any more, not even goodbye
  std::string buffer_;
};

}  // namespace fathom::console
