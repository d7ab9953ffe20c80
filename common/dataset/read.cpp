#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>

#include "base/unknown.hpp"
#include "dataset/csv_reader.hpp"
#include "dataset/dataset.hpp"
#include "dataset/fix_code.hpp"

namespace fathom::dataset {
namespace {

using Column = CsvReader::Column;
using Optional = std::optional<Column>;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kLongestTime_s = 4.0e9;  // more than a century either side of the epoch

// A file of the folder, with the columns every file has.
class SensorFile {
 public:
  SensorFile(const std::filesystem::path& path, std::string_view kind, const ReadOptions& options)
      : csv(path),
        kind_(kind),
        options_(options),
        t_(csv.column("t_s")),
        received_(csv.optional_column("t_received_s")) {}

  bool next() {
    if (!csv.next()) return false;
    const TimeNs stamp = time(t_);
    const TimeNs received = received_ && !csv.text(*received_).empty() ? time(*received_) : stamp;
    if (sequence_ > 0) {
      stamps_sorted_ = stamps_sorted_ && stamp >= header.stamp_ns;
      arrivals_sorted_ = arrivals_sorted_ && received >= header.received_ns;
      if (!stamps_sorted_ && !(received_ && arrivals_sorted_)) {
        csv.fail("t_s " + std::string(csv.text(t_)) +
                 " is earlier than in the row before, expected rows sorted by t_s" +
                 (received_ ? " or by t_received_s" : ""));
      }
    }
    header = SampleHeader{options_.vehicle, kind_, stamp, received, sequence_++};
    return true;
  }

  // Latitude and longitude in the order of the columns, rad.
  std::array<double, 2> geodetic(Column latitude, Column longitude) const {
    const double lat = csv.number(latitude);
    const double lon = csv.number(longitude);
    if (std::abs(lat) > 90.0) csv.fail("column lat_deg: latitude lies outside +-90 degrees");
    if (std::abs(lon) > 360.0) csv.fail("column lon_deg: longitude lies outside +-360 degrees");
    return {lat * kRadPerDeg, lon * kRadPerDeg};
  }

  CsvReader csv;
  SampleHeader header;  // of the present row

 private:
  TimeNs time(Column column) const {
    const double t_s = csv.number(column);
    if (!(std::abs(t_s) <= kLongestTime_s)) {
      csv.fail("column " + std::string(csv.name(column)) + ": '" + std::string(csv.text(column)) +
               "' is not a time, expected seconds");
    }
    return options_.epoch_ns + from_seconds(t_s);
  }

