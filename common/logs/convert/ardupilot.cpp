#include <array>
#include <cmath>

#include "base/median.hpp"
#include "logs/convert/ardupilot_gps.hpp"
#include "logs/convert/build.hpp"

namespace fathom::logs {
namespace {

/// The Earth has 0.7 gauss at most: above this the log has milligauss and does not say so.
constexpr double kMostGauss = 10.0;

std::optional<std::array<std::size_t, 3>> triple(const Series& series, const std::string& stem) {
  return series.find_three({stem + "X", stem + "Y", stem + "Z"});
}

class ArduPilot {
 public:
  ArduPilot(const Log& log, const ConvertOptions& options) : log_(log), options_(options) {}

  Vehicle convert() {
    out_.utc_of_start_ns = ardupilot_utc_of_start(log_);
    if (options_.utc) {
      if (!out_.utc_of_start_ns)
        throw LogError("no GPS message with a week, expected one to count t_s in UTC");
      clock_.zero_ns = *out_.utc_of_start_ns;
    }
    imu();
    ardupilot_gps(log_, clock_, options_, out_);
    airspeed();
    baro();
    magnetometer();
    return std::move(out_);
  }

 private:
  void imu() {
    std::vector<Candidate> ways;
    auto& samples = out_.data.of<ImuSample>();
    for (const Series* one : log_.of("IMU")) {
      const auto gyro = triple(*one, "Gyr");
      const auto accel = triple(*one, "Acc");
      if (gyro && accel)
        ways.push_back({one->label(), one, [=, this, &samples] { rates(*one, *gyro, *accel, samples); }});
    }
    for (const Series* one : log_.of("IMT")) {
      if (triple(*one, "DelA") && triple(*one, "DelV") && one->find("DelaT") && one->find("DelvT"))
        ways.push_back({one->label(), one, [=, this, &samples] { increments(*one, samples); }});
    }
    const auto accels = log_.of("ACC");
    for (const Series* gyro : log_.of("GYR")) {
      for (const Series* accel : accels) {
        const auto g = triple(*gyro, "Gyr");
        const auto a = triple(*accel, "Acc");
        if (accel->instance != gyro->instance || !g || !a) continue;
        const Triad rate{gyro, *g, gyro->find("SampleUS"), 1.0};
        const Triad force{accel, *a, accel->find("SampleUS"), 1.0};
        ways.push_back({gyro->label(), gyro, [=, this, &samples] { samples = joined(rate, force, clock_); }});
        break;
      }
    }
    make_best("imu", ways, true, options_, out_);
    settle(samples, "imu", out_);
  }

  void rates(const Series& series, const std::array<std::size_t, 3>& gyro,
             const std::array<std::size_t, 3>& accel, std::vector<ImuSample>& samples) const {
    for (std::size_t row = 0; row < series.rows(); ++row) {
      ImuSample& sample = samples.emplace_back();
      sample.header = clock_.header(0, series.t_us[row]);
      for (std::size_t i = 0; i < 3; ++i) {
        sample.angular_rate_B_rad_s[i] = series.at(row, gyro[i]);
        sample.specific_force_B_m_s2[i] = series.at(row, accel[i]);
      }
    }
  }

  void increments(const Series& series, std::vector<ImuSample>& samples) const {
    const auto angle = *triple(series, "DelA");
    const auto velocity = *triple(series, "DelV");
    const std::size_t angle_s = *series.find("DelaT");
    const std::size_t velocity_s = *series.find("DelvT");
    for (std::size_t row = 0; row < series.rows(); ++row) {
      ImuSample& sample = samples.emplace_back();
      sample.header = clock_.header(0, series.t_us[row]);
      for (std::size_t i = 0; i < 3; ++i) {
        if (series.at(row, angle_s) > 0.0)
          sample.angular_rate_B_rad_s[i] = series.at(row, angle[i]) / series.at(row, angle_s);
        if (series.at(row, velocity_s) > 0.0)
          sample.specific_force_B_m_s2[i] = series.at(row, velocity[i]) / series.at(row, velocity_s);
      }
    }
  }

  void airspeed() {
    std::vector<Candidate> ways;
    auto& samples = out_.data.of<AirspeedSample>();
    for (const Series* one : log_.of("ARSP")) {
      const auto speed = one->find("Airspeed");
      if (!speed) continue;
      ways.push_back({one->label(), one, [=, this, &samples] {
                        for (std::size_t row = 0; row < one->rows(); ++row) {
                          AirspeedSample& sample = samples.emplace_back();
                          sample.header = clock_.header(0, one->t_us[row]);
                          sample.airspeed_m_s = one->at(row, *speed);
                        }
                      }});
    }
    make_best("airspeed", ways, false, options_, out_);
    settle(samples, "airspeed", out_);
  }

