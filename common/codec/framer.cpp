#include "codec/framer.hpp"

#include <algorithm>
#include <cassert>

namespace fathom::codec {

std::optional<Probe> seek_sync(Bytes front, std::uint8_t first, std::uint8_t second) {
  if (front[0] != first) {
    const auto next = std::find(front.begin(), front.end(), first);
    return Probe::skip(static_cast<std::size_t>(next - front.begin()));
  }
  if (front.size() < 2) return Probe::maybe();
  if (front[1] != second) return Probe::skip(1);
  return std::nullopt;
}

Framer::Framer(std::size_t max_frame, LineEnds line_ends) : max_frame_(max_frame), line_ends_(line_ends) {
  assert(max_frame > 0);
  buffer_.reserve(2 * max_frame);
}

void Framer::feed(Bytes bytes, Sink& sink) {
  // In portions: the buffer stays bounded however much is handed over at once.
  while (!bytes.empty()) {
    compact();
    const std::size_t portion = std::min(bytes.size(), 2 * max_frame_ - buffer_.size());
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(portion));
    totals_.bytes += portion;
    bytes = bytes.subspan(portion);
    drain(sink, false);
  }
}

void Framer::finish(Sink& sink) {
  drain(sink, true);
  flush(sink);
  buffer_.clear();
  head_ = 0;
  wanted_ = 1;
}

void Framer::drain(Sink& sink, bool at_end) {
  while (head_ < buffer_.size()) {
    const std::size_t unread = buffer_.size() - head_;
    if (!at_end && unread < wanted_) return;
    const Bytes front(buffer_.data() + head_, std::min(unread, max_frame_));
    Probe found = probe(front);
    const bool waits = found.kind == Probe::Kind::maybe || found.kind == Probe::Kind::need;
    if (waits && found.length > max_frame_) {
      // One byte: how much of the frame is here already depends on how the stream was cut.
      found = Probe::bad(RejectReason::length, 1);
    } else if (waits && front.size() == max_frame_) {
      found = Probe::bad(RejectReason::length, max_frame_);
    } else if (waits && !at_end) {
      wanted_ = std::max(found.length, unread + 1);
      return;
    }
    wanted_ = 1;
    switch (found.kind) {
      case Probe::Kind::skip:
        assert(found.length > 0 && found.length <= front.size());
        pass(found.length);
        break;
      case Probe::Kind::maybe:
        pass(1);
        break;
      case Probe::Kind::need:
        refuse(sink, RejectReason::truncated, unread);
        pass(1);
        break;
      case Probe::Kind::bad:
        assert(found.length > 0 && found.length <= front.size());
        refuse(sink, found.reason, std::clamp<std::size_t>(found.length, 1, front.size()));
        pass(std::clamp<std::size_t>(found.advance, 1, unread));
        break;
      case Probe::Kind::frame: {
        assert(found.length > 0 && found.length <= front.size());
        const Outcome outcome = decode(front.first(found.length), offset_, sink);
        if (outcome.kind == Outcome::Kind::refused) {
          refuse(sink, outcome.reason, found.length);
          pass(std::clamp<std::size_t>(outcome.advance, 1, unread));
          break;
        }
        if (outcome.kind == Outcome::Kind::ignored) ++totals_.frames_ignored;
        covered_until_ = std::max(covered_until_, offset_ + found.length);
        pass(found.length);
        break;
      }
    }
  }
}

void Framer::pass(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i, ++head_, ++offset_) {
    if (offset_ < covered_until_) continue;
    const std::uint8_t byte = buffer_[head_];
    const bool line_end = byte == '\r' || byte == '\n';
    if (line_ends_ == LineEnds::belong_to_frames && line_end && offset_ == covered_until_ && offset_ > 0) {
      ++covered_until_;
    } else {
      ++totals_.skipped_bytes;
    }
  }
}

void Framer::refuse(Sink& sink, RejectReason reason, std::size_t length) {
  if (offset_ < refused_until_) return;
  refused_until_ = offset_ + length;
  covered_until_ = std::max(covered_until_, refused_until_);
  ++totals_.rejected;
  sink.on_rejected({reason, offset_, length, Bytes(buffer_).subspan(head_, length)});
}

void Framer::emit(Sink& sink, const AnySample& sample, const DeviceTime& time, std::uint64_t offset,
                  std::uint64_t length) {
  ++totals_.samples;
  sink.on_sample({sample, time, offset, length});
}

void Framer::compact() {
  if (head_ == 0) return;
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(head_));
  head_ = 0;
}

}  // namespace fathom::codec
