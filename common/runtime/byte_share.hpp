#pragma once

// Private to runtime/byte_*.cpp.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#define ASIO_STANDALONE 1
#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>

#include "base/time.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::runtime {

/// What the reader of a shared port says to the others.
struct ShareMessage {
  enum class Kind : std::uint8_t { bytes = 'B', connected = 'C', lost = 'L' };
  Kind kind = Kind::bytes;
  TimeNs host_monotonic_ns = 0;           ///< bytes: when they arrived, by the host's clock
  std::span<const std::uint8_t> payload;  ///< bytes, or the detail of a state
};

/// A message as one packet; nothing where it is none.
[[nodiscard]] std::vector<std::uint8_t> pack(const ShareMessage& message);
[[nodiscard]] std::optional<ShareMessage> unpack(std::span<const std::uint8_t> packet);

/// The longest packet: a datagram's bytes and what is said of them.
inline constexpr std::size_t kLongestSharePacket = 65'536 + 9;

/// The port that one process of this host reads and hands on. An abstract socket of the kernel stands for
/// it: whoever binds it reads the port, the others connect to it, and it goes with its process, however that
/// ends. Both ends speak to processes of the same user or of root only.
class PortShare : public std::enable_shared_from_this<PortShare> {
 public:
  /// Null where another process has the port already. Throws std::system_error.
  [[nodiscard]] static std::shared_ptr<PortShare> claim(asio::io_context& io, const ByteSourceConfig& port);
  /// Connects to the process that reads the port; null where it is just going. Throws std::runtime_error
  /// where that is a process of another user.
  [[nodiscard]] static std::unique_ptr<asio::posix::stream_descriptor> join(asio::io_context& io,
                                                                            const ByteSourceConfig& port);

  PortShare(asio::io_context& io, int listening);
  PortShare(const PortShare&) = delete;
  PortShare& operator=(const PortShare&) = delete;

  /// Takes in who connects, until close().
  void start();
  void close();
  /// Never waits: a reader that has fallen so far behind that it has no room is let go, and connects anew.
  void tell(const ShareMessage& message);

 private:
  void take_in(int descriptor);
  [[nodiscard]] asio::awaitable<void> accept();

  asio::io_context& io_;
  asio::posix::stream_descriptor listening_;
  std::vector<asio::posix::stream_descriptor> readers_;
  std::vector<std::uint8_t> state_;  ///< the last one told, as a packet
};

}  // namespace fathom::runtime
