#include "codec/imu/vectornav_layout.hpp"

#include "base/bytes/little_endian.hpp"

namespace fathom::codec::vectornav {
namespace {

// Bytes per field and group, in the order of the mask's bits; 0: no such field. The two satellite lists of
// the GNSS groups start with this many bytes and go on for as long as their own count says.
constexpr std::size_t kSatelliteList = 14;
constexpr std::size_t kRawMeasurements = 15;
constexpr std::array<std::uint8_t, 16> kGnss{8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 2, 12};
constexpr std::array<std::array<std::uint8_t, 16>, kGroups> kSizes{{
    {8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8, 0},
    {8, 8, 8, 2, 8, 8, 8, 4, 4, 1, 0, 0, 0, 0, 0, 0},
    {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 40, 0, 0, 0},
    kGnss,
    {2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24, 12, 0, 0, 0},
    {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64, 0, 0, 0},
    kGnss,
}};

}  // namespace

Layout read_layout(std::span<const std::uint8_t> front) {
  Layout layout;
  if (front.size() < layout.length) return layout;
  const std::uint8_t groups = front[1];
  if (groups == 0 || groups >= 1U << kGroups) {
    layout.state = Layout::State::unknown_field;
    return layout;
  }
  std::size_t mask_at = 2;
  std::size_t offset = 2 + 2 * static_cast<std::size_t>(std::popcount(groups));
  const std::size_t header = offset;
  layout.length = header;
  if (front.size() < layout.length) return layout;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if ((groups >> group & 1U) == 0) continue;
    const auto mask = load_le<std::uint16_t>(front, mask_at);
    mask_at += 2;
    for (std::size_t field = 0; field < 16; ++field) {
      if ((mask >> field & 1U) == 0) continue;
      const std::size_t size = kSizes[group][field];
      if (size == 0) {
        // The masks are all that is known to be here, however much of the frame has arrived.
        layout.state = Layout::State::unknown_field;
        layout.length = header;
        return layout;
      }
      layout.at[group][field] = offset;
      offset += size;
      layout.length = offset;
      const bool is_gnss = group == Group::gnss1 || group == Group::gnss2;
      if (is_gnss && (field == kSatelliteList || field == kRawMeasurements)) {
        if (front.size() < offset) return layout;
        const std::size_t start = layout.at[group][field];
        offset += field == kSatelliteList ? 8U * front[start] : 28U * front[start + 10];
        layout.length = offset;
      }
    }
  }
  layout.length = offset + kCrcBytes;
  if (front.size() >= layout.length) layout.state = Layout::State::complete;
  return layout;
}

}  // namespace fathom::codec::vectornav
