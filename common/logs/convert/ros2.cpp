#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/median.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "logs/convert/ros2_parts.hpp"

namespace fathom::logs {
namespace {

/// Nothing on land or in the air has it; water has it from a metre on.
constexpr double kMostAir_Pa = 110'000.0;
/// Of a vertical vehicle the heading means nothing.
constexpr double kLeastHorizontal = 0.1;

std::string metres(const Eigen::Vector3d& v) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.3f, %.3f, %.3f m", v.x(), v.y(), v.z());
  return text.data();
}

class Ros2 {
 public:
  Ros2(const Log& log, const ConvertOptions& options)
      : log_(log), options_(options), clock_(log, options, out_), frames_(log, options) {}

  Vehicle convert() {
    const Series* imu_series = imu();
    heading(imu_series);
    const Series* velocity = ros2_gps(log_, clock_, options_, out_);
    ros2_velocity(log_, clock_, frames_, velocity, options_, out_);
    pressure();
    magnetometer();
    levers(imu_series);
    return std::move(out_);
  }

 private:
  // --- inertial unit ------------------------------------------------------------------------------------

  const Series* imu() {
    std::vector<Candidate> ways;
    const Series* chosen = nullptr;
    for (const Series* one : of_type(log_, "sensor_msgs/Imu")) {
      const auto rate = xyz_of(*one, "angular_velocity");
      const auto force = xyz_of(*one, "linear_acceleration");
      if (!rate || !force) continue;
      // Some tell only their attitude.
      const auto no_rate = one->find("angular_velocity_covariance[0]");
      const auto no_force = one->find("linear_acceleration_covariance[0]");
      if (one->at(0, no_rate) == -1.0 && one->at(0, no_force) == -1.0) continue;
      ways.push_back({ros2_label(log_, *one), one, [=, this, &chosen] {
                        chosen = one;
                        inertial(*one, *rate, *force);
                      }});
    }
    make_best("imu", ways, true, options_, out_);
    settle(out_.data.of<ImuSample>(), "imu", out_);
    return chosen;
  }

  void inertial(const Series& series, const std::array<std::size_t, 3>& rate,
                const std::array<std::size_t, 3>& force) {
    const Mounting mounting = frames_.of(series, series.frame);
    out_.notes.push_back("imu: " + series.topic + ": " + mounting.how);
    const auto rate_covariance = series.find("angular_velocity_covariance[0]");
    const auto force_covariance = series.find("linear_acceleration_covariance[0]");
    auto& samples = out_.data.of<ImuSample>();
    std::vector<double> sizes;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const auto header = clock_.header(series, row);
      if (!header) continue;
      ImuSample& sample = samples.emplace_back();
      sample.header = *header;
      // A covariance that begins with -1 means: not measured.
      if (series.at(row, rate_covariance) != -1.0) {
        const Eigen::Vector3d w = mounting.C_BS * vector_at(series, row, rate);
        sample.angular_rate_B_rad_s = {w.x(), w.y(), w.z()};
      }
      if (series.at(row, force_covariance) != -1.0) {
        const Eigen::Vector3d f = mounting.C_BS * vector_at(series, row, force);
        sample.specific_force_B_m_s2 = {f.x(), f.y(), f.z()};
        sizes.push_back(f.norm());
      }
    }
    const double size = median(std::move(sizes));
    if (known(size) && std::abs(size - kStandardGravity_m_s2) > 0.3 * kStandardGravity_m_s2) {
      std::array<char, 160> text{};
      std::snprintf(text.data(), text.size(),
                    "imu: the middle size of linear_acceleration is %.3g, expected about 9.8 m/s2: gravity "
                    "taken out, or "
                    "another unit?",
                    size);
      out_.notes.emplace_back(text.data());
    }
  }

  // --- heading of an attitude ---------------------------------------------------------------------------

