#include "mavlink/frame.hpp"

#include <algorithm>

#include "base/bytes/little_endian.hpp"
#include "mavlink/known.hpp"

namespace fathom::mavlink {

Look look_at(Bytes front) {
  const bool v2 = front[0] == kMagicV2;
  if (!v2 && front[0] != kMagicV1) {
    const auto next = std::find_if(front.begin(), front.end(),
                                   [](std::uint8_t byte) { return byte == kMagicV1 || byte == kMagicV2; });
    return {Look::Kind::skip, static_cast<std::size_t>(next - front.begin())};
  }
  const std::size_t header = v2 ? kHeaderV2 : kHeaderV1;
  if (front.size() < header) return {Look::Kind::need, header};
  // Of flags that we do not know we do not know what they do to the frame.
  if (v2 && (front[2] & ~kFlagSigned) != 0) return {Look::Kind::skip, 1};
  Frame frame;
  frame.is_signed = v2 && (front[2] & kFlagSigned) != 0;
  const std::size_t at = v2 ? 4 : 2;
  frame.sequence = front[at];
  frame.system = front[at + 1];
  frame.component = front[at + 2];
  frame.id = front[at + 3];
  if (v2)
    frame.id |= static_cast<std::uint32_t>(front[8]) << 8U | static_cast<std::uint32_t>(front[9]) << 16U;
  const Known* known = find_known(frame.id);
  if (known == nullptr) return {Look::Kind::skip, 1};
  const std::size_t payload = front[1];
  if (payload > known->longest) return {Look::Kind::length, header};
  const std::size_t checked = header + payload;
  const std::size_t total = checked + kChecksum + (frame.is_signed ? kSignature : 0);
  if (front.size() < total) return {Look::Kind::need, total};
  const std::uint16_t crc = crc_with(known->crc_extra, crc_of(front.subspan(1, checked - 1)));
  if (crc != load_le<std::uint16_t>(front, checked)) return {Look::Kind::checksum, total};
  frame.whole = front.first(total);
  frame.payload = front.subspan(header, payload);
  return {Look::Kind::frame, total, frame};
}

std::vector<std::uint8_t> frame_of(std::uint32_t id, std::uint8_t crc_extra, Bytes payload,
                                   const Sender& sender, std::uint8_t sequence, std::uint8_t flags) {
  while (payload.size() > 1 && payload.back() == 0) payload = payload.first(payload.size() - 1);
  std::vector<std::uint8_t> out;
  out.reserve(kMostFrame);
  for (const std::size_t byte :
       {std::size_t{kMagicV2}, payload.size(), std::size_t{flags}, std::size_t{0}, std::size_t{sequence},
        std::size_t{sender.system}, std::size_t{sender.component}, std::size_t{id & 0xFFU},
        std::size_t{id >> 8U & 0xFFU}, std::size_t{id >> 16U & 0xFFU}})
    out.push_back(static_cast<std::uint8_t>(byte));
  out.insert(out.end(), payload.begin(), payload.end());
  append_le<std::uint16_t>(out, crc_with(crc_extra, crc_of(Bytes(out).subspan(1))));
  return out;
}

}  // namespace fathom::mavlink
