#include "dataset/score.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::dataset {
namespace {

// WGS-84.
constexpr double kSemiMajor_m = 6'378'137.0;
constexpr double kEccentricity2 = 6.694379990141316e-3;

using geo::wrap_pi;

double lerp_angle(double from_rad, double to_rad, double share) {
  return wrap_pi(from_rad + share * wrap_pi(to_rad - from_rad));
}

/// e' P^-1 e for the leading 1 x 1, 2 x 2 and 3 x 3 block of a row-major 3 x 3 covariance, by Cholesky;
/// unknown from the first block on that is not positive definite.
std::array<double, 3> mahalanobis2(const std::array<double, 3>& e, const std::array<double, 9>& covariance) {
  std::array<double, 9> factor{};
  std::array<double, 3> whitened{};
  std::array<double, 3> out{kUnknown, kUnknown, kUnknown};
  double sum = 0.0;
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (std::size_t j = 0; j <= i; ++j) {
      double value = covariance[3 * i + j];
#pragma GCC unroll 3
      for (std::size_t k = 0; k < j; ++k) value -= factor[3 * i + k] * factor[3 * j + k];
      if (i == j) {
        if (!(value > 0.0)) return out;
        factor[3 * i + i] = std::sqrt(value);
      } else {
        factor[3 * i + j] = value / factor[3 * j + j];
      }
    }
    double value = e[i];
#pragma GCC unroll 3
    for (std::size_t k = 0; k < i; ++k) value -= factor[3 * i + k] * whitened[k];
    whitened[i] = value / factor[3 * i + i];
    sum += whitened[i] * whitened[i];
    out[i] = sum;
  }
  return out;
}

/// The attitude on the shortest turn between two. One of which an angle is unknown turns angle by angle.
std::array<double, 3> turned(const std::array<double, 3>& from, const std::array<double, 3>& to,
                             double share) {
  const auto all_known = [](const std::array<double, 3>& rpy) {
    return known(rpy[0]) && known(rpy[1]) && known(rpy[2]);
  };
  if (!all_known(from) || !all_known(to)) {
    return {lerp_angle(from[0], to[0], share), lerp_angle(from[1], to[1], share),
            lerp_angle(from[2], to[2], share)};
  }
  const geo::Quaternion a = geo::from_rpy({from[0], from[1], from[2]});
  const geo::Quaternion b = geo::from_rpy({to[0], to[1], to[2]});
  return geo::arr(geo::to_rpy(a * geo::exp(share * geo::log(geo::conjugate(a) * b))));
}

template <class Pick>
ErrorFigures figures(const std::vector<NavError>& errors, Pick pick) {
  std::vector<double> magnitudes;
  magnitudes.reserve(errors.size());
  ErrorFigures out;
  double sum2 = 0.0;
  for (const NavError& error : errors) {
    const double value = pick(error);
    if (!known(value)) continue;
    magnitudes.push_back(std::abs(value));
    sum2 += value * value;
    out.end = value;
  }
  out.count = magnitudes.size();
  if (magnitudes.empty()) return out;
  out.rms = std::sqrt(sum2 / static_cast<double>(magnitudes.size()));
  // Nearest rank: the smallest value that 95 % of all do not exceed.
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(magnitudes.size()))) - 1;
  const auto nth = magnitudes.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(magnitudes.begin(), nth, magnitudes.end());
  out.p95 = *nth;
  out.max = *std::max_element(nth, magnitudes.end());
  return out;
}

template <class Pick>
Nees nees(const std::vector<NavError>& errors, int dof, Pick pick) {
  Nees out;
  out.dof = dof;
  out.band_95 =
      dof == 2 ? std::array<double, 2>{0.0506356, 7.3777589} : std::array<double, 2>{0.2157953, 9.3484036};
  double sum = 0.0;
  std::size_t inside = 0;
  for (const NavError& error : errors) {
    const double value = pick(error);
    if (!known(value)) continue;
    ++out.count;
    sum += value;
    if (value >= out.band_95[0] && value <= out.band_95[1]) ++inside;
  }
  if (out.count == 0) return out;
  out.mean = sum / static_cast<double>(out.count);
  out.inside = static_cast<double>(inside) / static_cast<double>(out.count);
  return out;
}

double horizontal_m(const Truth& a, const Truth& b) {
  const auto d = ned_difference_m(a.latitude_rad, a.longitude_rad, a.altitude_m, b.latitude_rad,
                                  b.longitude_rad, b.altitude_m);
  return std::hypot(d[0], d[1]);
}

}  // namespace

TruthTrack::TruthTrack(double longest_gap_s) : longest_gap_ns_(from_seconds(longest_gap_s)) {}

TruthTrack::TruthTrack(const std::vector<Truth>& rows, double longest_gap_s) : TruthTrack(longest_gap_s) {
  rows_.reserve(rows.size());
  path_m_.reserve(rows.size());
  for (const Truth& row : rows) add(row);
}

void TruthTrack::add(const Truth& row) {
  if (!known(row.latitude_rad) || !known(row.longitude_rad)) return;
  if (rows_.empty()) {
    path_m_.push_back(0.0);
  } else {
    if (row.header.stamp_ns <= rows_.back().header.stamp_ns) return;
    path_m_.push_back(path_m_.back() + horizontal_m(row, rows_.back()));
  }
  rows_.push_back(row);
}

