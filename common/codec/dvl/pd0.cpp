#include "codec/dvl/pd0.hpp"

#include "base/bytes/little_endian.hpp"
#include "codec/byte_sum.hpp"
#include "codec/dvl/pd0_ensemble.hpp"
#include "codec/dvl/pd0_geometry.hpp"
#include "codec/dvl/pd0_layout.hpp"
#include "codec/framer.hpp"

namespace fathom::codec {
namespace {

// Long enough for profilers with all their cells and inserted text; short enough that a damaged length field
// does not hold back a live stream for more than seconds.
constexpr std::size_t kMaxEnsemble = std::size_t{12} * 1024;

class Pd0 : public Framer {
 public:
  explicit Pd0(double heading_alignment_rad)
      : Framer(kMaxEnsemble), heading_alignment_rad_(heading_alignment_rad) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override {
    std::size_t n = 0;
    while (n < front.size() && front[n] != pd0::kSync) ++n;
    if (n > 0) return Probe::skip(n);
    if (front.size() < 2) return Probe::maybe();
    if (front[1] != pd0::kSync && front[1] != pd0::kWavePacket) return Probe::skip(1);
    if (front.size() < pd0::kHeaderBytes) return Probe::need(pd0::kHeaderBytes);
    const std::size_t summed = load_le<std::uint16_t>(front, 2);
    const std::size_t length = summed + pd0::kChecksumBytes;
    if (summed < pd0::kHeaderBytes || length > kMaxEnsemble) return Probe::bad(RejectReason::length, 2);
    if (front.size() < length) return Probe::need(length);
    if (byte_sum(front.first(summed)) != load_le<std::uint16_t>(front, summed)) {
      return Probe::bad(RejectReason::checksum, length);
    }
    return Probe::frame(length);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    if (frame[1] == pd0::kWavePacket) return Outcome::ignored();
    const auto read = pd0::read_ensemble(frame);
    if (const auto* reason = std::get_if<RejectReason>(&read)) return Outcome::refused(*reason);
    const auto& ensemble = std::get<pd0::Ensemble>(read);
    if (!ensemble.track) return Outcome::ignored();

    DvlSample sample;
    sample.recorded_frame = ensemble.frame;
    sample.beam_angle_rad = ensemble.beam_angle_rad;
    sample.sound_speed_m_s = ensemble.sound_speed_m_s;
    sample.heading_rad = ensemble.heading_rad;
    sample.pitch_rad = ensemble.pitch_rad;
    sample.roll_rad = ensemble.roll_rad;
    DeviceTime time;
    time.clock_ns = ensemble.clock_ns;

    DvlSample bottom = sample;
    bottom.mode = DvlMode::bottom;
    bottom.beam_range_m = ensemble.track->range_m;
    bottom.altitude_m = ensemble.track->altitude_m;
    pd0::set_velocity(bottom, ensemble, ensemble.track->bottom, heading_alignment_rad_);
    emit(sink, bottom, time, offset, frame.size());
    if (ensemble.track->water) {
      sample.mode = DvlMode::water;
      pd0::set_velocity(sample, ensemble, *ensemble.track->water, heading_alignment_rad_);
      emit(sink, sample, time, offset, frame.size());
    }
    return Outcome::used();
  }

  double heading_alignment_rad_;
};

}  // namespace

std::unique_ptr<Codec> make_pd0(const CodecOptions& options) {
  return std::make_unique<Pd0>(options.dvl_heading_alignment_rad);
}

}  // namespace fathom::codec
