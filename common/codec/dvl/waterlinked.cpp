#include "codec/dvl/waterlinked.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "codec/framer.hpp"
#include "codec/text/json_members.hpp"
#include "codec/text/json_object.hpp"

namespace fathom::codec {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxReport = 8 * 1024;
constexpr double kBeamAngle_rad = 22.5 * std::numbers::pi / 180.0;
constexpr double kMaxSpeed_m_s = 50.0;
constexpr DurationNs kMaxAge_ns = 60 * kNsPerSecond;

const Json* member(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

bool flag(const Json& object, const char* key) {
  const Json* value = member(object, key);
  if (value == nullptr || !value->is_boolean()) throw WrongType{};
  return value->get<bool>();
}

double at_least_zero(double value) {
  return value >= 0.0 ? value : kUnknown;
}

double sigma(const Json& report) {
  const Json* covariance = member(report, "covariance");
  if (covariance == nullptr) {
    const double fom = number_in(report, "fom");
    return fom > 0.0 ? fom : kUnknown;
  }
  if (!covariance->is_array() || covariance->size() != 3) throw WrongType{};
  double trace = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& row = (*covariance)[i];
    if (!row.is_array() || row.size() != 3 || !row[i].is_number()) throw WrongType{};
    trace += row[i].get<double>();
  }
  return trace > 0.0 ? std::sqrt(trace / 3.0) : kUnknown;
}

void read_beams(DvlSample& s, const Json& report, bool velocity_valid) {
  const Json* transducers = member(report, "transducers");
  if (transducers == nullptr) return;
  if (!transducers->is_array() || transducers->size() > 4) throw WrongType{};
  for (const Json& transducer : *transducers) {
    if (!transducer.is_object()) throw WrongType{};
    const double id = number_in(transducer, "id");
    if (!(id == 0.0 || id == 1.0 || id == 2.0 || id == 3.0)) throw WrongType{};
    const bool valid = flag(transducer, "beam_valid");
    const double velocity = number_in(transducer, "velocity");
    const double distance = number_in(transducer, "distance");
    if (!valid || !velocity_valid) continue;
    const auto beam = static_cast<std::size_t>(id);
    s.beam_velocity_m_s[beam] = velocity;
    if (distance > 0.0) s.beam_range_m[beam] = distance;
  }
}

/// Microseconds since the Unix epoch, sent as integer or with a fraction.
std::optional<TimeNs> instant(const Json& report, const char* key) {
  const double us = number_in(report, key);
  if (!(us > 0.0) || us > 9e15) return std::nullopt;
  const Json& value = *member(report, key);
  if (value.is_number_integer()) return value.get<std::int64_t>() * 1'000;
  return static_cast<TimeNs>(std::llround(us)) * 1'000;
}

DeviceTime device_time(const Json& report) {
  DeviceTime time;
  time.clock_ns = instant(report, "time_of_validity");
  const auto sent_ns = instant(report, "time_of_transmission");
  if (time.clock_ns && sent_ns && *sent_ns >= *time.clock_ns && *sent_ns - *time.clock_ns <= kMaxAge_ns) {
    time.age_ns = *sent_ns - *time.clock_ns;
  }
  return time;
}

DvlSample read_velocity(const Json& report, DvlMode mode) {
  DvlSample s;
  s.mode = mode;
  s.recorded_frame = DvlFrame::instrument;
  s.beam_angle_rad = kBeamAngle_rad;
  const bool valid = flag(report, "velocity_valid");
  const std::array<double, 3> velocity{number_in(report, "vx"), number_in(report, "vy"),
                                       number_in(report, "vz")};
  s.altitude_m = at_least_zero(number_in(report, "altitude"));
  const double figure = sigma(report);
  if (valid) {
    s.velocity_D_m_s = velocity;
    s.sigma_m_s = figure;
  }
  read_beams(s, report, valid);
  return s;
}

/// The type of a report; those before json_v2 do not name it.
std::optional<std::string> type_of(const Json& report) {
  if (const Json* type = member(report, "type")) {
    return type->is_string() ? std::optional(type->get<std::string>()) : std::nullopt;
  }
  if (report.contains("vx") && report.contains("velocity_valid")) return "velocity";
  return std::nullopt;
}

class WaterLinked : public Framer {
 public:
  WaterLinked() : Framer(kMaxReport, LineEnds::belong_to_frames) {}

 private:
  [[nodiscard]] Probe probe(Bytes front) const override { return probe_json_object(front); }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    const Json report = Json::parse(frame.begin(), frame.end(), nullptr, false);
    if (!report.is_object()) return Outcome::refused(RejectReason::structure);
    const auto type = type_of(report);
    if (!type) return Outcome::refused(RejectReason::structure);
    const bool bottom = *type == "velocity";
    if (!bottom && *type != "velocity_water") return Outcome::ignored();
    try {
      const DvlSample s = read_velocity(report, bottom ? DvlMode::bottom : DvlMode::water);
      for (const double v : s.velocity_D_m_s) {
        if (std::abs(v) > kMaxSpeed_m_s) return Outcome::refused(RejectReason::out_of_range);
      }
      for (const double v : s.beam_velocity_m_s) {
        if (std::abs(v) > kMaxSpeed_m_s) return Outcome::refused(RejectReason::out_of_range);
      }
      emit(sink, s, device_time(report), offset, frame.size());
    } catch (const WrongType&) {
      return Outcome::refused(RejectReason::field);
    }
    return Outcome::used();
  }
};

}  // namespace

std::unique_ptr<Codec> make_waterlinked(const CodecOptions& /*options*/) {
  return std::make_unique<WaterLinked>();
}

}  // namespace fathom::codec
