#include "fusion/replica/state_parts.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fathom::fusion {

bool send_in_parts(EngineStatePart head, std::span<const std::byte> bytes,
                   const std::function<void(const EngineStatePart&)>& send) {
  const std::size_t parts = (bytes.size() + EngineStatePart::kBytes - 1) / EngineStatePart::kBytes;
  if (parts == 0 || parts > kMostParts) return false;
  head.parts = static_cast<std::uint32_t>(parts);
  for (head.part = 0; head.part < head.parts; ++head.part) {
    const auto piece = bytes.first(std::min(bytes.size(), EngineStatePart::kBytes));
    bytes = bytes.subspan(piece.size());
    head.size = static_cast<std::uint32_t>(piece.size());
    std::memcpy(head.bytes.data(), piece.data(), piece.size());
    ++head.header.sequence;
    send(head);
  }
  return true;
}

std::optional<StateAssembler::Whole> StateAssembler::add(const EngineStatePart& part,
                                                         const WriterGuid& writer) {
  const bool sane = part.parts > 0 && part.parts <= kMostParts && part.part < part.parts && part.size > 0 &&
                    part.size <= EngineStatePart::kBytes;
  if (!sane) return std::nullopt;
  if (part.part == 0) {
    writer_ = writer;
    whole_.head = part;
    whole_.bytes.clear();
    next_ = 0;
  }
  const bool follows = writer == writer_ && part.transfer == whole_.head.transfer &&
                       part.parts == whole_.head.parts && part.part == next_;
  if (!follows) return std::nullopt;
  const auto* bytes = reinterpret_cast<const std::byte*>(part.bytes.data());
  whole_.bytes.insert(whole_.bytes.end(), bytes, bytes + part.size);
  if (++next_ < part.parts) return std::nullopt;
  return std::exchange(whole_, {});
}

}  // namespace fathom::fusion
