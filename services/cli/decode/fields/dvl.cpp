#include "samples/dvl.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {
namespace {

std::string_view word(DvlFrame frame) {
  constexpr std::array<std::string_view, 4> kWords{"beam", "instrument", "ship", "earth"};
  return kWords.at(static_cast<std::size_t>(frame));
}

}  // namespace

template <>
void add_fields(Json& line, const DvlSample& s) {
  line["frame"] = word(s.recorded_frame);
  line["mode"] = s.mode == DvlMode::bottom ? "bottom" : "water";
  line["vx_m_s"] = s.velocity_D_m_s[0];
  line["vy_m_s"] = s.velocity_D_m_s[1];
  line["vz_m_s"] = s.velocity_D_m_s[2];
  line["valid"] = {known(s.velocity_D_m_s[0]), known(s.velocity_D_m_s[1]), known(s.velocity_D_m_s[2])};
  line["error_velocity_m_s"] = s.error_velocity_m_s;
  line["sigma_m_s"] = s.sigma_m_s;
  for (std::size_t i = 0; i < 4; ++i) line["b" + std::to_string(i + 1) + "_m_s"] = s.beam_velocity_m_s[i];
  for (std::size_t i = 0; i < 4; ++i) line["range" + std::to_string(i + 1) + "_m"] = s.beam_range_m[i];
  line["altitude_m"] = s.altitude_m;
  line["sound_speed_m_s"] = s.sound_speed_m_s;
  line["beam_angle_deg"] = degrees(s.beam_angle_rad);
  line["roll_deg"] = degrees(s.roll_rad);
  line["pitch_deg"] = degrees(s.pitch_rad);
  line["heading_deg"] = degrees(s.heading_rad);
}

}  // namespace fathom::cli
