#include "sim/encode/dvl/pd0.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/bytes/little_endian.hpp"
#include "codec/dvl/pd0_geometry.hpp"
#include "codec/dvl/pd0_layout.hpp"

namespace fathom::sim::encode {
namespace {

namespace pd0_ = codec::pd0;

using Part = std::vector<std::uint8_t>;

constexpr double kDefaultBeamAngle_rad = 30.0 * std::numbers::pi / 180.0;
constexpr double kCentidegreesPerRad = 18'000.0 / std::numbers::pi;

Part part(std::uint16_t identifier, std::size_t length) {
  Part bytes(length, 0);
  bytes[0] = static_cast<std::uint8_t>(identifier & 0xFFU);
  bytes[1] = static_cast<std::uint8_t>(identifier >> 8);
  return bytes;
}

template <class T>
void store(Part& bytes, std::size_t at, T value) {
  Part raw;
  append_le<T>(raw, value);
  std::copy(raw.begin(), raw.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

/// Nearest integer inside [low, high]; `unknown_value` for not-a-number.
std::int64_t rounded(double value, std::int64_t low, std::int64_t high, std::int64_t unknown_value) {
  if (!known(value)) return unknown_value;
  return std::llround(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
}

double heading_0_to_360(double heading_rad) {
  const double turn = 2.0 * std::numbers::pi;
  const double folded = std::fmod(heading_rad, turn);
  return folded < 0.0 ? folded + turn : folded;
}

double beam_angle(const DvlSample& s) {
  return known(s.beam_angle_rad) ? s.beam_angle_rad : kDefaultBeamAngle_rad;
}

/// The four numbers of a velocity as PD0 records it: bottom or water relative to the DVL.
std::array<double, 4> recorded(const DvlSample& s, double heading_alignment_rad) {
  auto [forward, right, down] = s.velocity_D_m_s;
  const bool own_axes = s.recorded_frame == DvlFrame::beam || s.recorded_frame == DvlFrame::instrument;
  if (own_axes && heading_alignment_rad != 0.0) {
    const double c = std::cos(heading_alignment_rad);
    const double sn = std::sin(heading_alignment_rad);
    const double f = forward;
    forward = c * f + sn * right;
    right = -sn * f + c * right;
  }
  if (s.recorded_frame == DvlFrame::beam) {
    auto beams = codec::pd0::beams_from_frd({forward, right, down}, beam_angle(s));
    const bool any = std::any_of(s.beam_velocity_m_s.begin(), s.beam_velocity_m_s.end(), known);
    return any ? s.beam_velocity_m_s : beams;
  }
  std::array<double, 3> v{-right, -forward, down};  // starboard, forward, up of the bottom
  if (s.recorded_frame == DvlFrame::earth) {
    const auto R = codec::pd0::earth_from_ship(s.heading_rad, s.pitch_rad, s.roll_rad);
    const auto ship = v;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = R[3 * i] * ship[0] + R[3 * i + 1] * ship[1] + R[3 * i + 2] * ship[2];
    }
  }
  return {v[0], v[1], v[2], s.error_velocity_m_s};
}

Part fixed_leader(const DvlSample& s, double heading_alignment_rad) {
  Part bytes = part(pd0_::id::kFixedLeader, pd0_::fixed::kFull);
  const double degrees = beam_angle(s) * 180.0 / std::numbers::pi;
  const unsigned angle_code = degrees < 17.5 ? 0 : degrees < 25.0 ? 1 : 2;
  bytes[2] = 50;  // firmware
  bytes[3] = 40;
  store<std::uint16_t>(
      bytes, pd0_::fixed::kSystemConfiguration,
      static_cast<std::uint16_t>(0x4043U | pd0_::fixed::kConvex | angle_code << pd0_::fixed::kAngleShift));
  bytes[pd0_::fixed::kBeams] = 4;
  bytes[10] = 1;  // pings per ensemble
  bytes[pd0_::fixed::kCoordinates] = static_cast<std::uint8_t>(
      static_cast<unsigned>(s.recorded_frame) << pd0_::fixed::kFrameShift | pd0_::fixed::kTiltsUsed | 0x03U);
  store<std::int16_t>(
      bytes, pd0_::fixed::kHeadingAlignment,
      static_cast<std::int16_t>(rounded(heading_alignment_rad * kCentidegreesPerRad, -17'999, 18'000, 0)));
  bytes[30] = 0x7D;  // own sensors for everything but salinity
  bytes[31] = 0x3D;
  bytes[pd0_::fixed::kBeamAngle] = static_cast<std::uint8_t>(std::lround(degrees));
  return bytes;
}

Part variable_leader(const DvlSample& s, TimeNs clock_ns, std::uint32_t ensemble) {
  constexpr DurationNs kTick_ns = kNsPerSecond / 100;
  Part bytes = part(pd0_::id::kVariableLeader, pd0_::variable::kFull);
  store<std::uint16_t>(bytes, pd0_::variable::kEnsembleLow, static_cast<std::uint16_t>(ensemble & 0xFFFFU));
  bytes[pd0_::variable::kEnsembleHigh] = static_cast<std::uint8_t>(ensemble >> 16 & 0xFFU);
  const CivilTime civil = to_civil((clock_ns + kTick_ns / 2) / kTick_ns * kTick_ns);
  const std::array<int, 8> clock{
      civil.year / 100, civil.year % 100, civil.month,  civil.day,
      civil.hour,       civil.minute,     civil.second, static_cast<int>(civil.nanosecond / kTick_ns)};
  for (std::size_t i = 0; i < clock.size(); ++i) {
    bytes[pd0_::variable::kFullClock + i] = static_cast<std::uint8_t>(clock[i]);
    if (i > 0) bytes[pd0_::variable::kClock + i - 1] = static_cast<std::uint8_t>(clock[i]);
  }
  store<std::uint16_t>(bytes, pd0_::variable::kSoundSpeed,
                       static_cast<std::uint16_t>(rounded(s.sound_speed_m_s, 0, 65'535, 1500)));
  const double heading = known(s.heading_rad) ? heading_0_to_360(s.heading_rad) : kUnknown;
  store<std::uint16_t>(bytes, pd0_::variable::kHeading,
                       static_cast<std::uint16_t>(rounded(heading * kCentidegreesPerRad, 0, 35'999, 65'535)));
  store<std::int16_t>(bytes, pd0_::variable::kPitch,
                      static_cast<std::int16_t>(
                          rounded(s.pitch_rad * kCentidegreesPerRad, -9'000, 9'000, pd0_::kBadVelocity)));
  store<std::int16_t>(bytes, pd0_::variable::kRoll,
                      static_cast<std::int16_t>(
                          rounded(s.roll_rad * kCentidegreesPerRad, -18'000, 18'000, pd0_::kBadVelocity)));
  bytes[pd0_::variable::kSalinity] = 35;
  store<std::int16_t>(bytes, pd0_::variable::kTemperature, 1500);
  return bytes;
}

void store_velocity(Part& coarse, std::size_t at, Part& fine, std::size_t fine_at,
                    const std::array<double, 4>& v) {
  for (std::size_t i = 0; i < 4; ++i) {
    store<std::int16_t>(coarse, at + 2 * i,
                        static_cast<std::int16_t>(rounded(v[i] * 1e3, -32'767, 32'767, pd0_::kBadVelocity)));
    store<std::int32_t>(fine, fine_at + 4 * i,
                        static_cast<std::int32_t>(
                            rounded(-v[i] * 1e5, -2'000'000'000, 2'000'000'000, pd0_::kBadHighResolution)));
  }
}

}  // namespace

std::vector<std::uint8_t> pd0(const DvlSample& bottom, TimeNs clock_ns, const Pd0Options& options,
                              const DvlSample* water) {
  Part track = part(pd0_::id::kBottomTrack, pd0_::bottom::kFull);
  Part fine = part(pd0_::id::kHighResolution, pd0_::high_resolution::kFull);
  store<std::uint16_t>(track, pd0_::bottom::kPings, 1);
  track[pd0_::bottom::kMode] = 5;
  const auto velocity = recorded(bottom, options.heading_alignment_rad);
  store_velocity(track, pd0_::bottom::kVelocity, fine, pd0_::high_resolution::kVelocity, velocity);
  std::array<double, 4> layer{kUnknown, kUnknown, kUnknown, kUnknown};
  if (water != nullptr) {
    DvlSample in_same_axes = bottom;
    in_same_axes.velocity_D_m_s = water->velocity_D_m_s;
    in_same_axes.error_velocity_m_s = water->error_velocity_m_s;
    in_same_axes.beam_velocity_m_s = water->beam_velocity_m_s;
    layer = recorded(in_same_axes, options.heading_alignment_rad);
  }
  store_velocity(track, pd0_::bottom::kWaterVelocity, fine, pd0_::high_resolution::kWaterVelocity, layer);
  store<std::uint32_t>(fine, pd0_::high_resolution::kSoundSpeed,
                       static_cast<std::uint32_t>(
                           known(bottom.sound_speed_m_s) ? std::llround(bottom.sound_speed_m_s * 1e6) : 0));
  const bool any_range = std::any_of(bottom.beam_range_m.begin(), bottom.beam_range_m.end(), known);
  for (std::size_t i = 0; i < 4; ++i) {
    const double range_m = any_range ? bottom.beam_range_m[i] : bottom.altitude_m;
    const auto range_cm = static_cast<std::uint32_t>(rounded(range_m * 100.0, 0, 0xFF'FFFF, 0));
    store<std::uint16_t>(track, pd0_::bottom::kRange + 2 * i, static_cast<std::uint16_t>(range_cm & 0xFFFFU));
    track[pd0_::bottom::kRangeHigh + i] = static_cast<std::uint8_t>(range_cm >> 16);
    if (known(velocity[i])) {
      track[pd0_::bottom::kCorrelation + i] = 200;
      track[pd0_::bottom::kPercentGood + i] = 100;
    }
    if (water != nullptr) track[pd0_::bottom::kWaterPercentGood + i] = 100;
  }

  std::vector<Part> parts{fixed_leader(bottom, options.heading_alignment_rad),
                          variable_leader(bottom, clock_ns, options.ensemble), track};
  if (options.high_resolution) parts.push_back(fine);
  std::vector<std::uint8_t> bytes{pd0_::kSync, pd0_::kSync, 0, 0, 0, static_cast<std::uint8_t>(parts.size())};
  std::size_t offset = pd0_::kHeaderBytes + 2 * parts.size();
  for (const Part& p : parts) {
    append_le<std::uint16_t>(bytes, static_cast<std::uint16_t>(offset));
    offset += p.size();
  }
  for (const Part& p : parts) bytes.insert(bytes.end(), p.begin(), p.end());
  store<std::uint16_t>(bytes, 2, static_cast<std::uint16_t>(bytes.size()));
  std::uint16_t sum = 0;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint16_t>(sum + byte);
  append_le<std::uint16_t>(bytes, sum);
  return bytes;
}

}  // namespace fathom::sim::encode