std::optional<Truth> TruthTrack::at(TimeNs stamp_ns) const {
  const auto after =
      std::lower_bound(rows_.begin(), rows_.end(), stamp_ns,
                       [](const Truth& row, TimeNs stamp) { return row.header.stamp_ns < stamp; });
  if (after == rows_.end()) return std::nullopt;
  if (after->header.stamp_ns == stamp_ns) return *after;
  if (after == rows_.begin()) return std::nullopt;
  const Truth& a = *std::prev(after);
  const Truth& b = *after;
  const DurationNs gap = b.header.stamp_ns - a.header.stamp_ns;
  if (gap > longest_gap_ns_) return std::nullopt;
  const double share = static_cast<double>(stamp_ns - a.header.stamp_ns) / static_cast<double>(gap);
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  Truth out = a;
  out.header.stamp_ns = stamp_ns;
  out.header.received_ns = stamp_ns;
  out.latitude_rad = mix(a.latitude_rad, b.latitude_rad);
  out.longitude_rad = lerp_angle(a.longitude_rad, b.longitude_rad, share);
  out.altitude_m = mix(a.altitude_m, b.altitude_m);
  for (std::size_t i = 0; i < 3; ++i) {
    out.velocity_N_m_s[i] = mix(a.velocity_N_m_s[i], b.velocity_N_m_s[i]);
  }
  out.rpy_rad = turned(a.rpy_rad, b.rpy_rad, share);
  return out;
}

double TruthTrack::distance_m(TimeNs from_ns, TimeNs to_ns) const {
  const auto path_at = [this](TimeNs stamp_ns) {
    if (stamp_ns <= rows_.front().header.stamp_ns) return 0.0;
    if (stamp_ns >= rows_.back().header.stamp_ns) return path_m_.back();
    const auto after =
        std::lower_bound(rows_.begin(), rows_.end(), stamp_ns,
                         [](const Truth& row, TimeNs stamp) { return row.header.stamp_ns < stamp; });
    const auto i = static_cast<std::size_t>(after - rows_.begin());
    const TimeNs begin = rows_[i - 1].header.stamp_ns;
    const double share =
        static_cast<double>(stamp_ns - begin) / static_cast<double>(rows_[i].header.stamp_ns - begin);
    return path_m_[i - 1] + share * (path_m_[i] - path_m_[i - 1]);
  };
  if (rows_.empty() || to_ns <= from_ns) return 0.0;
  return path_at(to_ns) - path_at(from_ns);
}

std::array<double, 3> ned_difference_m(double a_latitude_rad, double a_longitude_rad, double a_altitude_m,
                                       double b_latitude_rad, double b_longitude_rad, double b_altitude_m) {
  const double latitude = 0.5 * (a_latitude_rad + b_latitude_rad);
  // An unknown height matters little for the horizontal metric: 1e-7 of the distance per metre.
  const double mean_altitude_m = 0.5 * (a_altitude_m + b_altitude_m);
  const double height = known(mean_altitude_m) ? mean_altitude_m : 0.0;
  const double s = std::sin(latitude);
  const double w2 = 1.0 - kEccentricity2 * s * s;
  const double meridian_m = kSemiMajor_m * (1.0 - kEccentricity2) / (w2 * std::sqrt(w2));
  const double normal_m = kSemiMajor_m / std::sqrt(w2);
  return {(a_latitude_rad - b_latitude_rad) * (meridian_m + height),
          wrap_pi(a_longitude_rad - b_longitude_rad) * (normal_m + height) * std::cos(latitude),
          b_altitude_m - a_altitude_m};
}

NavError error_of(const NavState& state, const Truth& truth) {
  NavError error;
  error.stamp_ns = state.header.stamp_ns;
  error.position_N_m = ned_difference_m(state.latitude_rad, state.longitude_rad, state.altitude_m,
                                        truth.latitude_rad, truth.longitude_rad, truth.altitude_m);
  error.horizontal_m = std::hypot(error.position_N_m[0], error.position_N_m[1]);
  for (std::size_t i = 0; i < 3; ++i) {
    error.velocity_N_m_s[i] = state.velocity_N_m_s[i] - truth.velocity_N_m_s[i];
    error.rpy_rad[i] = wrap_pi(state.rpy_rad[i] - truth.rpy_rad[i]);
  }
  const auto position = mahalanobis2(error.position_N_m, state.position_covariance_N_m2);
  error.nees_horizontal = position[1];
  error.nees_position = position[2];
  error.nees_velocity = mahalanobis2(error.velocity_N_m_s, state.velocity_covariance_N_m2_s2)[2];
  return error;
}

void Scorer::add(const NavError& error) {
  errors_.push_back(error);
}

Score Scorer::score() const {
  Score out;
  out.count = errors_.size();
  if (errors_.empty()) return out;
  out.first_ns = errors_.front().stamp_ns;
  out.last_ns = errors_.back().stamp_ns;
  out.horizontal_m = figures(errors_, [](const NavError& e) { return e.horizontal_m; });
  out.distance_3d_m =
      figures(errors_, [](const NavError& e) { return std::hypot(e.horizontal_m, e.position_N_m[2]); });
  for (std::size_t i = 0; i < 3; ++i) {
    out.position_N_m[i] = figures(errors_, [i](const NavError& e) { return e.position_N_m[i]; });
    out.velocity_N_m_s[i] = figures(errors_, [i](const NavError& e) { return e.velocity_N_m_s[i]; });
    out.rpy_rad[i] = figures(errors_, [i](const NavError& e) { return e.rpy_rad[i]; });
  }
  out.nees_horizontal = nees(errors_, 2, [](const NavError& e) { return e.nees_horizontal; });
  out.nees_position = nees(errors_, 3, [](const NavError& e) { return e.nees_position; });
  out.nees_velocity = nees(errors_, 3, [](const NavError& e) { return e.nees_velocity; });
  return out;
}

}  // namespace fathom::dataset
