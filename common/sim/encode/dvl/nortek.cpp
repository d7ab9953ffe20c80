#include "sim/encode/dvl/nortek.hpp"

#include <array>
#include <cassert>
#include <limits>
#include <span>

#include "base/bytes/little_endian.hpp"
#include "codec/dvl/nortek.hpp"
#include "codec/dvl/nortek_layout.hpp"

namespace fathom::sim::encode {
namespace {

namespace layout = codec::nortek;

constexpr DurationNs kNortekTick_ns = 100'000;
constexpr DurationNs kNortekEcho_ns = 20 * kNsPerMillisecond;  ///< from the trigger to the centre of the echo

/// Four numbers of a record, and their bits of its status.
void put_group(std::span<std::uint8_t> record, std::size_t at, unsigned bits, float none,
               const std::array<double, 4>& values) {
  auto status = load_le<std::uint32_t>(record, layout::record::kStatus);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool good = known(values[i]);
    if (good) status |= 1U << (bits + i);
    store_le<float>(record, layout::record::kData + at + sizeof(float) * i,
                    good ? static_cast<float>(values[i]) : none);
  }
  store_le<std::uint32_t>(record, layout::record::kStatus, status);
}

void put_seconds(std::span<std::uint8_t> record, std::size_t at, DurationNs value) {
  for (std::size_t i = 0; i < 4; ++i) {
    store_le<float>(record, layout::record::kData + at + sizeof(float) * i,
                    static_cast<float>(to_seconds(value)));
  }
}

void put_trigger(std::span<std::uint8_t> record, TimeNs trigger_ns) {
  const CivilTime civil = to_civil(trigger_ns);
  const std::array<int, 6> parts{civil.year - 1900, civil.month - 1, civil.day,
                                 civil.hour,        civil.minute,    civil.second};
  for (std::size_t i = 0; i < parts.size(); ++i)
    record[layout::record::kYear + i] = static_cast<std::uint8_t>(parts[i]);
  store_le<std::uint16_t>(record, layout::record::kHundredMicroseconds,
                          static_cast<std::uint16_t>(civil.nanosecond / kNortekTick_ns));
}

}  // namespace

std::vector<std::uint8_t> nortek_record(std::uint8_t kind, const std::vector<std::uint8_t>& data,
                                        bool long_header) {
  assert(long_header || data.size() <= std::numeric_limits<std::uint16_t>::max());
  std::vector<std::uint8_t> out{
      layout::kSync, static_cast<std::uint8_t>(long_header ? layout::header::kLong : layout::header::kShort),
      kind, layout::kFamily};
  if (long_header) {
    append_le<std::uint32_t>(out, static_cast<std::uint32_t>(data.size()));
  } else {
    append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  }
  append_le<std::uint16_t>(out, layout::checksum(data));
  append_le<std::uint16_t>(out, layout::checksum(out));
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

std::vector<std::uint8_t> nortek(const DvlSample& s, const NortekTimes& times) {
  namespace group = layout::group;
  namespace valid = layout::valid;
  std::vector<std::uint8_t> record(layout::record::kData + group::kAll);
  record[layout::record::kVersion] = layout::record::kKnownVersion;
  record[layout::record::kOffsetOfData] = static_cast<std::uint8_t>(layout::record::kData);
  store_le<std::uint32_t>(record, layout::record::kSerialNumber, 100'000);
  store_le<std::uint16_t>(record, layout::record::kBeams, 4);
  store_le<float>(record, layout::record::kSoundSpeed,
                  known(s.sound_speed_m_s) ? static_cast<float>(s.sound_speed_m_s) : 1500.0F);
  store_le<float>(record, layout::record::kTemperature, 10.0F);
  store_le<float>(record, layout::record::kPressure, 1.0F);

  put_group(record, group::kBeamVelocity, valid::kBeamVelocity, layout::kNoVelocity, s.beam_velocity_m_s);
  put_group(record, group::kBeamDistance, valid::kBeamDistance, layout::kNoDistance, s.beam_range_m);
  std::array<double, 4> beam_figures;
  std::array<double, 4> axis_figures;
  const auto [x, y, z] = s.velocity_D_m_s;
  const double apart = s.error_velocity_m_s / layout::kErrorPerDifference;
  const std::array<double, 4> axes{x, y, known(apart) ? z + 0.5 * apart : z, z - 0.5 * apart};
  for (std::size_t i = 0; i < 4; ++i) {
    beam_figures[i] = known(s.beam_velocity_m_s[i]) ? s.sigma_m_s : kUnknown;
    axis_figures[i] = known(axes[i]) ? s.sigma_m_s : kUnknown;
  }
  put_group(record, group::kBeamFigure, valid::kBeamFigure, layout::kNoFigure, beam_figures);
  put_group(record, group::kAxisVelocity, valid::kAxisVelocity, layout::kNoVelocity, axes);
  put_group(record, group::kAxisFigure, valid::kAxisFigure, layout::kNoFigure, axis_figures);

  const TimeNs before_ns = times.valid_ns - kNortekEcho_ns;
  const TimeNs trigger_ns = before_ns - (before_ns % kNortekTick_ns + kNortekTick_ns) % kNortekTick_ns;
  put_trigger(record, trigger_ns);
  for (const std::size_t at : {group::kBeamSinceTrigger, group::kAxisSinceTrigger})
    put_seconds(record, at, times.valid_ns - trigger_ns);
  for (const std::size_t at : {group::kBeamBeforeOutput, group::kAxisBeforeOutput})
    put_seconds(record, at, times.valid_ns - times.sent_ns);
  return nortek_record(s.mode == DvlMode::bottom ? layout::kBottomTrack : layout::kWaterTrack, record);
}

}  // namespace fathom::sim::encode
