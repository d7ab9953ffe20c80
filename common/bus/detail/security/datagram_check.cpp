#include "bus/detail/security/datagram_check.hpp"

#include <algorithm>
#include <optional>

namespace fathom::bus::detail {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kHeader = 20;  // "RTPS", version, vendor, GUID prefix
constexpr std::size_t kVendor = 6;
constexpr std::size_t kPrefix = 8;
constexpr std::uint8_t kFastDds[] = {0x01, 0x0F};

constexpr std::uint8_t kPad = 0x01;
constexpr std::uint8_t kAcknack = 0x06;
constexpr std::uint8_t kHeartbeat = 0x07;
constexpr std::uint8_t kGap = 0x08;
constexpr std::uint8_t kInfoTimestamp = 0x09;
constexpr std::uint8_t kData = 0x15;
constexpr std::uint8_t kDataFragment = 0x16;
constexpr std::uint8_t kSendersStatistics = 0x80;

constexpr std::uint8_t kFinal = 0x02;  // a flag: no answer is expected

constexpr std::uint16_t kSentinel = 0x0001;

// ACKNACK: the reader's and the writer's id, and then
constexpr std::size_t kBase = 8;
constexpr std::size_t kBits = 16;  // how many there are, and then they themselves, in words, and the count
constexpr std::size_t kWords = 20;

constexpr std::size_t to_words(std::size_t bytes) {
  return (bytes + 3) & ~std::size_t{3};
}

/// One submessage.
class Submessage {
 public:
  Submessage(std::uint8_t id, std::uint8_t flags, Bytes content)
      : id_(id), flags_(flags), content_(content) {}

  [[nodiscard]] std::uint8_t id() const { return id_; }
  [[nodiscard]] std::size_t size() const { return content_.size(); }
  [[nodiscard]] bool has_inline_qos() const { return (flags_ & 0x02U) != 0; }
  [[nodiscard]] std::uint16_t u16(std::size_t at) const {
    const auto first = static_cast<unsigned>(content_[at]);
    const auto second = static_cast<unsigned>(content_[at + 1]);
    return static_cast<std::uint16_t>(little() ? second << 8U | first : first << 8U | second);
  }
  /// A sequence number.
  [[nodiscard]] std::uint64_t number(std::size_t at) const {
    return static_cast<std::uint64_t>(u32(at)) << 32U | u32(at + 4);
  }
  [[nodiscard]] Bytes bytes(std::size_t at, std::size_t count) const { return content_.subspan(at, count); }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const {
    const std::uint32_t first = u16(at);
    const std::uint32_t second = u16(at + 2);
    return little() ? second << 16U | first : first << 16U | second;
  }

 private:
  [[nodiscard]] bool little() const { return (flags_ & 0x01U) != 0; }

