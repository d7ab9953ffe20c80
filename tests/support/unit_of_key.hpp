#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace fathom::test {

/// The unit that a key promises by its ending; nothing where it promises none.
inline std::optional<std::string_view> unit_of_key(std::string_view key) {
  // Longer endings first.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 26> kEndings{
      {{"bytes_per_s", "bytes/s"},
       {"_m_s_sqrt_h", "m/s/sqrt(h)"},
       {"_m_s_sqrt_s", "m/s/sqrt(s)"},
       {"_rad_sqrt_s", "rad/sqrt(s)"},
       {"_deg_sqrt_h", "deg/sqrt(h)"},
       {"_m_s_per_rpm", "m/s/rpm"},
       {"_m_sqrt_s", "m/sqrt(s)"},
       {"_m2_s2", "m^2/s^2"},
       {"_m_s2", "m/s^2"},
       {"_deg_s", "deg/s"},
       {"_deg_h", "deg/h"},
       {"_m_s", "m/s"},
       {"_rad_s", "rad/s"},
       {"_kg_m", "kg/m"},
       {"_1_m", "1/m"},
       {"_rad", "rad"},
       {"_deg", "deg"},
       {"_ns", "ns"},
       {"_ms", "ms"},
       {"_hz", "Hz"},
       {"_Pa", "Pa"},
       {"_ppm", "ppm"},
       {"_mg", "mg"},
       {"_mrad", "mrad"},
       {"_m", "m"},
       {"_s", "s"}}};
  for (const auto& [ending, unit] : kEndings) {
    if (key.ends_with(ending)) return unit;
  }
  return std::nullopt;
}

}  // namespace fathom::test
