#include "codec/satellite/ubx_interference.hpp"

#include <algorithm>

#include "base/bytes/little_endian.hpp"

namespace fathom::codec {
namespace {

constexpr unsigned id_of(std::uint8_t message_class, std::uint8_t id) {
  return unsigned{message_class} << 8U | id;
}
constexpr unsigned kNavStatus = id_of(0x01, 0x03);
constexpr unsigned kMonHw = id_of(0x0A, 0x09);
constexpr unsigned kMonRf = id_of(0x0A, 0x38);
constexpr unsigned kSecSig = id_of(0x27, 0x09);

constexpr std::size_t kNavStatusLength = 16;
constexpr std::size_t kMonHwLength = 60;
constexpr std::size_t kMonHwLengthGeneration6 = 68;  // 25 pins in place of 17, behind the flags
constexpr std::size_t kMonRfHead = 4;
constexpr std::size_t kMonRfBlock = 24;
constexpr std::size_t kSecSigVersion1 = 12;
constexpr std::size_t kSecSigVersion2Head = 4;
constexpr std::size_t kSecSigVersion2Block = 4;

constexpr unsigned bits(std::uint8_t byte, unsigned from, unsigned count) {
  return unsigned{byte} >> from & ((1U << count) - 1U);
}

}  // namespace

std::optional<RejectReason> UbxInterference::note(Message message, unsigned jamming_state,
                                                  unsigned spoofing_state) {
  constexpr auto kWorst = static_cast<unsigned>(GpsSpoofing::affirmed);
  static_assert(kWorst == static_cast<unsigned>(GpsJamming::critical));
  if (jamming_state > kWorst || spoofing_state > kWorst) return RejectReason::field;
  said_[message] = {static_cast<GpsJamming>(jamming_state), static_cast<GpsSpoofing>(spoofing_state),
                    kFixesHeld};
  return std::nullopt;
}

std::optional<RejectReason> UbxInterference::read(std::uint8_t message_class, std::uint8_t id, Bytes p) {
  switch (id_of(message_class, id)) {
    case kNavStatus:
      if (p.size() != kNavStatusLength) return RejectReason::length;
      return note(nav_status, 0, bits(p[7], 3, 2));
    case kMonHw:
      if (p.size() != kMonHwLength && p.size() != kMonHwLengthGeneration6) return RejectReason::length;
      return note(mon_hw, bits(p[22], 2, 2), 0);
    case kMonRf: {
      if (p.size() < kMonRfHead || p.size() != kMonRfHead + p[1] * kMonRfBlock) return RejectReason::length;
      unsigned worst = 0;
      for (std::size_t at = kMonRfHead; at < p.size(); at += kMonRfBlock) {
        worst = std::max(worst, bits(p[at + 1], 0, 2));
      }
      return note(mon_rf, worst, 0);
    }
    case kSecSig:
      if (p.empty()) return RejectReason::length;
      if (p[0] == 1) {
        if (p.size() != kSecSigVersion1) return RejectReason::length;
        // Where a detection is switched off its state says nothing.
        return note(sec_sig, bits(p[4], 0, 1) != 0 ? bits(p[4], 1, 2) : 0,
                    bits(p[8], 0, 1) != 0 ? bits(p[8], 1, 3) : 0);
      }
      if (p[0] == 2) {
        if (p.size() < kSecSigVersion2Head || p.size() != kSecSigVersion2Head + p[3] * kSecSigVersion2Block) {
          return RejectReason::length;
        }
        return note(sec_sig, bits(p[1], 0, 1) != 0 ? bits(p[1], 1, 2) : 0,
                    bits(p[1], 3, 1) != 0 ? bits(p[1], 4, 3) : 0);
      }
      return std::nullopt;  // of a later version: not known what its bits mean
    default:
      return std::nullopt;
  }
}

void UbxInterference::stamp(GpsSample& fix) {
  for (Said& said : said_) {
    if (said.fixes_left == 0) continue;
    --said.fixes_left;
    fix.jamming = std::max(fix.jamming, said.jamming);
    fix.spoofing = std::max(fix.spoofing, said.spoofing);
  }
}

}  // namespace fathom::codec
