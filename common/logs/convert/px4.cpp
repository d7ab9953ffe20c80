#include <array>
#include <cmath>

#include "base/median.hpp"
#include "logs/convert/build.hpp"
#include "logs/convert/px4_gps.hpp"

namespace fathom::logs {
namespace {

constexpr double kNoRelativeTime = 2147483647.0;
/// Pressures below are hectopascal: a barometer of an early PX4. Above 5000 hPa it would be 40 m under water,
/// below 5000 Pa 20 km up.
constexpr double kMostHectopascal = 5000.0;

class Px4 {
 public:
  Px4(const Log& log, const ConvertOptions& options) : log_(log), options_(options) {}

  Vehicle convert() {
    out_.utc_of_start_ns = px4_utc_of_start(log_);
    if (options_.utc) {
      if (!out_.utc_of_start_ns)
        throw LogError("no GPS message with a UTC, expected one to count t_s in UTC");
      clock_.zero_ns = *out_.utc_of_start_ns;
    }
    imu();
    px4_gps(log_, clock_, options_, out_);
    airspeed();
    baro();
    magnetometer();
    return std::move(out_);
  }

 private:
  [[nodiscard]] SampleHeader header(const Series& series, std::size_t row,
                                    const std::optional<std::size_t>& sample) const {
    const double valid_us = series.at(row, sample);
    return clock_.header(whole_us(valid_us), series.t_us[row]);
  }

  // --- inertial unit ------------------------------------------------------------------------------------

  void imu() {
    std::vector<Candidate> ways;
    auto& samples = out_.data.of<ImuSample>();
    for (const Series* one : log_.of("sensor_combined")) {
      // Before 2016-06 there were three of each in one array.
      const auto gyro =
          one->find_vector("gyro_rad") ? one->find_vector("gyro_rad") : one->find_vector("gyro_rad_s");
      const auto accel = one->find_vector("accelerometer_m_s2");
      if (!gyro || !accel) continue;
      ways.push_back({one->label(), one, [=, this, &samples] { combined(*one, *gyro, *accel, samples); }});
    }
    for (const Series* one : log_.of("vehicle_imu")) {
      if (!one->find_vector("delta_angle") || !one->find_vector("delta_velocity")) continue;
      ways.push_back({one->label(), one, [=, this, &samples] { increments(*one, samples); }});
    }
    const auto accels = log_.of("sensor_accel");
    for (const Series* gyro : log_.of("sensor_gyro")) {
      for (const Series* accel : accels) {
        if (accel->instance != gyro->instance) continue;
        const auto g = triad(*gyro);
        const auto a = triad(*accel);
        if (!g || !a) continue;
        ways.push_back({gyro->label(), gyro, [=, this, &samples] { samples = joined(*g, *a, clock_); }});
        break;
      }
    }
    // The raw unit is uncalibrated and of the board's axes: taken where there is nothing else.
    std::vector<Candidate> calibrated;
    for (const Candidate& one : ways)
      if (!one.label.starts_with("sensor_gyro")) calibrated.push_back(one);
    const bool asked = options_.choice.contains("imu");
    make_best("imu", asked || calibrated.empty() ? ways : calibrated, true, options_, out_);
    if (!calibrated.empty()) {
      for (const Candidate& one : ways)
        if (one.label.starts_with("sensor_gyro") && !asked) out_.others["imu"].push_back(one.label);
    }
    settle(samples, "imu", out_);
  }

  [[nodiscard]] static std::optional<Triad> triad(const Series& series) {
    const auto xyz = series.find_three({"x", "y", "z"});
    if (!xyz) return std::nullopt;
    return Triad{&series, *xyz, series.find("timestamp_sample"), 1.0};
  }

  void combined(const Series& series, const std::array<std::size_t, 3>& gyro,
                const std::array<std::size_t, 3>& accel, std::vector<ImuSample>& samples) const {
    const auto relative = series.find("accelerometer_timestamp_relative");
    for (std::size_t row = 0; row < series.rows(); ++row) {
      ImuSample& sample = samples.emplace_back();
      sample.header = clock_.header(0, series.t_us[row]);
      // It says when there is no acceleration with the rates.
      const bool accelerated = series.at(row, relative) != kNoRelativeTime;
      for (std::size_t i = 0; i < 3; ++i) {
        sample.angular_rate_B_rad_s[i] = series.at(row, gyro[i]);
        if (accelerated) sample.specific_force_B_m_s2[i] = series.at(row, accel[i]);
      }
    }
  }

