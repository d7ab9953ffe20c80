#include "codec/dvl/pd6.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "codec/dvl/pd0_geometry.hpp"
#include "codec/dvl/pd6_line.hpp"
#include "codec/framer.hpp"

namespace fathom::codec::pd6 {
namespace {

std::uint16_t bit_of(LineKind kind) {
  return static_cast<std::uint16_t>(1U << static_cast<unsigned>(kind));
}

bool is_earth(LineKind kind) {
  return kind == LineKind::we || kind == LineKind::be;
}

bool is_velocity(LineKind kind) {
  return kind != LineKind::sa && kind != LineKind::ts && kind != LineKind::wd && kind != LineKind::bd;
}

/// The lines of one ping.
struct PingLines {
  std::array<std::optional<Line>, kLineKinds> line;
  std::uint16_t kinds = 0;  ///< of `line`, by bit_of
  std::uint64_t offset = 0;
  std::uint64_t end = 0;
  LineKind last = LineKind::sa;  ///< that came
  bool bottom_given = false;
  bool water_given = false;

  [[nodiscard]] const Line* find(LineKind kind) const {
    const std::optional<Line>& found = line[static_cast<std::size_t>(kind)];
    return found ? &*found : nullptr;
  }
  [[nodiscard]] bool has(LineKind kind) const { return (kinds & bit_of(kind)) != 0; }
  [[nodiscard]] bool header_only() const {
    return (kinds & ~(bit_of(LineKind::sa) | bit_of(LineKind::ts))) == 0;
  }
};

/// A velocity, and the frame of the line that it was taken from.
struct FramedVelocity {
  DvlFrame frame = DvlFrame::instrument;
  std::array<double, 4> vessel_m_s{kUnknown, kUnknown, kUnknown, kUnknown};

  [[nodiscard]] bool any_known() const { return std::any_of(vessel_m_s.begin(), vessel_m_s.end(), known); }
};

bool same_axes(const std::array<double, 4>& v, double a, double b, double c) {
  return v[0] == a && v[1] == b && v[2] == c;
}

class Pd6 final : public Framer {
 public:
  explicit Pd6(double heading_alignment_rad)
      : Framer(kMaxLine, LineEnds::belong_to_frames), heading_alignment_rad_(heading_alignment_rad) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_line(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const std::string_view text = text_of(frame);
    const std::optional<LineKind> kind = kind_of(text);
    if (!kind) return Outcome::ignored();
    Line line;
    // The next line begins behind this one: a colon ends it.
    if (const auto reason = read_line(*kind, text, line)) return Outcome::refused(*reason, frame.size());
    const bool begins = begins_ping(*kind);
    if (begins ? is_earth(*kind) : !can_be_turned(*kind)) {
      return Outcome::refused(RejectReason::incomplete, frame.size());
    }
    if (begins) close(sink);
    if (ping_.kinds == 0) ping_.offset = offset;
    ping_.line[static_cast<std::size_t>(*kind)] = line;
    ping_.kinds = static_cast<std::uint16_t>(ping_.kinds | bit_of(*kind));
    ping_.end = offset + frame.size();
    if (*kind == LineKind::be) forward_right_down_ = is_forward_right_down();
    ping_.last = *kind;
    if (*kind == ending_) deliver(sink, false);
    return is_velocity(*kind) ? Outcome::used() : Outcome::ignored();
  }

  void flush(Sink& sink) override {
    close(sink);
    closed_ = 0;
    ending_ = LineKind::bd;
    forward_right_down_ = false;
  }

  [[nodiscard]] bool begins_ping(LineKind kind) const {
    const bool header = kind == LineKind::sa || kind == LineKind::ts;
    return ping_.has(kind) || (header && !ping_.header_only());
  }

  /// A velocity relative to the earth means nothing without an attitude, where it is the only one.
  [[nodiscard]] bool can_be_turned(LineKind kind) const {
    const bool water = kind == LineKind::we;
    return !is_earth(kind) || ping_.has(LineKind::sa) || ping_.has(water ? LineKind::wi : LineKind::bi) ||
           ping_.has(water ? LineKind::ws : LineKind::bs);
  }

  void close(Sink& sink) {
    if (ping_.kinds == 0) return;
    deliver(sink, true);
    endings_[closed_ % kHistory] = ping_.last;
    ++closed_;
    ping_ = PingLines{};
    // The first one may have lost what the others have.
    if (closed_ >= 2) ending_ = usual_ending();
  }

  /// What ended most of the last pings; of two that did so as often, the one that the manual has later.
  [[nodiscard]] LineKind usual_ending() const {
    std::array<int, kLineKinds> times{};
    for (std::size_t i = 0; i < std::min(closed_, kHistory); ++i)
      ++times[static_cast<std::size_t>(endings_[i])];
    const auto most = std::max_element(times.rbegin(), times.rend());
    return static_cast<LineKind>(times.rend() - most - 1);
  }

