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

/// One accepted TCP connection, in clear or, after secure(), by TLS. Reading and writing have deadlines, and
/// no more is read than is asked for: a peer that is slow, silent or endless costs its thread for a known
/// time and no memory.
class Connection {
 public:
  enum class Outcome { complete, closed, timed_out };

  /// Of a non-blocking socket, which outlives it.
  explicit Connection(int socket) : socket_(socket) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The first byte that the peer sends, left where it is. Nothing when none came by then.
  [[nodiscard]] std::optional<unsigned char> peek(SteadyTime deadline) const;
  /// The handshake of TLS; everything after it is encrypted. `closed`: the peer left or broke the protocol.
  [[nodiscard]] Outcome secure(const TlsIdentity& identity, SteadyTime deadline);

  /// Appends one read of what is there to `to`: at most 4 KiB.
  [[nodiscard]] Outcome receive(std::string& to, SteadyTime deadline);

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

  int socket_;
  std::unique_ptr<ssl_st, FreeTls> tls_;
  bool tls_broken_ = false;  ///< nothing may be said by it any more, not even goodbye
};

}  // namespace fathom::console
