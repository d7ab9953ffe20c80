// A datagram before Fast DDS reads it: what is checked is what is heard in it, and nothing is read beyond its
// end.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "bus/detail/security/datagram_check.hpp"
#include "driver.hpp"
#include "support/rtps_datagram.hpp"

std::string_view fathom::fuzz::target_name() {
  return "datagram";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  namespace rtps = test::rtps;
  const auto key = rtps::parameter(0x0070, 16);
  const auto status = rtps::parameter(0x0071, 4);
  const auto end = rtps::parameter(1, 0);
  return rtps::datagram({rtps::submessage(rtps::kTimestamp, 8), rtps::data({key, status, end}, 40),
                         rtps::submessage(rtps::kHeartbeat, 28), rtps::data({key, end}, 100, true, -1, true),
                         rtps::data({}, 64, false), rtps::submessage(0x08, 28),
                         rtps::submessage(rtps::kStatistics, 24)});
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Exactly sized, so that a sanitizer sees every read beyond the end.
  const auto bytes = std::make_unique<std::uint8_t[]>(size);
  std::copy(data, data + size, bytes.get());
  const std::span<const std::uint8_t> datagram(bytes.get(), size);
  if (!fathom::bus::detail::harmless(datagram)) return 0;
  std::size_t claims = 0;
  const bool all = fathom::bus::detail::all_claims(datagram, [&claims](const auto&) {
    ++claims;
    return true;
  });
  if (!all || claims > size / 4) {
    (void)std::fprintf(stderr, "%zu claims in %zu bytes\n", claims, size);
    std::abort();
  }
  if (claims > 0) {
    std::size_t seen = 0;
    const bool until_no = fathom::bus::detail::all_claims(datagram, [&seen](const auto&) {
      ++seen;
      return false;
    });
    if (until_no || seen != 1) std::abort();
  }
  return 0;
}
