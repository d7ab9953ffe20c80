#include "sim/encode/ubx.hpp"

#include <bit>

#include "base/bytes/little_endian.hpp"
#include "codec/fletcher.hpp"
#include "codec/satellite/ubx.hpp"
#include "sim/encode/pvt.hpp"

namespace fathom::sim::encode {
std::vector<std::uint8_t> ubx_frame(std::uint8_t message_class, std::uint8_t message_id,
                                    std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> frame;
  frame.reserve(payload.size() + 8);
  for (const std::uint8_t byte : {codec::kUbxSync1, codec::kUbxSync2, message_class, message_id}) {
    frame.push_back(byte);
  }
  append_le<std::uint16_t>(frame, static_cast<std::uint16_t>(payload.size()));
  frame.insert(frame.end(), payload.begin(), payload.end());
  const auto [a, b] = codec::fletcher8(std::span<const std::uint8_t>(frame).subspan(2));
  frame.push_back(a);
  frame.push_back(b);
  return frame;
}

std::vector<std::uint8_t> ubx_nav_pvt(const GpsSample& sample, TimeNs utc_ns) {
  constexpr std::size_t kSatellitesAt = 23;
  std::vector<std::uint8_t> p = pvt_fields(sample, utc_ns, std::endian::little, kSatellitesAt);
  append_le<std::uint32_t>(p, 0);  // accuracy of the heading
  append_le<std::uint16_t>(p, pvt_dilution(sample.hdop));
  const bool located = sample.fix >= GpsFix::dead_reckoning;
  p.push_back(located ? 0 : 1);  // invalidLlh
  p.resize(92, 0);
  return ubx_frame(0x01, 0x07, p);
}

}  // namespace fathom::sim::encode
