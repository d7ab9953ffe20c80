#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "base/clock.hpp"
#include "runtime/device_time.hpp"

namespace fathom::runtime {

enum class SourceType : std::uint8_t { serial = 0, tcp_client = 1, tcp_server = 2, udp = 3, file = 4 };

/// A character on a serial line: data bits, parity, stop bits.
enum class Framing : std::uint8_t { n8_1 = 0, e8_1 = 1, o8_1 = 2, e7_1 = 3, o7_1 = 4 };
[[nodiscard]] std::string_view to_string(Framing framing);  ///< "8N1", "8E1", ...

/// How a file is played.
enum class Pace : std::uint8_t {
  original = 0,  ///< as the times in its frames say; the decoder calls hold()
  rate = 1,      ///< bytes_per_s
  fastest = 2,
};

/// Where bytes of one instrument come from.
struct ByteSourceConfig {
  SourceType type = SourceType::serial;
  std::string path;                 ///< serial: device, file: file
  int baud = 115'200;               ///< serial
  Framing framing = Framing::n8_1;  ///< serial
  std::string address =
      "127.0.0.1";  ///< tcp_client: of the device; tcp_server, udp: address to bind; numeric
  int port = 0;
  std::string multicast;          ///< udp: group to join on `address`; empty: none
  Pace pace = Pace::original;     ///< file
  double bytes_per_s = 11'520.0;  ///< file, pace rate
  std::string greeting;    ///< tcp_client, serial: said once connected and when silent; of the protocol
  bool shared = false;     ///< all but file: others of this host read the same port
  double silence_s = 0.0;  ///< connected without a byte for this long is worth saying; 0: never
  double backoff_first_s = 0.1;
  double backoff_most_s = 5.0;
};

enum class SourceState : std::uint8_t {
  lost = 0,       ///< no connection; attempts go on
  connected = 1,  ///< no byte yet, or receiving
  silent = 2,     ///< connected, but nothing arrives
  finished = 3,   ///< the file is at its end
};
[[nodiscard]] std::string_view to_string(SourceState state);

/// A change of state; each is reported once, however many attempts fail in between.
struct SourceEvent {
  SourceState state = SourceState::lost;
  std::string detail;  ///< what and why, e.g. "/dev/ttyUSB0: No such file or directory"
};

struct SourceStatus {
  SourceState state = SourceState::lost;
  std::string detail;
  std::uint64_t bytes = 0;
  std::uint64_t connects = 0;
  std::uint64_t errors = 0;  ///< failed attempts and broken connections
};

/// Bytes of one instrument, read on a thread of its own: a dead one never holds up another. Reconnects for
/// ever, waiting backoff_first_s to backoff_most_s between attempts.
///
/// serial       raw mode; input that waited in the driver while nobody listened is dropped, because nobody
///              knows when it arrived; a device path that vanishes and returns is opened again.
/// tcp_client   connects to the device; a peer that went without closing is noticed by keep-alive.
/// tcp_server   the device connects here; one at a time, and a new connection replaces the old one, which is
///              how a device that was restarted gets back in.
/// udp          every datagram to the bound address and port.
/// file         once from beginning to end.
///
/// A shared port is opened by whoever comes first and read by all who say that it is shared, in as many
/// processes as there are: each gets every byte with the instant at which it arrived. When the process that
/// reads the line ends, another one opens it.
class ByteSource {
 public:
  /// Bytes as they came, on the source's thread. What it throws counts as a broken connection.
  using BytesHandler = std::function<void(std::span<const std::uint8_t> bytes, const Arrival& arrival)>;
  /// Changes of state, on the source's thread, in order with the bytes.
  using EventHandler = std::function<void(const SourceEvent& event)>;

  /// `clock` must outlive the source. Nothing runs before start().
  ByteSource(ByteSourceConfig config, const Clock& clock, BytesHandler on_bytes, EventHandler on_event);
  /// Stops within a fraction of a second, whatever the device does; handlers have returned by then.
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  void start();

  [[nodiscard]] SourceStatus status() const;

  /// For a bytes handler that plays a file: returns after this much vehicle time, or at once when the source
  /// is stopping.
  void hold(DurationNs vehicle_ns);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// "serial /dev/ttyUSB0", "tcp 10.0.0.7:5000": the source as people name it.
[[nodiscard]] std::string describe_source(const ByteSourceConfig& config);

/// Whether two sources are one port with the same settings, so that it can be shared.
[[nodiscard]] bool same_port(const ByteSourceConfig& one, const ByteSourceConfig& other);

/// Whether two sources, open at once, would take bytes from each other or keep each other from opening.
[[nodiscard]] bool collide(const ByteSourceConfig& one, const ByteSourceConfig& other);

/// Whether the text is the numeric address of a multicast group.
[[nodiscard]] bool is_multicast_address(const std::string& text);

/// Whether the text is a numeric IPv4 or IPv6 address.
[[nodiscard]] bool is_numeric_address(const std::string& text);

}  // namespace fathom::runtime