  Name kind_;
  const ReadOptions& options_;
  Column t_;
  Optional received_;
  std::uint64_t sequence_ = 0;
  bool stamps_sorted_ = true;
  bool arrivals_sorted_ = true;
};

std::array<Column, 3> columns3(const CsvReader& csv, const char* a, const char* b, const char* c) {
  return {csv.column(a), csv.column(b), csv.column(c)};
}

std::array<double, 3> numbers3(const CsvReader& csv, const std::array<Column, 3>& columns) {
  return {csv.number(columns[0]), csv.number(columns[1]), csv.number(columns[2])};
}

std::array<Optional, 3> optional3(const CsvReader& csv, const char* a, const char* b, const char* c) {
  return {csv.optional_column(a), csv.optional_column(b), csv.optional_column(c)};
}

std::array<Optional, 3> required3(const CsvReader& csv, const char* a, const char* b, const char* c) {
  return {csv.column(a), csv.column(b), csv.column(c)};
}

void read_rows(SensorFile& file, std::vector<ImuSample>& out) {
  const auto rate = columns3(file.csv, "gx_rad_s", "gy_rad_s", "gz_rad_s");
  const auto force = columns3(file.csv, "ax_m_s2", "ay_m_s2", "az_m_s2");
  while (file.next()) {
    ImuSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.angular_rate_B_rad_s = numbers3(file.csv, rate);
    sample.specific_force_B_m_s2 = numbers3(file.csv, force);
  }
}

void read_rows(SensorFile& file, std::vector<GpsSample>& out) {
  const CsvReader& csv = file.csv;
  const auto position = columns3(csv, "lat_deg", "lon_deg", "alt_m");
  const auto sigma = columns3(csv, "sigma_n_m", "sigma_e_m", "sigma_d_m");
  const auto velocity = columns3(csv, "vn_m_s", "ve_m_s", "vd_m_s");
  const Column fix = csv.column("fix");
  const std::array<Optional, 3> velocity_sigma{csv.optional_column("sigma_vn_m_s"),
                                               csv.optional_column("sigma_ve_m_s"),
                                               csv.optional_column("sigma_vd_m_s")};
  const Optional satellites = csv.optional_column("satellites");
  while (file.next()) {
    GpsSample& sample = out.emplace_back();
    sample.header = file.header;
    const auto geodetic = file.geodetic(position[0], position[1]);
    sample.latitude_rad = geodetic[0];
    sample.longitude_rad = geodetic[1];
    sample.altitude_m = csv.number(position[2]);
    sample.position_sigma_N_m = numbers3(csv, sigma);
    sample.velocity_N_m_s = numbers3(csv, velocity);
    for (std::size_t i = 0; i < 3; ++i) sample.velocity_sigma_N_m_s[i] = csv.number(velocity_sigma[i]);
    const double count = csv.number(satellites);
    if (count >= 0.0 && count < 1000.0) sample.satellites = static_cast<std::int32_t>(count);
    const auto quality = fix_from_code(csv.number(fix));
    if (!quality) {
      csv.fail("column fix: '" + std::string(csv.text(fix)) +
               "' is not a fix quality, expected a whole number from 0");
    }
    // Without a position there is no fix, whatever the column says; a blank column vouches for the position.
    const bool has_position = known(sample.latitude_rad) && known(sample.longitude_rad);
    sample.fix = has_position ? *quality : GpsFix::none;
  }
}

void read_rows(SensorFile& file, std::vector<DvlSample>& out) {
  const CsvReader& csv = file.csv;
  const auto velocity = columns3(csv, "vx_m_s", "vy_m_s", "vz_m_s");
  const std::array<Optional, 4> beams{csv.optional_column("b1_m_s"), csv.optional_column("b2_m_s"),
                                      csv.optional_column("b3_m_s"), csv.optional_column("b4_m_s")};
  const Optional valid = csv.optional_column("valid");
  const Optional sigma = csv.optional_column("sigma_m_s");
  const Optional altitude = csv.optional_column("altitude_m");
  const Optional mode = csv.optional_column("mode");
  while (file.next()) {
    DvlSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.velocity_D_m_s = numbers3(csv, velocity);
    for (std::size_t i = 0; i < 4; ++i) sample.beam_velocity_m_s[i] = csv.number(beams[i]);
    sample.sigma_m_s = csv.number(sigma);
    sample.altitude_m = csv.number(altitude);
    const double is_valid = csv.number(valid);
    if (known(is_valid) && is_valid != 0.0 && is_valid != 1.0) {
      csv.fail("column valid: '" + std::string(csv.text(*valid)) + "', expected 0 or 1");
    }
    if (is_valid == 0.0) sample.velocity_D_m_s.fill(kUnknown);
    if (mode && !csv.text(*mode).empty()) {
      const std::string_view word = csv.text(*mode);
      if (word != "bottom" && word != "water") {
        csv.fail("column mode: '" + std::string(word) + "', expected bottom or water");
      }
      sample.mode = word == "water" ? DvlMode::water : DvlMode::bottom;
    }
  }
}

void read_rows(SensorFile& file, std::vector<DepthSample>& out) {
  const Column depth = file.csv.column("depth_m");
  const Optional sigma = file.csv.optional_column("sigma_m");
  while (file.next()) {
    DepthSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.depth_m = file.csv.number(depth);
    sample.sigma_m = file.csv.number(sigma);
  }
}

void read_rows(SensorFile& file, std::vector<HeadingSample>& out) {
  const CsvReader& csv = file.csv;
  const Column heading = csv.column("heading_deg");
  const Optional sigma = csv.optional_column("sigma_deg");
  const Optional north = csv.optional_column("north");
  while (file.next()) {
    HeadingSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.heading_rad = csv.number(heading) * kRadPerDeg;
    sample.sigma_rad = csv.number(sigma) * kRadPerDeg;
    if (north && !csv.text(*north).empty()) {
      const std::string_view word = csv.text(*north);
      if (word != "true" && word != "magnetic") {
        csv.fail("column north: '" + std::string(word) + "', expected true or magnetic");
      }
      sample.north = word == "magnetic" ? North::magnetic : North::true_north;
    }
  }
}

UsblFrame usbl_frame(const CsvReader& csv, const Optional& column) {
  const std::string_view word = column ? csv.text(*column) : std::string_view{};
  if (word.empty() || word == "geodetic") return UsblFrame::geodetic;
  if (word == "ned") return UsblFrame::ned;
  if (word == "vessel") return UsblFrame::vessel_frd;
  if (word == "vehicle") return UsblFrame::vehicle_frd;
  csv.fail("column frame: '" + std::string(word) + "', expected geodetic, ned, vessel or vehicle");
}

// What a fix relative to a station consists of; every column is optional.
struct RelativeColumns {
  explicit RelativeColumns(const CsvReader& csv)
      : path(optional3(csv, "x_m", "y_m", "z_m")),
        range(csv.optional_column("range_m")),
        bearing(csv.optional_column("bearing_deg")),
        depression(csv.optional_column("depression_deg")),
        sigma(csv.optional_column("sigma_deg")),
        station(optional3(csv, "station_lat_deg", "station_lon_deg", "station_depth_m")),
        station_rpy(optional3(csv, "station_roll_deg", "station_pitch_deg", "station_yaw_deg")) {}

