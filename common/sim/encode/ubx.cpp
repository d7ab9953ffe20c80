#include "sim/encode/ubx.hpp"

#include <bit>
#include <cmath>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/gps_time.hpp"
#include "codec/satellite/ubx.hpp"
#include "sim/encode/pvt.hpp"
#include "sim/encode/true_heading.hpp"

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

std::vector<std::uint8_t> ubx_nav_relposned(const HeadingSample& sample, TimeNs utc_ns) {
  constexpr std::uint32_t kMovingBase = 0x25 | 2U << 3U;  // fix, valid, fixed carrier phase, moving base
  constexpr std::uint32_t kHeadingValid = 1U << 8U;
  constexpr std::uint32_t kBaseline_cm = 100;
  const auto unit = [](double angle_rad) { return std::llround(angle_rad * kDegPerRad * 1e5); };
  const double heading_rad = true_heading_rad(sample);
  const bool known_heading = known(heading_rad);
  std::vector<std::uint8_t> p(64, 0);
  p[0] = 1;
  store_le<std::uint32_t>(p, 4, codec::time_of_week_ms(utc_ns));
  store_le<std::uint32_t>(p, 20, kBaseline_cm);
  if (known_heading) store_le<std::int32_t>(p, 24, static_cast<std::int32_t>(unit(heading_rad)));
  if (known(sample.sigma_rad))
    store_le<std::uint32_t>(p, 52, static_cast<std::uint32_t>(unit(sample.sigma_rad)));
  store_le<std::uint32_t>(p, 60, known_heading ? kMovingBase | kHeadingValid : kMovingBase);
  return ubx_frame(0x01, 0x3C, p);
}

}  // namespace fathom::sim::encode