  struct Attitude {
    std::array<std::size_t, 3> xyz{};
    std::size_t w = 0;
    std::optional<std::size_t> first, yaw;  // of the covariance
  };
  [[nodiscard]] static std::optional<Attitude> attitude_of(const Series& series) {
    const auto xyz = xyz_of(series, "orientation");
    const auto w = series.find("orientation.w");
    if (!xyz || !w) return std::nullopt;
    return Attitude{*xyz, *w, series.find("orientation_covariance[0]"),
                    series.find("orientation_covariance[8]")};
  }
  [[nodiscard]] static std::optional<geo::Quaternion> quaternion(const Series& series, std::size_t row,
                                                                 const Attitude& a) {
    if (a.first && !(series.at(row, *a.first) >= 0.0)) return std::nullopt;
    const geo::Quaternion q{series.at(row, a.w), series.at(row, a.xyz[0]), series.at(row, a.xyz[1]),
                            series.at(row, a.xyz[2])};
    const double norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (!(norm2 > 0.98 && norm2 < 1.02)) return std::nullopt;
    return geo::normalized(q);
  }
  // An attitude that never changes in the last bit is none: a driver's default.
  [[nodiscard]] static bool changes(const Series& series, const Attitude& a) {
    std::optional<geo::Quaternion> before;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const auto q = quaternion(series, row, a);
      if (!q) continue;
      if (before && (q->w != before->w || q->x != before->x || q->y != before->y || q->z != before->z))
        return true;
      before = q;
    }
    return false;
  }

  void heading(const Series* of_imu) {
    std::vector<Candidate> ways;
    for (const Series* one : of_type(log_, "sensor_msgs/Imu")) {
      const auto attitude = attitude_of(*one);
      if (!attitude || !changes(*one, *attitude)) continue;
      Candidate way{ros2_label(log_, *one), one, [=, this] { headings(*one, *attitude); }};
      ways.insert(one == of_imu ? ways.begin() : ways.end(), std::move(way));
    }
    make_best("heading", ways, false, options_, out_);
    settle(out_.data.of<HeadingSample>(), "heading", out_);
  }

  void headings(const Series& series, const Attitude& attitude) {
    const Mounting mounting = frames_.of(series, series.frame);
    auto& samples = out_.data.of<HeadingSample>();
    const Eigen::Vector3d forward_S = mounting.C_BS.row(0).transpose();
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const auto header = clock_.header(series, row);
      const auto q_WS = quaternion(series, row, attitude);
      if (!header || !q_WS) continue;
      const Eigen::Vector3d forward_W = geo::to_matrix(*q_WS) * forward_S;
      if (forward_W.head<2>().norm() < kLeastHorizontal) continue;
      HeadingSample& sample = samples.emplace_back();
      sample.header = *header;
      const double north = mounting.ned ? forward_W.x() : forward_W.y();
      const double east = mounting.ned ? forward_W.y() : forward_W.x();
      sample.heading_rad = geo::wrap_two_pi(std::atan2(east, north));
      sample.sigma_rad = sigma_of(series.at(row, attitude.yaw));
    }
    out_.notes.push_back("heading: from orientation of " + series.topic +
                         (mounting.ned ? ", 0 is north" : ", 0 of its yaw is east") +
                         "; whether that is true north is not in the log");
  }

  // --- pressure -----------------------------------------------------------------------------------------

  [[nodiscard]] static bool in_water(const Series& series, std::size_t column) {
    std::vector<double> all;
    for (std::size_t row = 0; row < series.rows(); ++row)
      if (known(series.at(row, column))) all.push_back(series.at(row, column));
    if (all.empty()) return false;
    const auto high = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) * 99 / 100);
    std::nth_element(all.begin(), high, all.end());
    return *high > kMostAir_Pa;
  }

  void pressure() {
    Table table{"baro", {"pressure_Pa", "temperature_degC", "altitude_m"}, {}, {}};
    std::vector<Candidate> baro, depth;
    for (const Series* one : of_type(log_, "sensor_msgs/FluidPressure")) {
      const auto column = one->find("fluid_pressure");
      if (!column) continue;
      const std::string label = ros2_label(log_, *one);
      const bool wet = in_water(*one, *column);
      const auto asked = [&](const char* file) {
        const auto found = options_.choice.find(file);
        return found != options_.choice.end() && (found->second == label || found->second == one->label());
      };
      if ((wet && !asked("baro")) || asked("depth"))
        depth.push_back({label, one, [=, this] { depths(*one, *column); }});
      else
        baro.push_back({label, one, [=, this, &table] { barometer(*one, *column, table); }});
    }
    make_best("depth", depth, false, options_, out_);
    settle(out_.data.of<DepthSample>(), "depth", out_);
    make_best("baro", baro, false, options_, out_);
    if (table.stamps_ns.empty()) return;
    settle(table);
    attach_baro(table, 2, out_.data.of<AirspeedSample>());
    settle(out_.data.of<AirspeedSample>(), "airspeed", out_);
    out_.tables.push_back(std::move(table));
  }

  void barometer(const Series& series, std::size_t column, Table& table) const {
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const auto header = clock_.header(series, row);
      if (!header) continue;
      const double pressure_Pa = series.at(row, column);
      table.stamps_ns.push_back(header->stamp_ns);
      table.values.insert(table.values.end(), {pressure_Pa, kUnknown, standard_altitude_m(pressure_Pa)});
    }
  }

  void depths(const Series& series, std::size_t column) {
    const auto variance = series.find("variance");
    const double Pa_per_m = options_.ros2.water_density_kg_m3 * kStandardGravity_m_s2;
    auto& samples = out_.data.of<DepthSample>();
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const auto header = clock_.header(series, row);
      if (!header) continue;
      DepthSample& sample = samples.emplace_back();
      sample.header = *header;
      sample.pressure_Pa = series.at(row, column);
      sample.depth_m = (sample.pressure_Pa - options_.ros2.surface_pressure_Pa) / Pa_per_m;
      sample.sigma_m = sigma_of(series.at(row, variance)) / Pa_per_m;
    }
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(), "depth: %g Pa at the surface, water of %g kg/m3",
                  options_.ros2.surface_pressure_Pa, options_.ros2.water_density_kg_m3);
    out_.notes.emplace_back(text.data());
  }

  // --- magnetic field -----------------------------------------------------------------------------------

  void magnetometer() {
    std::vector<Candidate> ways;
    Table table{"mag", {"mx_T", "my_T", "mz_T"}, {}, {}};
    for (const Series* one : of_type(log_, "sensor_msgs/MagneticField")) {
      const auto xyz = xyz_of(*one, "magnetic_field");
      if (!xyz) continue;
      ways.push_back({ros2_label(log_, *one), one, [=, this, &table] {
                        const Mounting mounting = frames_.of(*one, one->frame);
                        for (std::size_t row = 0; row < one->rows(); ++row) {
                          const auto header = clock_.header(*one, row);
                          if (!header) continue;
                          const Eigen::Vector3d m = mounting.C_BS * vector_at(*one, row, *xyz);
                          table.stamps_ns.push_back(header->stamp_ns);
                          table.values.insert(table.values.end(), {m.x(), m.y(), m.z()});
                        }
                      }});
    }
    make_best("mag", ways, false, options_, out_);
    if (table.stamps_ns.empty()) return;
    settle(table);
    out_.tables.push_back(std::move(table));
  }

  // --- where the instruments are ------------------------------------------------------------------------

  // The data set has no place for levers: what the log tells of them goes into the configuration by hand.
  void levers(const Series* imu) {
    if (imu == nullptr) return;
    const auto origin = frames_.lever_B_m(imu->frame);
    if (!origin) return;
    for (const auto& [file, label] : out_.sources) {
      if (file == "imu" || file == "heading" || file == "mag" || file == "baro") continue;
      for (const Series& series : log_.series) {
        if (ros2_label(log_, series) != label) continue;
        if (const auto lever = frames_.lever_B_m(series.frame))
          out_.notes.push_back(file + ": " + series.frame + " is at " + metres(*lever - *origin) +
                               " forward, right, down of the inertial unit, by tf_static");
      }
    }
  }

  const Log& log_;
  const ConvertOptions& options_;
  Vehicle out_;  // before the clock, which takes notes in it
  Ros2Clock clock_;
  Ros2Frames frames_;
};

}  // namespace

Vehicle ros2_bag(const Log& log, const ConvertOptions& options) {
  return Ros2(log, options).convert();
}

}  // namespace fathom::logs
