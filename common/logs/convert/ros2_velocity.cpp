#include <algorithm>
#include <cmath>

#include "base/unknown.hpp"
#include "logs/convert/ros2_parts.hpp"

namespace fathom::logs {
namespace {

using Axes = Ros2Options::Axes;

// One component's: the root of the mean of the variances that are known.
double mean_sigma(const Series& series, std::size_t row, const std::array<std::size_t, 3>& variances) {
  double sum = 0.0;
  for (const std::size_t i : variances) sum += series.at(row, i);
  return sigma_of(sum / 3.0);
}

/// A DVL's message, as its definition names the fields.
struct DvlColumns {
  explicit DvlColumns(const Series& s)
      : velocity(*xyz_of(s, "velocity")),
        valid(s.find("velocity_valid")),
        mode(s.find("velocity_mode")),
        fom(s.find_any({"fom", "figure_of_merit"})),
        altitude(s.find("altitude")),
        sound_speed(s.find("sound_speed")) {
    for (const char* stem : {"velocity_covariance", "velocity_covar", "covariance"}) {
      const auto x = s.find(std::string(stem) + "[0]");
      const auto y = s.find(std::string(stem) + "[4]");
      const auto z = s.find(std::string(stem) + "[8]");
      if (!x || !y || !z) continue;
      variance = {*x, *y, *z};
      // Definitions after UUV Simulator say that -1 there means a measurement that is not valid.
      negative_is_invalid = std::string(stem) == "velocity_covariance";
      break;
    }
    // Water Linked's drivers have the instrument's axes; marine_acoustic_msgs has z where the DVL points.
    axes = fom || valid || s.find("velocity_covar[0]") ? Axes::frd : Axes::flu;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const std::string one = "beams[" + std::to_string(i) + "].";
      beams[i] = {s.find_any({one + "id"}), s.find(one + "velocity"),
                  s.find_any({one + "valid", one + "beam_valid"}), s.find(one + "distance")};
    }
  }

  using Place = std::optional<std::size_t>;
  struct Beam {
    Place id, velocity, valid, distance;
  };
  std::array<std::size_t, 3> velocity;
  Place valid, mode, fom, altitude, sound_speed;
  std::optional<std::array<std::size_t, 3>> variance;
  bool negative_is_invalid = false;
  Axes axes = Axes::flu;
  std::array<Beam, 4> beams;
};

// Beams in the form of Water Linked, whose sign is ours. Other definitions do not say a beam's sign.
void read_beams(const Series& series, std::size_t row, const DvlColumns& c, DvlSample& sample) {
  for (std::size_t i = 0; i < c.beams.size(); ++i) {
    const DvlColumns::Beam& beam = c.beams[i];
    if (!beam.velocity || !beam.valid || !beam.distance) continue;
    if (!(series.at(row, *beam.valid) == 1.0)) continue;
    const double id = beam.id ? series.at(row, *beam.id) : static_cast<double>(i);
    if (!(id >= 0.0 && id < 4.0)) continue;
    const auto at = static_cast<std::size_t>(id);
    sample.beam_velocity_m_s[at] = series.at(row, *beam.velocity);
    if (const double distance_m = series.at(row, *beam.distance); distance_m > 0.0)
      sample.beam_range_m[at] = distance_m;
  }
}

void convert_dvl(const Series& series, const DvlColumns& c, const Ros2Clock& clock, const Mounting& mounting,
                 std::vector<DvlSample>& samples) {
  for (std::size_t row = 0; row < series.rows(); ++row) {
    const auto header = clock.header(series, row);
    if (!header) continue;
    DvlSample& sample = samples.emplace_back();
    sample.header = *header;
    if (c.mode && series.at(row, *c.mode) == 2.0) sample.mode = DvlMode::water;
    bool valid = !c.valid || series.at(row, *c.valid) == 1.0;
    if (c.variance && c.negative_is_invalid && series.at(row, (*c.variance)[0]) < 0.0) valid = false;
    if (valid) {
      const Eigen::Vector3d v = mounting.C_BS * vector_at(series, row, c.velocity);
      sample.velocity_D_m_s = {v.x(), v.y(), v.z()};
      sample.sigma_m_s = c.variance ? mean_sigma(series, row, *c.variance) : kUnknown;
      const double fom = series.at(row, c.fom);
      if (!known(sample.sigma_m_s) && fom > 0.0) sample.sigma_m_s = fom;
      // Turned to the body's axes they would not be those of its beams any more.
      if (!mounting.turned) read_beams(series, row, c, sample);
    }
    if (const double altitude_m = series.at(row, c.altitude); altitude_m > 0.0)
      sample.altitude_m = altitude_m;
    if (const double speed = series.at(row, c.sound_speed); speed > 0.0) sample.sound_speed_m_s = speed;
  }
}

void convert_twist(const Twist& twist, const Ros2Clock& clock, const Mounting& mounting,
                   std::vector<DvlSample>& samples) {
  const Series& series = *twist.series;
  for (std::size_t row = 0; row < series.rows(); ++row) {
    const auto header = clock.header(series, row);
    if (!header) continue;
    DvlSample& sample = samples.emplace_back();
    sample.header = *header;
    const Eigen::Vector3d v = mounting.C_BS * vector_at(series, row, twist.linear);
    sample.velocity_D_m_s = {v.x(), v.y(), v.z()};
    if (twist.variance) sample.sigma_m_s = mean_sigma(series, row, *twist.variance);
  }
}

}  // namespace

