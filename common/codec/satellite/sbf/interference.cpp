#include "codec/satellite/sbf/interference.hpp"

#include <cstdlib>

#include "base/bytes/little_endian.hpp"

namespace fathom::codec::sbf {

std::optional<RejectReason> SbfInterference::read(Bytes block) {
  constexpr std::size_t kBandsAt = 20;
  constexpr std::size_t kBandLength = 7;  // it only grows at its end
  constexpr std::size_t kInfoAt = 6;
  constexpr unsigned kCancelled = 2;
  constexpr unsigned kNotMitigated = 8;
  constexpr unsigned kSuspected = 1U << 0U;
  constexpr unsigned kAuthenticationFailed = 1U << 1U;
  Said said;
  if (const auto why = read_instant(block, said.at)) return why;
  if (block.size() < kBandsAt) return RejectReason::length;
  const std::size_t bands = block[14];
  const std::size_t band_length = block[15];
  if (bands > 0 && (band_length < kBandLength || block.size() < kBandsAt + bands * band_length))
    return RejectReason::structure;
  for (std::size_t i = 0; i < bands; ++i) {
    const unsigned mode = block[kBandsAt + i * band_length + kInfoAt] & 0xFU;
    said.unmitigated = said.unmitigated || mode == kNotMitigated;
    said.interfered = said.interfered || mode == kNotMitigated || mode == kCancelled;
  }
  constexpr unsigned kBoth = kSuspected | kAuthenticationFailed;
  const unsigned signs = block[16] & kBoth;
  if (signs != 0) said.spoofing = signs == kBoth ? GpsSpoofing::affirmed : GpsSpoofing::indicated;
  said_ = said;
  return std::nullopt;
}

void SbfInterference::stamp(GpsSample& fix, const GpsInstant& at) {
  if (!said_) return;
  const bool timed = at && said_->at;
  if (timed ? std::abs(*at - *said_->at) > kHolds_ns : said_->fixes_left-- <= 0) {
    said_.reset();
    return;
  }
  fix.spoofing = said_->spoofing;
  fix.jamming = GpsJamming::none;
  if (said_->interfered)
    fix.jamming = said_->unmitigated && fix.fix == GpsFix::none ? GpsJamming::critical : GpsJamming::warning;
}

}  // namespace fathom::codec::sbf
