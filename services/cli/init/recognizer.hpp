#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::cli {

/// What a stream says of one kind of quantity.
struct SeenKind {
  SourceKind kind = SourceKind::imu;
  std::uint64_t samples = 0;  ///< frames with one
  double rate_hz = 0.0;       ///< of arrivals; 0: fewer than three
};

/// What a stream is.
struct Recognition {
  std::string protocol;
  double share = 0.0;  ///< of its bytes that lie in good frames, 0 to 1
  std::vector<SeenKind> kinds;
  std::optional<double> latitude_rad;                 ///< of the last fix
  std::optional<std::array<double, 3>> mean_force_S;  ///< m/s^2 in the axes of the inertial unit
  std::optional<double> depth_m;                      ///< the first one, read as psi where it is a pressure
};

/// Runs every codec over the bytes of one port and says which of them understands it. Memory is bounded by
/// the codecs'.
class Recognizer {
 public:
  Recognizer();
  ~Recognizer();
  Recognizer(const Recognizer&) = delete;
  Recognizer& operator=(const Recognizer&) = delete;

  /// `arrival_ns`: of these bytes, monotonic.
  void feed(std::span<const std::uint8_t> bytes, TimeNs arrival_ns);
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// The protocol that explains the stream best; none as long as none explains enough of it. Protocols with a
  /// checksum and a layout of their own go before those that any line of text might be.
  [[nodiscard]] std::optional<Recognition> best() const;
  /// Something was understood, though not enough yet: a slow instrument speaks every few seconds.
  [[nodiscard]] bool promising() const;

 private:
  struct Listener;
  std::vector<std::unique_ptr<Listener>> listeners_;
  std::uint64_t bytes_ = 0;
};

}  // namespace fathom::cli
