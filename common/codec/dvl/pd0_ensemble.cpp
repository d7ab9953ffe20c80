#include "codec/dvl/pd0_ensemble.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "base/bytes/little_endian.hpp"
#include "codec/dvl/pd0_layout.hpp"

namespace fathom::codec::pd0 {
namespace {

using Part = std::span<const std::uint8_t>;  ///< one data type, identifier included

constexpr double kRadPerCentidegree = std::numbers::pi / 18'000.0;
constexpr double kPerMillimetre = 1e3;  // divided by, so that 0.478 reads 0.478

/// The data types of an ensemble that are read; empty where absent.
struct Parts {
  Part fixed, variable, bottom, navigation, high_resolution, range;
};

/// Nothing when the offset table contradicts itself.
std::optional<Parts> split(std::span<const std::uint8_t> bytes) {
  const std::size_t end = load_le<std::uint16_t>(bytes, 2);
  const std::size_t count = bytes[5];
  std::size_t floor = kHeaderBytes + 2 * count;
  if (count == 0 || floor + 2 > end) return std::nullopt;
  Parts parts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t start = load_le<std::uint16_t>(bytes, kHeaderBytes + 2 * i);
    const std::size_t next = i + 1 < count ? load_le<std::uint16_t>(bytes, kHeaderBytes + 2 * (i + 1)) : end;
    if (start < floor || start + 2 > end || next < start + 2 || next > end) return std::nullopt;
    floor = start + 2;
    const Part part = bytes.subspan(start, next - start);
    switch (load_le<std::uint16_t>(part, 0)) {
      case id::kFixedLeader:
        parts.fixed = part;
        break;
      case id::kVariableLeader:
        parts.variable = part;
        break;
      case id::kBottomTrack:
        parts.bottom = part;
        break;
      case id::kNavigation:
        parts.navigation = part;
        break;
      case id::kHighResolution:
        parts.high_resolution = part;
        break;
      case id::kRange:
        parts.range = part;
        break;
      default:
        break;
    }
  }
  return parts;
}

std::optional<TimeNs> read_clock(Part part) {
  const bool full = part.size() >= variable::kFull && part[variable::kFullClock] != 0;
  const std::size_t at = full ? variable::kFullClock + 1 : variable::kClock;
  CivilTime civil;
  // Without century: instruments of this kind exist since the eighties.
  civil.year = full            ? 100 * part[variable::kFullClock] + part[at]
               : part[at] < 80 ? 2000 + part[at]
                               : 1900 + part[at];
  civil.month = part[at + 1];
  civil.day = part[at + 2];
  civil.hour = part[at + 3];
  civil.minute = part[at + 4];
  civil.second = part[at + 5];
  if (part[at + 6] > 99) return std::nullopt;
  civil.nanosecond = part[at + 6] * (kNsPerSecond / 100);
  return from_civil(civil);
}

double beam_angle(Part part, std::uint16_t configuration) {
  constexpr std::array<double, 4> kDegrees{15.0, 20.0, 30.0, kUnknown};
  double degrees = kDegrees[configuration >> fixed::kAngleShift & 3U];
  // The byte of newer firmware says more than the two bits; older ones leave other things there.
  if (part.size() >= fixed::kFull && part[fixed::kBeamAngle] >= 10 && part[fixed::kBeamAngle] <= 45) {
    degrees = part[fixed::kBeamAngle];
  }
  return degrees * std::numbers::pi / 180.0;
}

bool any_known(const std::array<double, 4>& values) {
  return known(values[0]) || known(values[1]) || known(values[2]) || known(values[3]);
}

std::array<double, 4> read_velocity(Part bottom, std::size_t at, Part high_resolution, std::size_t fine_at) {
  std::array<double, 4> v{kUnknown, kUnknown, kUnknown, kUnknown};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto coarse = load_le<std::int16_t>(bottom, at + 2 * i);
    if (coarse == kBadVelocity) continue;
    v[i] = coarse / kPerMillimetre;
    if (high_resolution.size() < high_resolution::kFull) continue;
    const auto fine = load_le<std::int32_t>(high_resolution, fine_at + 4 * i);
    if (fine == kBadHighResolution) continue;
    const double refined = -fine / 1e5;  // opposite sign: vehicle relative to bottom
    if (std::abs(refined - v[i]) <= 1.5 / kPerMillimetre) v[i] = refined;
  }
  return v;
}