  void increments(const Series& series, std::vector<ImuSample>& samples) const {
    const auto angle = *series.find_vector("delta_angle");
    const auto velocity = *series.find_vector("delta_velocity");
    // One period for both before 2020-10.
    const auto angle_us = series.find_any({"delta_angle_dt", "dt"});
    const auto velocity_us = series.find_any({"delta_velocity_dt", "dt"});
    const auto valid = series.find("timestamp_sample");
    for (std::size_t row = 0; row < series.rows(); ++row) {
      ImuSample& sample = samples.emplace_back();
      sample.header = header(series, row, valid);
      const double angle_s = series.at(row, angle_us) * 1e-6;
      const double velocity_s = series.at(row, velocity_us) * 1e-6;
      for (std::size_t i = 0; i < 3; ++i) {
        if (angle_s > 0.0) sample.angular_rate_B_rad_s[i] = series.at(row, angle[i]) / angle_s;
        if (velocity_s > 0.0) sample.specific_force_B_m_s2[i] = series.at(row, velocity[i]) / velocity_s;
      }
    }
  }

  // --- air data -----------------------------------------------------------------------------------------

  void airspeed() {
    std::vector<Candidate> ways;
    auto& samples = out_.data.of<AirspeedSample>();
    for (const Series* one : log_.of("airspeed"))
      ways.push_back({one->label(), one, [=, this, &samples] { measured(*one, samples); }});
    for (const Series* one : log_.of("airspeed_validated"))
      ways.push_back({one->label(), one, [=, this, &samples] { validated(*one, samples); }});
    make_best("airspeed", ways, false, options_, out_);
    settle(samples, "airspeed", out_);
  }

  void measured(const Series& series, std::vector<AirspeedSample>& samples) const {
    const auto indicated = series.find("indicated_airspeed_m_s");
    const auto true_air = series.find("true_airspeed_m_s");
    const auto valid = series.find("timestamp_sample");
    for (std::size_t row = 0; row < series.rows(); ++row) {
      AirspeedSample& sample = samples.emplace_back();
      sample.header = header(series, row, valid);
      sample.airspeed_m_s = series.at(row, indicated);
      sample.true_airspeed_m_s = series.at(row, true_air);
    }
  }

  // Calibrated where the sensor's own error is taken out. Speeds that the autopilot made from GPS and wind,
  // or from throttle and pitch, are no measurement of the air.
  void validated(const Series& series, std::vector<AirspeedSample>& samples) {
    const auto calibrated =
        series.find_any({"calibrated_airspeed_m_s", "equivalent_airspeed_m_s", "indicated_airspeed_m_s"});
    const auto true_air = series.find("true_airspeed_m_s");
    const auto source = series.find_any({"airspeed_source", "selected_airspeed_index"});
    const auto valid = series.find("timestamp_sample");
    std::size_t made_up = 0;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const double from = series.at(row, source);
      if (source && !(from >= 1.0 && from <= 3.0)) {
        ++made_up;
        continue;
      }
      AirspeedSample& sample = samples.emplace_back();
      sample.header = header(series, row, valid);
      sample.airspeed_m_s = series.at(row, calibrated);
      sample.true_airspeed_m_s = series.at(row, true_air);
    }
    if (made_up > 0) {
      out_.notes.push_back("airspeed: " + std::to_string(made_up) + " rows of " + series.label() +
                           " come from no airspeed sensor and are left out");
    }
  }

  void baro() {
    std::vector<Candidate> ways;
    Table table{"baro", {"pressure_Pa", "temperature_degC", "altitude_m"}, {}, {}};
    for (const char* topic : {"vehicle_air_data", "sensor_baro"}) {
      for (const Series* one : log_.of(topic))
        ways.push_back({one->label(), one, [=, this, &table] { barometer(*one, table); }});
    }
    for (const Series* one : log_.of("sensor_combined")) {
      if (!one->find("baro_alt_meter") || !one->find("baro_timestamp_relative")) continue;
      ways.push_back({one->label(), one, [=, this, &table] { combined_baro(*one, table); }});
    }
    make_best("baro", ways, false, options_, out_);
    if (table.stamps_ns.empty()) return;
    settle(table);
    attach_baro(table, 2, out_.data.of<AirspeedSample>());
    settle(out_.data.of<AirspeedSample>(), "airspeed", out_);
    out_.tables.push_back(std::move(table));
  }

