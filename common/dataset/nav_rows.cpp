#include "dataset/nav_rows.hpp"

#include <cmath>
#include <optional>

#include "dataset/columns.hpp"
#include "dataset/csv_reader.hpp"

namespace fathom::dataset {
namespace {

using Place = std::optional<CsvReader::Column>;

struct Triple {
  Triple(const CsvReader& csv, std::array<const char*, 3> names, double scale) : scale_(scale) {
    for (std::size_t i = 0; i < 3; ++i) places_[i] = csv.optional_column(names[i]);
  }
  void read(const CsvReader& csv, std::array<double, 3>& out) const {
    for (std::size_t i = 0; i < 3; ++i) out[i] = csv.number(places_[i]) * scale_;
  }

 private:
  std::array<Place, 3> places_;
  double scale_;
};

}  // namespace

void read_nav_rows(const std::filesystem::path& path, const std::function<void(const NavRow&)>& consumer) {
  CsvReader csv(path);
  const auto t = csv.column("t_s");
  const auto latitude = csv.column("lat_deg");
  const auto longitude = csv.column("lon_deg");
  const auto altitude = csv.column("alt_m");
  const Triple velocity(csv, {"vn_m_s", "ve_m_s", "vd_m_s"}, 1.0);
  const Triple rpy(csv, {"roll_deg", "pitch_deg", "yaw_deg"}, kRadPerDeg);
  const Triple position_sigma(csv, {"sigma_n_m", "sigma_e_m", "sigma_d_m"}, 1.0);
  const Triple velocity_sigma(csv, {"sigma_vn_m_s", "sigma_ve_m_s", "sigma_vd_m_s"}, 1.0);
  const Triple rpy_sigma(csv, {"sigma_roll_deg", "sigma_pitch_deg", "sigma_yaw_deg"}, kRadPerDeg);
  const Place mode = csv.optional_column("mode");
  std::optional<DurationNs> before_ns;
  NavRow row;
  while (csv.next()) {
    const double t_s = csv.number(t);
    if (!(std::abs(t_s) < 4e9)) csv.fail("column t_s: '" + std::string(csv.text(t)) + "', expected seconds");
    row.t_ns = from_seconds(t_s);
    if (before_ns && row.t_ns < *before_ns)
      csv.fail("t_s " + std::string(csv.text(t)) + " is earlier than in the row before");
    before_ns = row.t_ns;
    const double latitude_deg = csv.number(latitude);
    const double longitude_deg = csv.number(longitude);
    if (std::abs(latitude_deg) > 90.0) csv.fail("column lat_deg: latitude lies outside +-90 degrees");
    if (std::abs(longitude_deg) > 360.0) csv.fail("column lon_deg: longitude lies outside +-360 degrees");
    row.latitude_rad = latitude_deg * kRadPerDeg;
    row.longitude_rad = longitude_deg * kRadPerDeg;
    row.altitude_m = csv.number(altitude);
    velocity.read(csv, row.velocity_N_m_s);
    rpy.read(csv, row.rpy_rad);
    position_sigma.read(csv, row.position_sigma_N_m);
    velocity_sigma.read(csv, row.velocity_sigma_N_m_s);
    rpy_sigma.read(csv, row.rpy_sigma_rad);
    row.mode = mode ? std::string(csv.text(*mode)) : std::string();
    consumer(row);
  }
}

}  // namespace fathom::dataset
