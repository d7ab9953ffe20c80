#include "report/material.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::report {

StateRow row_of(const NavState& state, double t_s) {
  StateRow row;
  row.t_s = t_s;
  row.latitude_rad = state.latitude_rad;
  row.longitude_rad = state.longitude_rad;
  row.altitude_m = state.altitude_m;
  row.velocity_N_m_s = state.velocity_N_m_s;
  row.rpy_rad = state.rpy_rad;
  const auto& p = state.position_covariance_N_m2;
  row.covariance_NE_m2 = {p[0], p[1], p[3], p[4]};
  for (std::size_t i = 0; i < 3; ++i) {
    row.position_sigma_N_m[i] = std::sqrt(p[4 * i]);
    row.velocity_sigma_N_m_s[i] = std::sqrt(state.velocity_covariance_N_m2_s2[4 * i]);
  }
  row.rpy_sigma_rad = state.rpy_sigma_rad;
  row.mode = state.mode;
  row.gps_outage_s = state.gps_outage_s;
  row.resets = state.reset_counter;
  return row;
}

void Source::add(const Verdict& verdict, double t_s) {
  const auto what = static_cast<std::size_t>(verdict.kind);
  if (what < kVerdictKinds) ++counts[what];
  innovations.add(verdict);
  if (total() % stride != 0) return;
  if (judged.size() >= kMostJudged) {
    stride *= 2;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < judged.size(); i += 2) judged[kept++] = judged[i];
    judged.resize(kept);
  }
  Judged& one = judged.emplace_back();
  one.t_s = t_s;
  one.kind = verdict.kind;
  one.dimensions = static_cast<std::uint8_t>(std::min<std::uint32_t>(verdict.dimensions, 3));
  for (std::size_t i = 0; i < one.dimensions; ++i)
    one.normalised[i] = static_cast<float>(verdict.innovation[i] / verdict.innovation_sigma[i]);
  one.test_ratio = static_cast<float>(verdict.test_ratio);
}

std::uint64_t Source::total() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counts) sum += count;
  return sum;
}

}  // namespace fathom::report