  void read(const CsvReader& csv, UsblSample& sample) const {
    for (std::size_t i = 0; i < 3; ++i) {
      sample.relative_m[i] = csv.number(path[i]);
      sample.station_rpy_rad[i] = csv.number(station_rpy[i]) * kRadPerDeg;
    }
    sample.range_m = csv.number(range);
    sample.bearing_rad = csv.number(bearing) * kRadPerDeg;
    sample.depression_rad = csv.number(depression) * kRadPerDeg;
    sample.sigma_rad = csv.number(sigma) * kRadPerDeg;
    sample.station_latitude_rad = csv.number(station[0]) * kRadPerDeg;
    sample.station_longitude_rad = csv.number(station[1]) * kRadPerDeg;
    sample.station_depth_m = csv.number(station[2]);
  }

  std::array<Optional, 3> path;
  Optional range, bearing, depression, sigma;
  std::array<Optional, 3> station, station_rpy;
};

void read_rows(SensorFile& file, std::vector<UsblSample>& out) {
  const CsvReader& csv = file.csv;
  const Optional frame = csv.optional_column("frame");
  const std::array<Optional, 3> position = frame ? optional3(csv, "lat_deg", "lon_deg", "depth_m")
                                                 : required3(csv, "lat_deg", "lon_deg", "depth_m");
  const RelativeColumns relative(csv);
  const Column sigma = csv.column("sigma_m");
  while (file.next()) {
    UsblSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.frame = usbl_frame(csv, frame);
    sample.sigma_m = csv.number(sigma);
    if (sample.frame != UsblFrame::geodetic) {
      relative.read(csv, sample);
      continue;
    }
    if (!position[0] || !position[1] || !position[2])
      csv.fail("column frame: geodetic, expected the columns lat_deg, lon_deg and depth_m");
    const auto geodetic = file.geodetic(*position[0], *position[1]);
    sample.latitude_rad = geodetic[0];
    sample.longitude_rad = geodetic[1];
    sample.depth_m = csv.number(*position[2]);
  }
}

void read_rows(SensorFile& file, std::vector<AirspeedSample>& out) {
  const Column airspeed = file.csv.column("airspeed_m_s");
  const Optional altitude = file.csv.optional_column("baro_alt_m");
  const Optional true_airspeed = file.csv.optional_column("true_airspeed_m_s");
  while (file.next()) {
    AirspeedSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.airspeed_m_s = file.csv.number(airspeed);
    sample.baro_altitude_m = file.csv.number(altitude);
    sample.true_airspeed_m_s = file.csv.number(true_airspeed);
  }
}

void read_rows(SensorFile& file, std::vector<PropulsionSample>& out) {
  const Column rpm = file.csv.column("rpm");
  while (file.next()) {
    PropulsionSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.rpm = file.csv.number(rpm);
  }
}

void read_rows(SensorFile& file, std::vector<FinsSample>& out) {
  const Column rudder = file.csv.column("rudder_rad");
  const Column stern = file.csv.column("stern_rad");
  while (file.next()) {
    FinsSample& sample = out.emplace_back();
    sample.header = file.header;
    sample.rudder_rad = file.csv.number(rudder);
    sample.stern_rad = file.csv.number(stern);
  }
}

void read_rows(SensorFile& file, std::vector<Truth>& out) {
  const CsvReader& csv = file.csv;
  const auto position = columns3(csv, "lat_deg", "lon_deg", "alt_m");
  const auto velocity = columns3(csv, "vn_m_s", "ve_m_s", "vd_m_s");
  const auto attitude = columns3(csv, "roll_deg", "pitch_deg", "yaw_deg");
  while (file.next()) {
    Truth& sample = out.emplace_back();
    sample.header = file.header;
    const auto geodetic = file.geodetic(position[0], position[1]);
    sample.latitude_rad = geodetic[0];
    sample.longitude_rad = geodetic[1];
    sample.altitude_m = csv.number(position[2]);
    sample.velocity_N_m_s = numbers3(csv, velocity);
    sample.rpy_rad = numbers3(csv, attitude);
    for (double& angle : sample.rpy_rad) angle *= kRadPerDeg;
  }
}

template <class T>
void read_stream(const std::filesystem::path& directory, std::string_view kind, const ReadOptions& options,
                 std::vector<T>& out) {
  const std::filesystem::path plain = directory / (std::string(kind) + ".csv");
  std::filesystem::path zipped = plain;
  zipped += ".gz";
  const bool has_plain = std::filesystem::exists(plain);
  const bool has_zipped = std::filesystem::exists(zipped);
  if (has_plain && has_zipped) {
    throw DatasetError(plain.string() + ": exists beside " + zipped.filename().string() +
                       ", expected one of the two");
  }
  if (!has_plain && !has_zipped) return;
  SensorFile file(has_plain ? plain : zipped, kind, options);
  read_rows(file, out);
}

}  // namespace

Dataset read(const std::filesystem::path& directory, const ReadOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_directory(directory, error)) {
    throw DatasetError(directory.string() + ": is not a folder, expected a data set with imu.csv and others");
  }
  Dataset data;
  for_each_kind([&](auto kind) {
    read_stream(directory, kind.kWord, options, stream<typename decltype(kind)::Sample>(data));
  });
  read_stream(directory, "reference", options, data.reference);
  return data;
}

std::vector<Arrival> arrivals(const Dataset& data) {
  std::vector<Arrival> order;
  for_each_kind([&](auto kind) {
    const auto& samples = stream<typename decltype(kind)::Sample>(data);
    for (std::size_t i = 0; i < samples.size(); ++i)
      order.push_back({samples[i].header.received_ns, kind.kSource, static_cast<std::uint32_t>(i)});
  });
  std::stable_sort(order.begin(), order.end(),
                   [](const Arrival& a, const Arrival& b) { return a.received_ns < b.received_ns; });
  return order;
}

}  // namespace fathom::dataset
