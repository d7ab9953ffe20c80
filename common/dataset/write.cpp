#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <system_error>

#include "base/unknown.hpp"
#include "dataset/csv_writer.hpp"
#include "dataset/dataset.hpp"
#include "dataset/fix_code.hpp"

namespace fathom::dataset {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// True when some row of the stream fulfils the predicate: an optional column is worth writing.
template <class T, class Predicate>
bool any(const std::vector<T>& stream, Predicate predicate) {
  return std::any_of(stream.begin(), stream.end(), predicate);
}

void numbers3(CsvWriter& csv, const std::array<double, 3>& values) {
  for (const double value : values) csv.number(value);
}

// Writes one file: `header` names the columns after t_s, `fields` appends them for a sample.
template <class T, class Fields>
void write_stream(const std::filesystem::path& directory, const char* kind, const WriteOptions& options,
                  const std::vector<T>& stream, const std::string& header, Fields fields) {
  std::error_code error;
  for (const char* suffix : {".csv", ".csv.gz"}) {
    // What an earlier run left would stand beside the new file, or for a sensor that this data set has not.
    std::filesystem::remove(directory / (std::string(kind) + suffix), error);
  }
  if (stream.empty()) return;
  CsvWriter csv(directory / (std::string(kind) + (options.gzip ? ".csv.gz" : ".csv")));
  const bool arrivals =
      any(stream, [](const T& sample) { return sample.header.received_ns != sample.header.stamp_ns; });
  csv.line("t_s," + header + (arrivals ? ",t_received_s" : ""));
  for (const T& sample : stream) {
    csv.seconds(sample.header.stamp_ns - options.epoch_ns);
    fields(csv, sample);
    if (arrivals) csv.seconds(sample.header.received_ns - options.epoch_ns);
    csv.end_row();
  }
  csv.close();
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<GpsSample>& stream) {
  const bool sigmas = any(stream, [](const GpsSample& s) { return known(s.velocity_sigma_N_m_s[0]); });
  const bool satellites = any(stream, [](const GpsSample& s) { return s.satellites >= 0; });
  const std::string header =
      std::string("lat_deg,lon_deg,alt_m,sigma_n_m,sigma_e_m,sigma_d_m,vn_m_s,ve_m_s,vd_m_s,fix") +
      (sigmas ? ",sigma_vn_m_s,sigma_ve_m_s,sigma_vd_m_s" : "") + (satellites ? ",satellites" : "");
  write_stream(directory, "gps", options, stream, header, [&](CsvWriter& csv, const GpsSample& s) {
    csv.number(s.latitude_rad * kDegPerRad).number(s.longitude_rad * kDegPerRad).number(s.altitude_m);
    numbers3(csv, s.position_sigma_N_m);
    numbers3(csv, s.velocity_N_m_s);
    csv.number(code_from_fix(s.fix));
    if (sigmas) numbers3(csv, s.velocity_sigma_N_m_s);
    if (satellites) csv.number(s.satellites >= 0 ? s.satellites : kUnknown);
  });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<DvlSample>& stream) {
  const bool beams = any(stream, [](const DvlSample& s) {
    return any(std::vector<double>(s.beam_velocity_m_s.begin(), s.beam_velocity_m_s.end()), known);
  });
  const bool sigma = any(stream, [](const DvlSample& s) { return known(s.sigma_m_s); });
  const bool altitude = any(stream, [](const DvlSample& s) { return known(s.altitude_m); });
  const bool water = any(stream, [](const DvlSample& s) { return s.mode == DvlMode::water; });
  const std::string header = std::string("vx_m_s,vy_m_s,vz_m_s") +
                             (beams ? ",b1_m_s,b2_m_s,b3_m_s,b4_m_s" : "") + (sigma ? ",sigma_m_s" : "") +
                             (altitude ? ",altitude_m" : "") + (water ? ",mode" : "");
  write_stream(directory, "dvl", options, stream, header, [&](CsvWriter& csv, const DvlSample& s) {
    numbers3(csv, s.velocity_D_m_s);
    if (beams) {
      for (const double beam : s.beam_velocity_m_s) csv.number(beam);
    }
    if (sigma) csv.number(s.sigma_m_s);
    if (altitude) csv.number(s.altitude_m);
    if (water) csv.text(s.mode == DvlMode::water ? "water" : "bottom");
  });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<DepthSample>& stream) {
  const bool sigma = any(stream, [](const DepthSample& s) { return known(s.sigma_m); });
  write_stream(directory, "depth", options, stream, sigma ? "depth_m,sigma_m" : "depth_m",
               [&](CsvWriter& csv, const DepthSample& s) {
                 csv.number(s.depth_m);
                 if (sigma) csv.number(s.sigma_m);
               });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<HeadingSample>& stream) {
  const bool sigma = any(stream, [](const HeadingSample& s) { return known(s.sigma_rad); });
  const bool magnetic = any(stream, [](const HeadingSample& s) { return s.north == North::magnetic; });
  const std::string header =
      std::string("heading_deg") + (sigma ? ",sigma_deg" : "") + (magnetic ? ",north" : "");
  write_stream(directory, "heading", options, stream, header, [&](CsvWriter& csv, const HeadingSample& s) {
    csv.number(s.heading_rad * kDegPerRad);
    if (sigma) csv.number(s.sigma_rad * kDegPerRad);
    if (magnetic) csv.text(s.north == North::magnetic ? "magnetic" : "true");
  });
}

const char* word(UsblFrame frame) {
  switch (frame) {
    case UsblFrame::geodetic:
      break;
    case UsblFrame::ned:
      return "ned";
    case UsblFrame::vessel_frd:
      return "vessel";
    case UsblFrame::vehicle_frd:
      return "vehicle";
  }
  return "geodetic";
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<UsblSample>& stream) {
  const bool relative = any(stream, [](const UsblSample& s) { return s.frame != UsblFrame::geodetic; });
  const std::string header =
      std::string("lat_deg,lon_deg,depth_m,sigma_m") +
      (relative ? ",frame,x_m,y_m,z_m,range_m,bearing_deg,depression_deg,sigma_deg,station_lat_deg,"
                  "station_lon_deg,station_depth_m,station_roll_deg,station_pitch_deg,station_yaw_deg"
                : "");
  write_stream(directory, "usbl", options, stream, header, [&](CsvWriter& csv, const UsblSample& s) {
    csv.number(s.latitude_rad * kDegPerRad).number(s.longitude_rad * kDegPerRad);
    csv.number(s.depth_m).number(s.sigma_m);
    if (!relative) return;
    csv.text(word(s.frame));
    numbers3(csv, s.relative_m);
    csv.number(s.range_m).number(s.bearing_rad * kDegPerRad).number(s.depression_rad * kDegPerRad);
    csv.number(s.sigma_rad * kDegPerRad).number(s.station_latitude_rad * kDegPerRad);
    csv.number(s.station_longitude_rad * kDegPerRad).number(s.station_depth_m);
    for (const double angle : s.station_rpy_rad) csv.number(angle * kDegPerRad);
  });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<AirspeedSample>& stream) {
  const bool altitude = any(stream, [](const AirspeedSample& s) { return known(s.baro_altitude_m); });
  const bool is_true = any(stream, [](const AirspeedSample& s) { return known(s.true_airspeed_m_s); });
  std::string columns = "airspeed_m_s";
  if (altitude) columns += ",baro_alt_m";
  if (is_true) columns += ",true_airspeed_m_s";
  write_stream(directory, "airspeed", options, stream, columns, [&](CsvWriter& csv, const AirspeedSample& s) {
    csv.number(s.airspeed_m_s);
    if (altitude) csv.number(s.baro_altitude_m);
    if (is_true) csv.number(s.true_airspeed_m_s);
  });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<ImuSample>& stream) {
  write_stream(directory, "imu", options, stream, "gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2",
               [](CsvWriter& csv, const ImuSample& s) {
                 numbers3(csv, s.angular_rate_B_rad_s);
                 numbers3(csv, s.specific_force_B_m_s2);
               });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<PropulsionSample>& stream) {
  write_stream(directory, "propulsion", options, stream, "rpm",
               [](CsvWriter& csv, const PropulsionSample& s) { csv.number(s.rpm); });
}

void write_rows(const std::filesystem::path& directory, const WriteOptions& options,
                const std::vector<FinsSample>& stream) {
  write_stream(directory, "fins", options, stream, "rudder_rad,stern_rad",
               [](CsvWriter& csv, const FinsSample& s) { csv.number(s.rudder_rad).number(s.stern_rad); });
}

}  // namespace

void write(const std::filesystem::path& directory, const Dataset& data, const WriteOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw DatasetError(directory.string() + ": cannot be created: " + error.message());
  for_each_kind(
      [&](auto kind) { write_rows(directory, options, stream<typename decltype(kind)::Sample>(data)); });
  write_stream(
      directory, "reference", options, data.reference,
      "lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg",
      [](CsvWriter& csv, const Truth& s) {
        csv.number(s.latitude_rad * kDegPerRad).number(s.longitude_rad * kDegPerRad).number(s.altitude_m);
        numbers3(csv, s.velocity_N_m_s);
        for (const double angle : s.rpy_rad) csv.number(angle * kDegPerRad);
      });
}

}  // namespace fathom::dataset