  /// Water Linked's axes, as this ping has them.
  [[nodiscard]] bool is_forward_right_down() const {
    const Line* instrument = ping_.find(LineKind::bi);
    const Line* ship = ping_.find(LineKind::bs);
    const Line* earth = ping_.find(LineKind::be);
    if (earth == nullptr || !earth->bad_zeros) return false;
    if (instrument == nullptr || ship == nullptr || !known(ship->velocity_m_s[0])) return true;
    const auto& [x, y, z, error] = instrument->velocity_m_s;
    // Old firmware fills :BS with zeros.
    return same_axes(ship->velocity_m_s, y, x, z) || same_axes(ship->velocity_m_s, 0.0, 0.0, 0.0);
  }

  /// By the first frame that was sent.
  [[nodiscard]] std::optional<FramedVelocity> velocity(LineKind instrument, LineKind ship,
                                                       LineKind earth) const {
    if (const Line* line = ping_.find(instrument)) {
      const auto& [x, y, z, error] = line->velocity_m_s;
      if (forward_right_down_) return FramedVelocity{DvlFrame::instrument, {y, x, -z, error}};
      return FramedVelocity{DvlFrame::instrument, line->velocity_m_s};
    }
    if (const Line* line = ping_.find(ship)) {
      const auto& [transverse, longitudinal, normal, error] = line->velocity_m_s;
      if (forward_right_down_)
        return FramedVelocity{DvlFrame::ship, {transverse, longitudinal, -normal, error}};
      return FramedVelocity{DvlFrame::ship, line->velocity_m_s};
    }
    const Line* line = ping_.find(earth);
    return line != nullptr ? std::optional(FramedVelocity{DvlFrame::earth, line->velocity_m_s})
                           : std::nullopt;
  }

  void deliver(Sink& sink, bool closing) {
    DvlSample sample;
    DeviceTime time;
    if (const Line* timing = ping_.find(LineKind::ts)) {
      sample.sound_speed_m_s = timing->sound_speed_m_s;
      time.clock_ns = timing->clock_ns;
    }
    const Line* attitude = ping_.find(LineKind::sa);
    if (attitude != nullptr && !forward_right_down_) {
      sample.roll_rad = attitude->roll_rad;
      sample.pitch_rad = attitude->pitch_rad;
      sample.heading_rad = attitude->heading_rad;
    }
    const auto bottom = velocity(LineKind::bi, LineKind::bs, LineKind::be);
    if (bottom && !ping_.bottom_given) {
      ping_.bottom_given = true;
      DvlSample ground = sample;
      if (const Line* distance = ping_.find(LineKind::bd)) ground.altitude_m = distance->range_m;
      give(sink, ground, DvlMode::bottom, *bottom, time);
    }
    const auto water = velocity(LineKind::wi, LineKind::ws, LineKind::we);
    // Where nothing but the water is tracked, losing it is all that there is to say.
    const bool alone = !ping_.has(LineKind::bi) && !ping_.has(LineKind::bs) && !ping_.has(LineKind::be);
    if (water && !ping_.water_given && (water->any_known() || (alone && closing))) {
      ping_.water_given = true;
      give(sink, sample, DvlMode::water, *water, time);
    }
  }

  void give(Sink& sink, DvlSample sample, DvlMode mode, const FramedVelocity& velocity,
            const DeviceTime& time) {
    // As PD0 has it: bottom or water relative to the DVL. No component turns into a negative zero.
    pd0::Ensemble ensemble;
    ensemble.frame = velocity.frame;
    ensemble.tilts_used = true;
    ensemble.heading_rad = sample.heading_rad;
    ensemble.pitch_rad = sample.pitch_rad;
    ensemble.roll_rad = sample.roll_rad;
    pd0::Velocity recorded;
    const auto& v = velocity.vessel_m_s;
    recorded.recorded_m_s = {-v[0], -v[1], 0.0 - v[2], v[3]};
    sample.mode = mode;
    sample.recorded_frame = velocity.frame;
    pd0::set_velocity(sample, ensemble, recorded, heading_alignment_rad_);
    emit(sink, sample, time, ping_.offset, ping_.end - ping_.offset);
  }

  static constexpr std::size_t kHistory = 8;

  double heading_alignment_rad_;
  PingLines ping_;
  std::array<LineKind, kHistory> endings_{};  ///< last lines of the last pings
  std::size_t closed_ = 0;
  LineKind ending_ = LineKind::bd;   ///< with which a ping is over
  bool forward_right_down_ = false;  ///< the axes of :BI are Water Linked's
};

}  // namespace
}  // namespace fathom::codec::pd6

namespace fathom::codec {

std::unique_ptr<Codec> make_pd6(const CodecOptions& options) {
  return std::make_unique<pd6::Pd6>(options.dvl_heading_alignment_rad);
}

}  // namespace fathom::codec
