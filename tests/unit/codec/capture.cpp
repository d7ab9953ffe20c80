#include "capture.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <stdexcept>

#include "support/paths.hpp"

namespace fathom::codec::capture {
namespace {

class Collector : public Sink {
 public:
  explicit Collector(Harvest& run) : run_(run) {}
  void on_sample(const Decoded& decoded) override { run_.samples.push_back(decoded); }
  void on_rejected(const Rejected& rejected) override { run_.rejected.push_back(rejected); }

 private:
  Harvest& run_;
};

class Writer {
 public:
  void operator()(const ImuSample& s) {
    put("imu", s.angular_rate_B_rad_s, s.specific_force_B_m_s2, s.delta_angle_B_rad, s.delta_velocity_B_m_s,
        s.delta_time_s, s.temperature_degC);
  }
  void operator()(const DvlSample& s) {
    put("dvl", static_cast<int>(s.mode), static_cast<int>(s.recorded_frame), s.velocity_D_m_s,
        s.error_velocity_m_s, s.sigma_m_s, s.beam_velocity_m_s, s.beam_range_m, s.beam_angle_rad,
        s.altitude_m, s.sound_speed_m_s, s.roll_rad, s.pitch_rad, s.heading_rad);
  }
  void operator()(const GpsSample& s) {
    put("gps", static_cast<int>(s.fix), s.satellites, s.latitude_rad, s.longitude_rad, s.altitude_m,
        s.altitude_msl_m, s.position_sigma_N_m, s.velocity_N_m_s, s.velocity_sigma_N_m_s, s.hdop,
        s.course_rad);
  }
  void operator()(const DepthSample& s) {
    put("depth", s.depth_m, s.sigma_m, s.pressure_Pa, s.temperature_degC);
  }
  void operator()(const RangeSample& s) {
    put("range", s.beacon.str(), s.range_m, s.sigma_m, s.travel_time_s);
  }
  void operator()(const FixSample& s) {
    put("fix", s.latitude_rad, s.longitude_rad, s.sigma_m, s.depth_m, s.depth_sigma_m);
  }
  void operator()(const AltimeterSample& s) {
    put("altimeter", s.altitude_m, s.sigma_m, s.transducer_offset_m, s.vertical ? 1 : 0);
  }
  void operator()(const HeadingSample& s) {
    put("heading", static_cast<int>(s.north), s.heading_rad, s.sigma_rad, s.variation_rad, s.deviation_rad);
  }
  void operator()(const UsblSample& s) {
    put("usbl", static_cast<int>(s.frame), s.transponder.str(), s.latitude_rad, s.longitude_rad, s.depth_m,
        s.relative_m, s.sigma_m, s.travel_time_s);
  }
  void operator()(const PropulsionSample& s) { put("propulsion", s.rpm); }
  void operator()(const FinsSample& s) { put("fins", s.rudder_rad, s.stern_rad); }
  void operator()(const AirspeedSample& s) {
    put("airspeed", s.airspeed_m_s, s.true_airspeed_m_s, s.baro_altitude_m);
  }

  template <class... T>
  void put(const T&... values) {
    (one(values), ...);
  }
  void one(const std::optional<std::int64_t>& v) {
    if (v) {
      out_ << *v << ' ';
    } else {
      out_ << "- ";
    }
  }
  template <std::size_t N>
  void one(const std::array<double, N>& v) {
    for (const double x : v) one(x);
  }
  void one(double v) { out_ << std::hexfloat << v << ' '; }
  template <class T>
  void one(const T& v) {
    out_ << v << ' ';
  }
  [[nodiscard]] std::string str() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

}  // namespace

std::filesystem::path root() {
  return test::captures_dir();
}

ByteVector load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::string> found;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    found.push_back(line);
  }
  return found;
}

std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> fields;
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.emplace_back(line.substr(0, end));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

Harvest decode(std::string_view protocol, const ByteVector& bytes, Cut cut, const CodecOptions& options) {
  const Protocol* found = find_protocol(protocol);
  if (found == nullptr) throw std::runtime_error("no protocol " + std::string(protocol));
  const auto codec = found->make(options);
  Harvest run;
  Collector sink(run);
  std::mt19937 random(cut.seed);
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t count = bytes.size();
    if (cut.kind == Cut::Kind::bytes) count = 1;
    if (cut.kind == Cut::Kind::random) count = random() % (random() % 8 == 0 ? 5000 : 60);
    count = std::min(count, bytes.size() - at);
    codec->feed({bytes.data() + at, count}, sink);
    at += count;
  }
  codec->finish(sink);
  run.totals = codec->totals();
  return run;
}

std::vector<std::string> text(const Harvest& run) {
  std::vector<std::string> all;
  for (const Decoded& decoded : run.samples) {
    Writer writer;
    std::visit(writer, decoded.sample);
    writer.put(decoded.time.utc_ns, decoded.time.clock_ns, decoded.time.time_of_day_ns, decoded.time.age_ns,
               decoded.offset, decoded.length);
    all.push_back(writer.str());
  }
  for (const Rejected& rejected : run.rejected) {
    Writer writer;
    writer.put(to_string(rejected.reason), rejected.offset, rejected.length);
    all.push_back(writer.str());
  }
  const Totals& t = run.totals;
  Writer writer;
  writer.put(t.bytes, t.samples, t.frames_ignored, t.rejected, t.skipped_bytes);
  all.push_back(writer.str());
  return all;
}

void report(const std::filesystem::path& file, const Harvest& run, std::size_t compared,
            std::size_t mismatches) {
  std::printf(
      "%-58s samples %5llu  ignored %5llu  rejected %3llu  skipped %6llu  compared %5zu  mismatches %zu\n",
      std::filesystem::relative(file, root()).c_str(), static_cast<unsigned long long>(run.totals.samples),
      static_cast<unsigned long long>(run.totals.frames_ignored),
      static_cast<unsigned long long>(run.totals.rejected),
      static_cast<unsigned long long>(run.totals.skipped_bytes), compared, mismatches);
}

}  // namespace fathom::codec::capture
