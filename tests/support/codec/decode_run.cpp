#include "support/codec/decode_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <stdexcept>

namespace fathom::test {
namespace {

/// Appends fields so that equal text means equal bits (all NaN are alike).
class Line {
 public:
  explicit Line(std::string& out) : out_(out) {}

  Line& word(std::string_view text) {
    out_.append(text).push_back(' ');
    return *this;
  }
  Line& integer(std::int64_t value) { return word(std::to_string(value)); }
  Line& real(double value) {
    std::array<char, 40> text{};
    const int length = std::isnan(value) ? std::snprintf(text.data(), text.size(), "nan")
                                         : std::snprintf(text.data(), text.size(), "%a", value);
    return word({text.data(), static_cast<std::size_t>(length)});
  }
  template <std::size_t N>
  Line& reals(const std::array<double, N>& values) {
    for (const double value : values) real(value);
    return *this;
  }
  Line& maybe(const std::optional<std::int64_t>& value) { return value ? integer(*value) : word("-"); }
  void end() { out_.push_back('\n'); }

 private:
  std::string& out_;
};

void describe(Line& line, const ImuSample& s) {
  line.word("imu").reals(s.angular_rate_B_rad_s).reals(s.specific_force_B_m_s2).reals(s.delta_angle_B_rad);
  line.reals(s.delta_velocity_B_m_s).real(s.delta_time_s).real(s.temperature_degC);
}

void describe(Line& line, const DvlSample& s) {
  line.word("dvl").integer(static_cast<int>(s.mode)).integer(static_cast<int>(s.recorded_frame));
  line.reals(s.velocity_D_m_s).real(s.error_velocity_m_s).real(s.sigma_m_s).reals(s.beam_velocity_m_s);
  line.reals(s.beam_range_m).real(s.beam_angle_rad).real(s.altitude_m).real(s.sound_speed_m_s);
  line.real(s.roll_rad).real(s.pitch_rad).real(s.heading_rad);
}

void describe(Line& line, const GpsSample& s) {
  line.word("gps").integer(static_cast<int>(s.fix)).integer(s.satellites).real(s.latitude_rad);
  line.real(s.longitude_rad).real(s.altitude_m).real(s.altitude_msl_m).reals(s.position_sigma_N_m);
  line.reals(s.velocity_N_m_s).reals(s.velocity_sigma_N_m_s).real(s.hdop).real(s.course_rad);
  line.integer(static_cast<int>(s.jamming)).integer(static_cast<int>(s.spoofing));
}

void describe(Line& line, const DepthSample& s) {
  line.word("depth").real(s.depth_m).real(s.sigma_m).real(s.pressure_Pa).real(s.temperature_degC);
}

void describe(Line& line, const RangeSample& s) {
  line.word("range").word(s.beacon.view()).real(s.range_m).real(s.sigma_m).real(s.travel_time_s);
  line.real(s.beacon_latitude_rad).real(s.beacon_longitude_rad).real(s.beacon_depth_m);
}

void describe(Line& line, const FixSample& s) {
  line.word("fix").real(s.latitude_rad).real(s.longitude_rad).real(s.sigma_m);
  line.real(s.depth_m).real(s.depth_sigma_m);
}

void describe(Line& line, const AltimeterSample& s) {
  line.word("altimeter").real(s.altitude_m).real(s.sigma_m).real(s.transducer_offset_m);
  line.integer(s.vertical ? 1 : 0);
}

void describe(Line& line, const HeadingSample& s) {
  line.word("heading").integer(static_cast<int>(s.north)).real(s.heading_rad).real(s.sigma_rad);
  line.real(s.variation_rad).real(s.deviation_rad);
}

void describe(Line& line, const UsblSample& s) {
  line.word("usbl").integer(static_cast<int>(s.frame)).word(s.transponder.view()).real(s.latitude_rad);
  line.real(s.longitude_rad).real(s.depth_m).reals(s.relative_m).real(s.sigma_m).real(s.travel_time_s);
  line.real(s.station_latitude_rad).real(s.station_longitude_rad).reals(s.station_rpy_rad);
}

void describe(Line& line, const PropulsionSample& s) {
  line.word("propulsion").real(s.rpm);
}

void describe(Line& line, const FinsSample& s) {
  line.word("fins").real(s.rudder_rad).real(s.stern_rad);
}

void describe(Line& line, const AirspeedSample& s) {
  line.word("airspeed").real(s.airspeed_m_s).real(s.true_airspeed_m_s).real(s.baro_altitude_m);
}

std::unique_ptr<codec::Codec> make(std::string_view protocol, const codec::CodecOptions& options) {
  const codec::Protocol* found = codec::find_protocol(protocol);
  if (found == nullptr) throw std::invalid_argument("no such protocol: " + std::string(protocol));
  return found->make(options);
}

}  // namespace

void DecodeRun::record(const codec::Decoded& decoded) {
  if (!keep_transcript) return;
  Line line(transcript);
  std::visit([&line](const auto& sample) { describe(line, sample); }, decoded.sample);
  line.maybe(decoded.time.utc_ns).maybe(decoded.time.clock_ns).maybe(decoded.time.time_of_day_ns);
  line.maybe(decoded.time.age_ns).integer(static_cast<std::int64_t>(decoded.offset));
  line.integer(static_cast<std::int64_t>(decoded.length)).end();
}

void DecodeRun::record(const codec::Rejected& refused) {
  if (!keep_transcript) return;
  Line line(transcript);
  line.word("rejected").word(codec::to_string(refused.reason));
  line.integer(static_cast<std::int64_t>(refused.offset));
  line.integer(static_cast<std::int64_t>(refused.length)).end();
}

DecodeRun decode_whole(std::string_view protocol, std::span<const std::uint8_t> bytes,
                       const codec::CodecOptions& options) {
  DecodeRun run;
  const auto codec = make(protocol, options);
  codec->feed(bytes, run);
  codec->finish(run);
  run.totals = codec->totals();
  return run;
}

DecodeRun decode_chunked(std::string_view protocol, std::span<const std::uint8_t> bytes, std::size_t largest,
                         std::uint64_t seed, const codec::CodecOptions& options) {
  DecodeRun run;
  const auto codec = make(protocol, options);
  std::mt19937_64 random(seed);
  while (!bytes.empty()) {
    const std::size_t length = std::min<std::size_t>(1 + random() % largest, bytes.size());
    codec->feed(bytes.first(length), run);
    bytes = bytes.subspan(length);
  }
  codec->finish(run);
  run.totals = codec->totals();
  return run;
}

std::string inconsistency(const DecodeRun& run, std::size_t stream_length) {
  const codec::Totals& totals = run.totals;
  if (totals.bytes != stream_length) return "not every byte was counted";
  if (totals.samples != run.samples.size()) return "samples counted and samples delivered differ";
  if (totals.rejected != run.rejected.size()) return "frames refused and refusals reported differ";
  if (totals.skipped_bytes > stream_length) return "more bytes skipped than there were";
  std::vector<bool> refused(stream_length, false);
  std::uint64_t last = 0;
  for (const codec::Rejected& event : run.rejected) {
    if (event.length == 0) return "a refused frame without bytes";
    if (event.offset + event.length > stream_length) return "a refused frame beyond the end";
    if (event.offset < last) return "refused frames overlap or are out of order";
    last = event.offset + event.length;
    std::fill_n(refused.begin() + static_cast<std::ptrdiff_t>(event.offset), event.length, true);
  }
  for (const codec::Decoded& event : run.samples) {
    if (event.length == 0) return "a sample without bytes";
    if (event.offset + event.length > stream_length) return "a sample beyond the end";
  }
  const auto covered = static_cast<std::uint64_t>(std::count(refused.begin(), refused.end(), true));
  if (covered + totals.skipped_bytes > stream_length) return "refused and skipped bytes exceed the stream";
  if (totals.samples == 0 && totals.frames_ignored == 0 && covered + totals.skipped_bytes < stream_length) {
    // Line ends after a refused line count with it; nothing else may vanish.
    if (totals.rejected == 0) return "bytes neither in a frame nor skipped";
  }
  return {};
}

}  // namespace fathom::test