void ros2_velocity(const Log& log, const Ros2Clock& clock, const Ros2Frames& frames, const Series* of_gps,
                   const ConvertOptions& options, Vehicle& out) {
  auto& samples = out.data.of<DvlSample>();
  std::vector<Candidate> ways;        // of a DVL
  std::vector<Candidate> when_asked;  // velocities that may come from anything
  const auto note = [&out](const std::string& label, const Mounting& mounting) {
    out.notes.push_back("dvl: " + label + ": " + mounting.how);
  };
  for (const Series& series : log.series) {
    if (series.rows() == 0) continue;
    const std::string label = ros2_label(log, series);
    if (series.type.find("sensor_msgs/") != 0 && xyz_of(series, "velocity")) {
      ways.push_back({label, &series, [&, label] {
                        const DvlColumns columns(series);
                        const Mounting mounting = frames.of(series, series.frame, columns.axes);
                        note(label, mounting);
                        convert_dvl(series, columns, clock, mounting, samples);
                      }});
    } else if (const auto twist = twist_of(series); twist && &series != of_gps) {
      const bool odometry = series.type == "nav_msgs/Odometry";
      (is_called(series, "dvl") ? ways : when_asked).push_back({label, &series, [&, label, twist, odometry] {
                                                                  const Mounting mounting = frames.of(
                                                                      series, odometry ? series.child_frame
                                                                                       : series.frame);
                                                                  note(label, mounting);
                                                                  convert_twist(*twist, clock, mounting,
                                                                                samples);
                                                                }});
    }
  }
  // A DVL's own message before a twist that was made of it.
  std::stable_partition(ways.begin(), ways.end(),
                        [](const Candidate& one) { return !twist_of(*one.series); });
  std::vector<Candidate> all = ways;
  all.insert(all.end(), when_asked.begin(), when_asked.end());
  const bool asked = options.choice.contains("dvl");
  make_best("dvl", asked ? all : ways, false, options, out);
  if (!asked && !when_asked.empty()) {
    for (const Candidate& one : when_asked) out.others["dvl"].push_back(one.label);
    if (ways.empty()) {
      std::string labels;
      for (const Candidate& one : when_asked) labels += " " + one.label;
      out.notes.push_back(
          "dvl: velocities that may be a DVL's, wheels' or another filter's are left out; --from dvl="
          "TOPIC takes one:" +
          labels);
    }
  }
  settle(samples, "dvl", out);
}

}  // namespace fathom::logs
