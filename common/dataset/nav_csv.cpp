#include "dataset/nav_csv.hpp"

#include <array>
#include <cmath>

#include "base/units.hpp"

namespace fathom::dataset {
NavCsv::NavCsv(const std::filesystem::path& path, TimeNs epoch_ns) : csv_(path), epoch_ns_(epoch_ns) {
  csv_.line(
      "t_s,lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg,sigma_n_m,sigma_e_m,sigma_d_"
      "m,"
      "sigma_vn_m_s,sigma_ve_m_s,sigma_vd_m_s,sigma_roll_deg,sigma_pitch_deg,sigma_yaw_deg,mode,gps_outage_s,"
      "alignment");
}

void NavCsv::add(const NavState& state) {
  csv_.seconds(state.header.stamp_ns - epoch_ns_);
  // 1e-11 degrees are a micrometre on the ground.
  csv_.fixed(state.latitude_rad * kDegPerRad, 11).fixed(state.longitude_rad * kDegPerRad, 11);
  csv_.fixed(state.altitude_m, 6);
  for (const double v : state.velocity_N_m_s) csv_.fixed(v, 6);
  for (const double angle : state.rpy_rad) csv_.fixed(angle * kDegPerRad, 9);
  for (const std::size_t i : {0U, 4U, 8U}) csv_.fixed(std::sqrt(state.position_covariance_N_m2[i]), 6);
  for (const std::size_t i : {0U, 4U, 8U}) csv_.fixed(std::sqrt(state.velocity_covariance_N_m2_s2[i]), 6);
  for (const double sigma : state.rpy_sigma_rad) csv_.fixed(sigma * kDegPerRad, 9);
  csv_.text(to_string(state.mode)).fixed(state.gps_outage_s, 3).text(to_string(state.alignment));
  csv_.end_row();
}

}  // namespace fathom::dataset
