#include "sim/encode/dvl/pd6.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/units.hpp"
#include "codec/dvl/pd0_geometry.hpp"
#include "sim/encode/decimal.hpp"

namespace fathom::sim::encode {
namespace {

using Pd6Axes = std::array<double, 3>;

template <class... Values>
void print_pd6(std::string& out, const char* format, Values... values) {
  std::array<char, 160> text{};
  const int length = std::snprintf(text.data(), text.size(), format, values...);
  out.append(text.data(), static_cast<std::size_t>(std::clamp(length, 0, 159)));
}

/// Three components and, where given, the error velocity, in mm/s, and the status.
void print_velocity(std::string& out, char layer, char frame, const Pd6Axes& v_m_s, const double* error_m_s) {
  constexpr int kBad = -32'768;
  const bool good = known(v_m_s[0]) && known(v_m_s[1]) && known(v_m_s[2]);
  const auto field = [&](double value_m_s) {
    const double value_mm_s = std::clamp(value_m_s * 1e3, -32'767.0, 32'767.0);
    print_pd6(out, ",%+6d", good && known(value_m_s) ? static_cast<int>(std::lround(value_mm_s)) : kBad);
  };
  print_pd6(out, ":%c%c", layer, frame);
  for (const double value_m_s : v_m_s) field(value_m_s);
  if (error_m_s != nullptr) field(*error_m_s);
  out += good ? ",A\r\n" : ",V\r\n";
}

/// The velocity of `s` in the frames that `bottom` asks for, whose attitude is that of both.
void print_layer(std::string& out, char layer, const DvlSample& s, const DvlSample& bottom,
                 double heading_alignment_rad) {
  const auto& [forward, right, down] = s.velocity_D_m_s;
  const double c = std::cos(heading_alignment_rad);
  const double sn = std::sin(heading_alignment_rad);
  const Pd6Axes instrument{-sn * forward + c * right, c * forward + sn * right, -down};
  const Pd6Axes ship{right, forward, -down};
  const auto R = codec::pd0::earth_from_ship(bottom.heading_rad, bottom.pitch_rad, bottom.roll_rad);
  Pd6Axes earth{};
  for (std::size_t i = 0; i < 3; ++i) {
    earth[i] = R[3 * i] * ship[0] + R[3 * i + 1] * ship[1] + R[3 * i + 2] * ship[2];
  }
  if (bottom.recorded_frame < DvlFrame::ship)
    print_velocity(out, layer, 'I', instrument, &s.error_velocity_m_s);
  if (bottom.recorded_frame < DvlFrame::earth) print_velocity(out, layer, 'S', ship, nullptr);
  print_velocity(out, layer, 'E', earth, nullptr);
}

void print_distance(std::string& out, char layer, double range_m) {
  print_pd6(out, ":%cD,%+13.2f,%+13.2f,%+13.2f,%7.2f,%6.2f\r\n", layer, 0.0, 0.0, 0.0,
            std::clamp(range_m, 0.0, 9'999.0), 0.0);
}

}  // namespace

std::string pd6(const DvlSample& bottom, TimeNs clock_ns, double heading_alignment_rad,
                const DvlSample* water) {
  constexpr DurationNs kTick_ns = kNsPerSecond / 100;
  constexpr double kWaterLayer_m = 20.0;
  const CivilTime civil = to_civil((clock_ns + kTick_ns / 2) / kTick_ns * kTick_ns);
  std::string out;
  print_pd6(out, ":SA,%+7.2f,%+7.2f,%6.2f\r\n", zero_if_unknown(bottom.pitch_rad) * kDegPerRad,
            zero_if_unknown(bottom.roll_rad) * kDegPerRad, zero_if_unknown(bottom.heading_rad) * kDegPerRad);
  print_pd6(out, ":TS,%02d%02d%02d%02d%02d%02d%02d,35.0, +15.0,   0.0,%6.1f,  0\r\n", civil.year % 100,
            civil.month, civil.day, civil.hour, civil.minute, civil.second,
            static_cast<int>(civil.nanosecond / kTick_ns),
            known(bottom.sound_speed_m_s) ? bottom.sound_speed_m_s : 1'500.0);
  if (water != nullptr) {
    print_layer(out, 'W', *water, bottom, heading_alignment_rad);
    print_distance(out, 'W', kWaterLayer_m);
  }
  print_layer(out, 'B', bottom, bottom, heading_alignment_rad);
  print_distance(out, 'B', zero_if_unknown(bottom.altitude_m));
  return out;
}

}  // namespace fathom::sim::encode
