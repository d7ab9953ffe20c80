#include "sim/encode/dvl/waterlinked.hpp"

#include <array>
#include <charconv>

namespace fathom::sim::encode {
namespace {

void append(std::string& out, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// The number, or `otherwise` where it is not known: the instrument has no word for unknown.
void append_or(std::string& out, double value, double otherwise) {
  append(out, known(value) ? value : otherwise);
}

}  // namespace

std::string waterlinked(const DvlSample& s, const WaterLinkedTimes& times) {
  const auto& v = s.velocity_D_m_s;
  const bool valid = known(v[0]) && known(v[1]) && known(v[2]);
  const bool bottom = s.mode == DvlMode::bottom;
  std::string out = "{\"time\":";
  append_or(out, times.since_last_ms, 0.0);
  constexpr std::array<const char*, 3> kAxes{",\"vx\":", ",\"vy\":", ",\"vz\":"};
  for (std::size_t i = 0; i < 3; ++i) append_or(out += kAxes[i], v[i], 0.0);
  append_or(out += ",\"fom\":", s.sigma_m_s, 0.0);
  out += ",\"covariance\":[";
  for (std::size_t row = 0; row < 3; ++row) {
    out += row == 0 ? "[" : ",[";
    for (std::size_t column = 0; column < 3; ++column) {
      if (column > 0) out += ',';
      append_or(out, row == column ? s.sigma_m_s * s.sigma_m_s : 0.0, 0.0);
    }
    out += ']';
  }
  out += ']';
  if (bottom) {
    append_or(out += ",\"altitude\":", s.altitude_m, -1.0);
    out += ",\"transducers\":[";
    for (std::size_t i = 0; i < 4; ++i) {
      out += i == 0 ? "{\"id\":" : ",{\"id\":";
      out += std::to_string(i);
      append_or(out += ",\"velocity\":", s.beam_velocity_m_s[i], 0.0);
      append_or(out += ",\"distance\":", s.beam_range_m[i], -1.0);
      out += ",\"rssi\":-40,\"nsd\":-95,\"beam_valid\":";
      out += known(s.beam_velocity_m_s[i]) ? "true}" : "false}";
    }
    out += ']';
  }
  out += ",\"velocity_valid\":";
  out += valid ? "true" : "false";
  out += ",\"status\":0,\"format\":\"json_v3.1\",\"type\":\"";
  out += bottom ? "velocity" : "velocity_water";
  out += "\",\"time_of_validity\":" + std::to_string(times.valid_ns / 1'000);
  out += ",\"time_of_transmission\":" + std::to_string(times.sent_ns / 1'000) + "}\r\n";
  return out;
}

}  // namespace fathom::sim::encode