  void barometer(const Series& series, Table& table) const {
    const auto pressure = series.find_any({"baro_pressure_pa", "pressure"});
    const auto temperature = series.find_any({"baro_temp_celcius", "ambient_temperature", "temperature"});
    const auto altitude = series.find_any({"baro_alt_meter", "altitude"});
    const auto valid = series.find("timestamp_sample");
    double scale = 1.0;
    if (pressure && series.columns[*pressure] == "pressure") {
      std::vector<double> all;
      for (std::size_t row = 0; row < series.rows(); ++row) all.push_back(series.at(row, *pressure));
      if (median(std::move(all)) < kMostHectopascal) scale = 100.0;
    }
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const double pressure_Pa = series.at(row, pressure) * scale;
      table.stamps_ns.push_back(header(series, row, valid).stamp_ns);
      table.values.push_back(pressure_Pa);
      table.values.push_back(series.at(row, temperature));
      table.values.push_back(altitude ? series.at(row, *altitude) : standard_altitude_m(pressure_Pa));
    }
  }

  void combined_baro(const Series& series, Table& table) const {
    const auto altitude = series.find("baro_alt_meter");
    const auto temperature = series.find("baro_temp_celcius");
    each_new(series, series.find("baro_timestamp_relative"), [&](std::size_t row, TimeNs stamp) {
      table.stamps_ns.push_back(stamp);
      table.values.insert(table.values.end(),
                          {kUnknown, series.at(row, temperature), series.at(row, altitude)});
    });
  }

  // --- magnetometer -------------------------------------------------------------------------------------

  void magnetometer() {
    std::vector<Candidate> ways;
    Table table{"mag", {"mx_T", "my_T", "mz_T"}, {}, {}};
    for (const Series* one : log_.of("vehicle_magnetometer")) {
      if (const auto xyz = one->find_vector("magnetometer_ga"))
        ways.push_back({one->label(), one, [=, this, &table] { field(*one, *xyz, table); }});
    }
    for (const Series* one : log_.of("sensor_mag")) {
      if (const auto xyz = triad(*one))
        ways.push_back({one->label(), one, [=, this, &table] { field(*one, xyz->xyz, table); }});
    }
    for (const Series* one : log_.of("sensor_combined")) {
      const auto xyz = one->find_vector("magnetometer_ga");
      if (!xyz || !one->find("magnetometer_timestamp_relative")) continue;
      ways.push_back({one->label(), one, [=, this, &table] {
                        each_new(*one, one->find("magnetometer_timestamp_relative"),
                                 [&](std::size_t row, TimeNs stamp) { keep(*one, row, stamp, *xyz, table); });
                      }});
    }
    make_best("mag", ways, false, options_, out_);
    if (table.stamps_ns.empty()) return;
    settle(table);
    out_.tables.push_back(std::move(table));
  }

  void field(const Series& series, const std::array<std::size_t, 3>& xyz, Table& table) const {
    const auto valid = series.find("timestamp_sample");
    for (std::size_t row = 0; row < series.rows(); ++row)
      keep(series, row, header(series, row, valid).stamp_ns, xyz, table);
  }
  static void keep(const Series& series, std::size_t row, TimeNs stamp, const std::array<std::size_t, 3>& xyz,
                   Table& table) {
    table.stamps_ns.push_back(stamp);
    for (const std::size_t i : xyz) table.values.push_back(series.at(row, i) * kTeslaPerGauss);
  }

  // The rows of a combined message that bring a new reading of a slower sensor, each at its own instant.
  template <class Use>
  void each_new(const Series& series, const std::optional<std::size_t>& relative, Use&& use) const {
    std::optional<std::int64_t> last_us;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      const double offset_us = series.at(row, relative);
      if (!(std::abs(offset_us) < kNoRelativeTime)) continue;
      const std::int64_t t_us = series.t_us[row] + static_cast<std::int64_t>(offset_us);
      if (last_us && t_us == *last_us) continue;
      last_us = t_us;
      use(row, clock_.at(t_us));
    }
  }

  const Log& log_;
  const ConvertOptions& options_;
  Clock clock_;
  Vehicle out_;
};

}  // namespace

const std::set<std::string>& px4_topics() {
  static const std::set<std::string> kTopics{
      "sensor_combined",  "vehicle_imu",          "sensor_accel",
      "sensor_gyro",      "vehicle_gps_position", "sensor_gps",
      "airspeed",         "airspeed_validated",   "differential_pressure",
      "vehicle_air_data", "sensor_baro",          "vehicle_magnetometer",
      "sensor_mag"};
  return kTopics;
}

Vehicle px4(const Log& log, const ConvertOptions& options) {
  return Px4(log, options).convert();
}

}  // namespace fathom::logs