double read_sigma(Part navigation, std::size_t at) {
  if (navigation.size() < navigation::kShortest) return kUnknown;
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto sigma = load_le<std::uint16_t>(navigation, at + 2 * i);
    if (sigma == 0 || sigma >= 0x7FFF) continue;
    sum += std::pow(sigma / kPerMillimetre, 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kUnknown;
}

BottomTrack read_track(const Parts& parts) {
  const Part part = parts.bottom;
  BottomTrack track;
  track.bottom.recorded_m_s =
      read_velocity(part, bottom::kVelocity, parts.high_resolution, high_resolution::kVelocity);
  track.bottom.sigma_m_s = read_sigma(parts.navigation, navigation::kBottomSigma);
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    std::uint32_t range_cm = load_le<std::uint16_t>(part, bottom::kRange + 2 * i);
    if (part.size() >= bottom::kFull) range_cm += 65'536U * part[bottom::kRangeHigh + i];
    if (range_cm == 0) continue;
    track.range_m[i] = range_cm / 100.0;
    sum += track.range_m[i];
    ++count;
  }
  if (count > 0) track.altitude_m = sum / count;
  if (parts.range.size() >= range::kShortest) {
    const auto vertical = load_le<std::uint32_t>(parts.range, range::kVertical);
    if (vertical != 0 && vertical < 0x7FFF'FFFF) track.altitude_m = vertical / 1e4;
  }
  if (part.size() < bottom::kWaterEnd) return track;
  Velocity water;
  water.recorded_m_s =
      read_velocity(part, bottom::kWaterVelocity, parts.high_resolution, high_resolution::kWaterVelocity);
  water.sigma_m_s = read_sigma(parts.navigation, navigation::kWaterSigma);
  // Firmware without water layer leaves zeros: no velocity, and no good ping either.
  bool all_zero = true;
  for (std::size_t i = 0; i < 4; ++i) {
    all_zero = all_zero && water.recorded_m_s[i] == 0.0 && part[bottom::kWaterPercentGood + i] == 0;
  }
  if (!all_zero && any_known(water.recorded_m_s)) track.water = water;
  return track;
}

}  // namespace

std::variant<Ensemble, RejectReason> read_ensemble(std::span<const std::uint8_t> bytes) {
  const std::optional<Parts> parts = split(bytes);
  if (!parts || parts->fixed.size() < fixed::kShortest || parts->variable.size() < variable::kShortest) {
    return RejectReason::structure;
  }
  if (!parts->bottom.empty() && parts->bottom.size() < bottom::kShortest) return RejectReason::structure;

  Ensemble ensemble;
  const auto configuration = load_le<std::uint16_t>(parts->fixed, fixed::kSystemConfiguration);
  const std::uint8_t coordinates = parts->fixed[fixed::kCoordinates];
  ensemble.frame = static_cast<DvlFrame>(coordinates >> fixed::kFrameShift & 3U);
  ensemble.convex = (configuration & fixed::kConvex) != 0;
  ensemble.upward = (configuration & fixed::kUpward) != 0;
  ensemble.tilts_used = (coordinates & fixed::kTiltsUsed) != 0;
  ensemble.beam_angle_rad = beam_angle(parts->fixed, configuration);

  const Part leader = parts->variable;
  const auto heading = load_le<std::uint16_t>(leader, variable::kHeading);
  const auto pitch = load_le<std::int16_t>(leader, variable::kPitch);
  const auto roll = load_le<std::int16_t>(leader, variable::kRoll);
  if (heading <= 36'000) ensemble.heading_rad = heading * kRadPerCentidegree;
  if (std::abs(pitch) <= 9'000) ensemble.pitch_rad = pitch * kRadPerCentidegree;
  if (std::abs(roll) <= 18'000) ensemble.roll_rad = roll * kRadPerCentidegree;
  double sound_speed = load_le<std::uint16_t>(leader, variable::kSoundSpeed);
  if (parts->high_resolution.size() >= high_resolution::kFull) {
    const double fine = load_le<std::uint32_t>(parts->high_resolution, high_resolution::kSoundSpeed) / 1e6;
    if (std::abs(fine - sound_speed) <= 1.0) sound_speed = fine;
  }
  if (sound_speed >= 1'300.0 && sound_speed <= 1'700.0) ensemble.sound_speed_m_s = sound_speed;
  ensemble.clock_ns = read_clock(leader);
  if (!parts->bottom.empty()) ensemble.track = read_track(*parts);
  return ensemble;
}

}  // namespace fathom::codec::pd0