  std::uint8_t id_;
  std::uint8_t flags_;
  Bytes content_;
};

/// A list of parameters that begins at `at` ends within the submessage, its sentinel included.
bool parameters_end(const Submessage& submessage, std::size_t at) {
  while (at + 4 <= submessage.size()) {
    const std::uint16_t parameter = submessage.u16(at);
    const std::size_t length = submessage.u16(at + 2);
    at += 4;
    if (parameter == kSentinel) return true;
    at += to_words(length);
  }
  return false;
}

/// DATA or DATA_FRAG: nothing of it lies behind its end.
bool holds_together(const Submessage& data) {
  constexpr std::size_t kBeforeOffset = 4;  // extra flags, and the offset itself, which counts from its end
  const std::size_t fixed = data.id() == kData ? 16 : 28;
  if (data.size() < kBeforeOffset + fixed) return false;
  const std::size_t offset = data.u16(2);
  if (offset < fixed || kBeforeOffset + offset > data.size()) return false;
  return !data.has_inline_qos() || parameters_end(data, kBeforeOffset + offset);
}

bool is_part_of_its_sample(const Submessage& fragment) {
  const std::uint64_t first = fragment.u32(20);
  const std::uint64_t count = fragment.u16(24);
  const std::uint64_t size = fragment.u16(26);
  const std::uint64_t sample = fragment.u32(28);
  return first > 0 && count > 0 && size > 0 && (first + count - 2) * size < sample;
}

bool harmless(const Submessage& submessage, bool last, bool from_fast_dds) {
  switch (submessage.id()) {
    case kData:
      return holds_together(submessage);
    case kDataFragment:
      return holds_together(submessage) && is_part_of_its_sample(submessage);
    case kSendersStatistics:
      return last || !from_fast_dds;
    default:
      return true;
  }
}

/// What it says of a writer's samples, but for the writer's participant; nothing when it says none.
std::optional<Claim> claim_of(const Submessage& one) {
  std::size_t reader = 0;  // where its id is, and then the writer's, and a number of a sample
  switch (one.id()) {
    case kData:
    case kDataFragment:
      reader = 4;
      break;
    case kHeartbeat:
    case kGap:
      break;
    default:
      return std::nullopt;
  }
  const std::size_t number = reader + 8;
  const bool one_number = reader != 0;
  if (one.size() < number + (one_number ? 8 : 16)) return std::nullopt;
  Claim claim;
  claim.carries_sample = one_number;
  claim.reader = to_entity_id(one.bytes(reader, 4));
  const Bytes writer = one.bytes(reader + 4, 4);
  std::copy_n(writer.begin(), 4, claim.writer.begin() + 12);
  claim.number = one.number(one_number ? number : number + 8);
  // The first that a heartbeat says it has may be one behind the last, when there is none.
  if (one.id() == kHeartbeat) claim.number = std::max(claim.number, one.number(number));
  return claim;
}

/// Where the count of an ACKNACK is, which holds together; nothing when it does not.
std::optional<std::size_t> place_of_count(const Submessage& one) {
  if (one.id() != kAcknack || one.size() < kWords + 4) return std::nullopt;
  const std::size_t words = (std::size_t{one.u32(kBits)} + 31) / 32;
  const std::size_t at = kWords + 4 * words;
  return at + 4 <= one.size() ? std::optional(at) : std::nullopt;
}

/// Calls `look(submessage, is_last)` for each that Fast DDS reads, until one call returns false, which it
/// returns.
template <class Look>
bool all_submessages(Bytes datagram, const Look& look) {
  std::size_t at = kHeader;
  while (at + 4 <= datagram.size()) {
    const Submessage head(datagram[at], datagram[at + 1], datagram.subspan(at, 4));
    at += 4;
    std::size_t length = head.u16(2);
    if (at + length > datagram.size()) return true;  // Fast DDS reads no further
    if (length == 0 && head.id() != kInfoTimestamp && head.id() != kPad) length = datagram.size() - at;
    const Submessage whole(head.id(), datagram[at - 3], datagram.subspan(at, length));
    if (!look(whole, at + length == datagram.size())) return false;
    at += to_words(length);
  }
  return true;
}

}  // namespace

bool harmless(Bytes datagram) {
  if (datagram.size() < kHeader) return true;
  const bool from_fast_dds = datagram[kVendor] == kFastDds[0] && datagram[kVendor + 1] == kFastDds[1];
  return all_submessages(datagram, [&](const Submessage& submessage, bool last) {
    return harmless(submessage, last, from_fast_dds);
  });
}

bool all_claims(Bytes datagram, const std::function<bool(const Claim&)>& look) {
  if (datagram.size() < kHeader) return true;
  return all_submessages(datagram, [&](const Submessage& one, bool /*last*/) {
    auto claim = claim_of(one);
    if (!claim) return true;
    std::copy_n(datagram.begin() + kPrefix, 12, claim->writer.begin());
    return look(*claim);
  });
}

void all_acknowledgements(Bytes datagram, const std::function<void(const Acknowledgement&)>& look) {
  if (datagram.size() < kHeader) return;
  (void)all_submessages(datagram, [&](const Submessage& one, bool /*last*/) {
    const auto count = place_of_count(one);
    if (!count) return true;
    Acknowledgement out;
    std::copy_n(datagram.begin() + kPrefix, 12, out.reader.begin());
    const Bytes reader = one.bytes(0, 4);
    std::copy_n(reader.begin(), 4, out.reader.begin() + 12);
    out.writer = to_entity_id(one.bytes(4, 4));
    out.base = one.number(kBase);
    out.count = one.u32(*count);
    out.at = static_cast<std::size_t>(reader.data() - datagram.data());
    look(out);
    return true;
  });
}

void begin_anew(std::span<std::uint8_t> datagram, const Acknowledgement& one) {
  constexpr std::size_t kBeforeContent = 4;
  const Submessage before(kAcknack, datagram[one.at - kBeforeContent + 1], datagram.subspan(one.at));
  const auto count = place_of_count(before);
  if (!count) return;
  datagram[one.at - kBeforeContent + 1] &= static_cast<std::uint8_t>(~kFinal);
  const auto content = datagram.begin() + static_cast<std::ptrdiff_t>(one.at);
  std::fill(content + kBase, content + kWords, std::uint8_t{0});
  std::copy_n(content + static_cast<std::ptrdiff_t>(*count), 4, content + kWords);
}

}  // namespace fathom::bus::detail
