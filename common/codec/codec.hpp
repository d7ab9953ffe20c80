#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "base/device_time.hpp"
#include "samples/kinds.hpp"

namespace fathom::codec {

/// The bridge turns it into stamp_ns (runtime/device_time.hpp); codecs leave the stamps of the header at 0.
using DeviceTime = fathom::DeviceTime;

/// Why a frame was refused. Exactly one per refused frame.
enum class RejectReason : std::uint8_t {
  checksum = 0,
  length = 1,     ///< declared length impossible, frame longer than the limit, or cut short
  structure = 2,  ///< framed and summed correctly, but its inside contradicts itself (offsets, field count)
  field = 3,      ///< a field is not a number, or not one of its words
  out_of_range = 4,  ///< a number that no instrument of this kind can mean
  no_checksum = 5,   ///< the protocol wants one and the configuration insists
  truncated = 6,     ///< the stream ended inside the frame
  incomplete = 7,    ///< good values, but one is missing without which they mean nothing
};
[[nodiscard]] std::string_view to_string(RejectReason reason);
/// What that means, for people: "a field is not a number, or none of its words".
[[nodiscard]] std::string_view meaning(RejectReason reason);

struct Decoded {
  AnySample sample;
  DeviceTime time;
  std::uint64_t offset = 0;  ///< of the frame's first byte in the stream
  std::uint64_t length = 0;
};

struct Rejected {
  RejectReason reason = RejectReason::checksum;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::span<const std::uint8_t> bytes{};  ///< of the frame; only while on_rejected() runs
};

/// Receives what a codec finds, in stream order.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void on_sample(const Decoded& decoded) = 0;
  virtual void on_rejected(const Rejected& rejected) = 0;
};

/// bytes = inside good frames (whether or not they carried a sample) + rejected frames + skipped_bytes.
struct Totals {
  std::uint64_t bytes = 0;
  std::uint64_t samples = 0;
  std::uint64_t frames_ignored = 0;  ///< good frames of kinds that carry no sample
  std::uint64_t rejected = 0;
  std::uint64_t skipped_bytes = 0;  ///< between frames
};

/// Incremental decoder of one byte stream. The result does not depend on how the bytes are cut; memory is
/// bounded whatever arrives; after garbage it finds the next good frame, including one that starts inside a
/// refused one.
class Codec {
 public:
  virtual ~Codec() = default;
  virtual void feed(std::span<const std::uint8_t> bytes, Sink& sink) = 0;
  /// The stream has ended: what is complete is delivered, what is cut is rejected.
  virtual void finish(Sink& sink) = 0;
  [[nodiscard]] virtual Totals totals() const = 0;
};

}  // namespace fathom::codec
