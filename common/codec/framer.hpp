#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "codec/codec.hpp"

namespace fathom::codec {

using Bytes = std::span<const std::uint8_t>;

/// The same bytes, for as long as they are there.
[[nodiscard]] inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What stands at the front of the unread bytes.
struct Probe {
  enum class Kind : std::uint8_t {
    skip,   ///< `length` bytes that begin no frame of this protocol
    maybe,  ///< too few bytes to tell; at the end of the stream they are skipped
    need,   ///< a frame has begun; ask again with `length` bytes; at the end of the stream it is `truncated`
    frame,  ///< a complete frame of `length` bytes, checksum verified
    bad,    ///< `length` bytes, all of them here, that are refused for `reason`
  };
  Kind kind = Kind::skip;
  std::size_t length = 0;
  RejectReason reason = RejectReason::checksum;
  /// After `bad`: how far to move before looking again. 1 finds a frame that begins inside the refused one;
  /// more only where none can begin in between.
  std::size_t advance = 1;

  [[nodiscard]] static Probe skip(std::size_t bytes) { return {Kind::skip, bytes}; }
  [[nodiscard]] static Probe maybe() { return {Kind::maybe, 0}; }
  /// `total` bytes from the start of the frame are wanted, 0 when not known.
  [[nodiscard]] static Probe need(std::size_t total = 0) { return {Kind::need, total}; }
  [[nodiscard]] static Probe frame(std::size_t bytes) { return {Kind::frame, bytes}; }
  [[nodiscard]] static Probe bad(RejectReason reason, std::size_t bytes, std::size_t advance = 1) {
    return {Kind::bad, bytes, reason, advance};
  }
};

/// Looks for the two bytes that begin every frame of a protocol; nothing when they stand at the front, which
/// is not empty.
[[nodiscard]] std::optional<Probe> seek_sync(Bytes front, std::uint8_t first, std::uint8_t second);

/// What became of a complete frame.
struct Outcome {
  enum class Kind : std::uint8_t { used, ignored, refused };
  Kind kind = Kind::used;
  RejectReason reason = RejectReason::structure;
  std::size_t advance = 1;  ///< after `refused`, as in Probe

  /// Gave samples, now or together with later frames.
  [[nodiscard]] static Outcome used() { return {Kind::used}; }
  /// Good, of a kind that carries no sample.
  [[nodiscard]] static Outcome ignored() { return {Kind::ignored}; }
  /// Its checksum is right and its inside is not. Nothing may have been emitted.
  [[nodiscard]] static Outcome refused(RejectReason reason, std::size_t advance = 1) {
    return {Kind::refused, reason, advance};
  }
};

/// The part of a codec that all protocols share: buffering, absolute offsets, resynchronisation and totals.
///
/// A protocol implements `probe` and `decode`. For independence of chunking `probe` must be a function of the
/// bytes alone and must not change its answer, other than from `maybe` or `need`, when more bytes follow the
/// same front (`skip` may grow).
///
/// A frame refused inside the extent of an earlier refused one is the same damage seen again and not
/// reported; a good frame that begins there is delivered. Every byte counts once: in a good frame, else in a
/// refused one, else as skipped.
class Framer : public Codec {
 public:
  void feed(Bytes bytes, Sink& sink) final;
  void finish(Sink& sink) final;
  [[nodiscard]] Totals totals() const final { return totals_; }

 protected:
  enum class LineEnds : std::uint8_t { are_bytes, belong_to_frames };

  /// `max_frame`: longest frame of the protocol; a frame that wants more is refused as `length`. With
  /// `belong_to_frames`, CR and LF directly after a frame count to it, so that a text protocol can close a
  /// frame before its line end has arrived.
  explicit Framer(std::size_t max_frame, LineEnds line_ends = LineEnds::are_bytes);

  /// `front` is not empty and never longer than max_frame.
  [[nodiscard]] virtual Probe probe(Bytes front) const = 0;
  /// `offset` is that of the frame's first byte in the stream.
  virtual Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) = 0;
  /// Delivers samples that waited for more frames; called once at the end of the stream.
  virtual void flush(Sink& /*sink*/) {}

  /// How `decode` and `flush` hand out a sample.
  void emit(Sink& sink, const AnySample& sample, const DeviceTime& time, std::uint64_t offset,
            std::uint64_t length);
  /// The same of what is found later than its frame (Epochs).
  [[nodiscard]] auto deliver_to(Sink& sink) {
    return [this, &sink](const auto& found) {
      emit(sink, found.sample, found.time, found.offset, found.length);
    };
  }

 private:
  void drain(Sink& sink, bool at_end);
  void pass(std::size_t count);
  void refuse(Sink& sink, RejectReason reason, std::size_t length);
  void compact();

  std::size_t max_frame_;
  LineEnds line_ends_;
  std::vector<std::uint8_t> buffer_;
  std::size_t head_ = 0;             ///< first unread byte in the buffer
  std::size_t wanted_ = 1;           ///< unread bytes before asking again makes sense
  std::uint64_t offset_ = 0;         ///< of the first unread byte in the stream
  std::uint64_t covered_until_ = 0;  ///< end of the last good or refused frame
  std::uint64_t refused_until_ = 0;  ///< end of the last refused frame
  Totals totals_;
};

}  // namespace fathom::codec