  [[nodiscard]] bool is_submarine() const {
    const auto firmware = log_.info.find("firmware");
    return firmware != log_.info.end() && firmware->second.find("Sub") != std::string::npos;
  }

  void baro() {
    // ArduSub takes the gauge in the water for the primary one.
    unsigned primary = 0;
    if (const auto found = log_.parameters.find("BARO_PRIMARY");
        found != log_.parameters.end() && found->second >= 0.0 && found->second < 8.0)
      primary = static_cast<unsigned>(found->second);
    std::vector<Candidate> ways;
    Table table{"baro", {"pressure_Pa", "temperature_degC", "altitude_m"}, {}, {}};
    for (const Series* one : log_.of("BARO")) {
      Candidate way{one->label(), one, [=, this, &table] { barometer(*one, table); }};
      ways.insert(one->instance == primary ? ways.begin() : ways.end(), std::move(way));
    }
    make_best("baro", ways, false, options_, out_);
    if (table.stamps_ns.empty()) return;
    settle(table);
    if (is_submarine()) {
      depth(table);
    } else {
      attach_baro(table, 2, out_.data.of<AirspeedSample>());
      settle(out_.data.of<AirspeedSample>(), "airspeed", out_);
    }
    out_.tables.push_back(std::move(table));
  }

  // Altitudes of BARO begin at zero where the vehicle was switched on. A pressure has no such zero.
  void barometer(const Series& series, Table& table) const {
    const auto pressure = series.find("Press");
    const auto temperature = series.find("Temp");
    const auto above_sea = series.find("AltAMSL");
    const auto relative = series.find("Alt");
    const bool water = is_submarine();
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const double pressure_Pa = series.at(row, pressure);
      const double from_pressure_m = standard_altitude_m(pressure_Pa);
      table.stamps_ns.push_back(clock_.at(series.t_us[row]));
      table.values.push_back(pressure_Pa);
      table.values.push_back(series.at(row, temperature));
      table.values.push_back(water                    ? series.at(row, relative)
                             : above_sea              ? series.at(row, *above_sea)
                             : known(from_pressure_m) ? from_pressure_m
                                                      : series.at(row, relative));
    }
  }

  void depth(const Table& baro) {
    auto& samples = out_.data.of<DepthSample>();
    for (std::size_t row = 0; row < baro.stamps_ns.size(); ++row) {
      DepthSample& sample = samples.emplace_back();
      sample.header.stamp_ns = sample.header.received_ns = baro.stamps_ns[row];
      sample.pressure_Pa = baro.values[3 * row];
      sample.depth_m = -baro.values[3 * row + 2];
    }
    settle(samples, "depth", out_);
    out_.sources["depth"] = out_.sources["baro"];
  }

  void magnetometer() {
    std::vector<Candidate> ways;
    Table table{"mag", {"mx_T", "my_T", "mz_T"}, {}, {}};
    for (const Series* one : log_.of("MAG")) {
      const auto xyz = triple(*one, "Mag");
      if (xyz) ways.push_back({one->label(), one, [=, this, &table] { field(*one, *xyz, table); }});
    }
    make_best("mag", ways, false, options_, out_);
    if (table.stamps_ns.empty()) return;
    settle(table);
    out_.tables.push_back(std::move(table));
  }

  void field(const Series& series, const std::array<std::size_t, 3>& xyz, Table& table) const {
    std::vector<double> sizes;
    for (std::size_t row = 0; row < series.rows(); ++row)
      sizes.push_back(std::hypot(series.at(row, xyz[0]), series.at(row, xyz[1]), series.at(row, xyz[2])));
    const double gauss = median(std::move(sizes)) > kMostGauss ? 1e-3 : 1.0;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      table.stamps_ns.push_back(clock_.at(series.t_us[row]));
      for (const std::size_t i : xyz) table.values.push_back(series.at(row, i) * gauss * kTeslaPerGauss);
    }
  }

  const Log& log_;
  const ConvertOptions& options_;
  Clock clock_;
  Vehicle out_;
};

}  // namespace

const std::set<std::string>& ardupilot_topics() {
  static const std::set<std::string> kTopics{"IMU", "IMT", "ACC", "GYR", "GPS", "GPA", "ARSP", "BARO", "MAG"};
  return kTopics;
}

Vehicle ardupilot(const Log& log, const ConvertOptions& options) {
  return ArduPilot(log, options).convert();
}

}  // namespace fathom::logs
