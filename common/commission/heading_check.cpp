#include "commission/heading_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "base/median.hpp"
#include "base/units.hpp"
#include "commission/asked.hpp"
#include "commission/fit/latency.hpp"
#include "commission/fit/track_fit.hpp"
#include "commission/text.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Vector3d;

constexpr double kTurnStep_s = 2.0;  // of one comparison of turns
constexpr double kTurnGap_s = 3.0;
constexpr double kNoticedHeading_rad = 0.5 * kRadPerDeg;
constexpr double kEvened_s = 5.0;  // over which accelerations even out

// Turn about the vertical by the gyro, from the start on.
ScalarSeries turn_by_gyro(const Series& series, const ImuReading& reading) {
  const VectorSeries down = down_of(series, reading, kEvened_s);
  ScalarSeries out;
  double sum = 0.0;
  std::size_t j = 0;
  for (std::size_t i = 1; i < series.imu.size(); ++i) {
    const double t = series.imu.t_s[i];
    while (j + 1 < down.size() && down.t_s[j + 1] <= t) ++j;
    if (down.size() == 0) return out;
    sum += (reading.rate * (series.imu.rate[i] - reading.rate_bias)).dot(down.v[j]) *
           (t - series.imu.t_s[i - 1]);
    if (out.size() > 0 && t - out.t_s.back() < 0.019) continue;
    out.t_s.push_back(t);
    out.v.push_back(sum);
  }
  return out;
}

struct Turns {
  double slope = 0.0, sigma = 1e9, squares = 0.0, turned = 0.0;
  std::size_t count = 0;
};

// Regression of the turn of the compass on that of the gyro; a constant rate (bias of the gyro) goes free.
Turns compare_turns(const ScalarSeries& heading, const ScalarSeries& gyro, double latency_s) {
  std::vector<double> x;
  std::vector<double> y;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < heading.size();) {
    std::size_t k = i + 1;
    while (k < heading.size() && heading.t_s[k] - heading.t_s[i] < kTurnStep_s - 1e-3) ++k;
    if (k >= heading.size()) break;
    const auto a = at(gyro, heading.t_s[i] - latency_s, 0.5);
    const auto b = at(gyro, heading.t_s[k] - latency_s, 0.5);
    if (a && b && heading.t_s[k] - heading.t_s[i] < kTurnStep_s + kTurnGap_s) {
      const double dt = heading.t_s[k] - heading.t_s[i];
      x.push_back((*b - *a) / dt);
      y.push_back((heading.v[k] - heading.v[i]) / dt);
      mean_x += x.back();
      mean_y += y.back();
    }
    i = k;
  }
  Turns out;
  out.count = x.size();
  if (x.size() < 8) return out;
  mean_x /= static_cast<double>(x.size());
  mean_y /= static_cast<double>(x.size());
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    out.turned += std::abs(x[i]) * kTurnStep_s;
  }
  if (xx <= 0.0) return out;
  out.slope = xy / xx;
  out.squares = std::max(0.0, yy - xy * xy / xx);
  out.sigma = std::sqrt(out.squares / static_cast<double>(x.size() - 2) / xx);
  return out;
}

template <class Add>
void report_heading_latency(const LatencyFit& fit, const Assumed& assumed, const Add& add) {
  const double offset = fit.latency_s;
  const double sigma = fit.sigma_s;
  const bool told = sigma < 0.1;
  const bool wrong = told && std::abs(offset) > 5.0 * sigma && std::abs(offset) > 0.3;
  const bool note = told && assumed.heading.configured && differs(offset, sigma, kNoticedLatency_s);
  const bool is_known = known_to(kAskedLatency_s, sigma);
  const std::string stamped = "The compass is stamped " + with_sigma(offset, sigma) +
                              " s later than the gyro beyond the configured latency.";
  const char* const quicker = " Quicker turns to both sides would tell.";
  add("latency", FindingKind::latency, is_known,
      wrong  ? Severity::wrong
      : note ? Severity::note
             : Severity::ok,
      is_known ? stamped
      : told   ? stamped + " That is not known to five milliseconds." + quicker
               : std::string("The time offset of the compass cannot be told.") + quicker,
      assumed.heading.latency_s + offset, "s", sigma);
}

}  // namespace

VectorSeries down_of(const Series& series, const ImuReading& reading, double half_s) {
  VectorSeries out;
  constexpr double kPiece_s = 60.0;
  const ImuSeries& imu = series.imu;
  double t = imu.t_s.front() + half_s + 0.1;
  while (t + half_s < imu.t_s.back()) {
    const Strapdown strapdown(imu, reading, t - half_s - 0.5, t + kPiece_s + half_s + 0.5);
    const double begun = t;
    for (; t < begun + kPiece_s && strapdown.covers(t - half_s) && strapdown.covers(t + half_s); t += 0.1) {
      const Vector3d felt = strapdown.at(t + half_s).S - strapdown.at(t - half_s).S;
      if (!(felt.norm() > 0.0)) continue;
      out.t_s.push_back(t);
      out.v.push_back(-(strapdown.at(t).C_WB.transpose() * felt).normalized());
    }
    if (t > begun) continue;
    // A gap, or the end of one: on in whole seconds, but not through all of a long one.
    const auto next = std::lower_bound(imu.t_s.begin(), imu.t_s.end(), t);
    t += std::max(1.0, std::floor(*next - t));
  }
  return out;
}

double heading_squares(const Series& series, const ImuReading& reading) {
  const ScalarSeries gyro = turn_by_gyro(series, reading);
  double squares = 0.0;
  for (std::size_t i = 0; i < series.heading.size();) {
    std::size_t k = i + 1;
    while (k < series.heading.size() && series.heading.t_s[k] - series.heading.t_s[i] < kTurnStep_s - 1e-3)
      ++k;
    if (k >= series.heading.size()) break;
    const auto a = at(gyro, series.heading.t_s[i], 0.5);
    const auto b = at(gyro, series.heading.t_s[k], 0.5);
    if (a && b) squares += std::pow(series.heading.v[k] - series.heading.v[i] - (*b - *a), 2);
    i = k;
  }
  return squares;
}

Findings check_heading(const Series& series, const Assumed& assumed, const ImuReading& reading,
                       const GpsCheck& gps, const VectorSeries& dvl_B, const JointFit& joint) {
  Findings out;
  const auto add = [&](const char* what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value = kUnknown, const char* unit = "", double sigma = kUnknown) {
    out.push_back({"heading", what, kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  if (series.heading.size() < 20) return out;
  const ScalarSeries gyro = turn_by_gyro(series, reading);
  const double latency = scan_latency(0.025, 60, [&](double latency_s) {
    const Turns turns = compare_turns(series.heading, gyro, latency_s);
    return turns.count >= 8 ? turns.squares : std::numeric_limits<double>::infinity();
  });
  const Turns best = compare_turns(series.heading, gyro, latency);
  if (best.count < 8 || !(std::abs(best.slope) > 8.0 * best.sigma) || best.turned < 1.0) {
    add("sense", FindingKind::sign, false, Severity::ok,
        "Whether the compass turns the right way cannot be told: the vehicle turned too little. A full turn "
        "to each side would tell.");
    return out;
  }
  const bool reversed = best.slope < 0.0;
  add("sense", FindingKind::sign, true, reversed ? Severity::wrong : Severity::ok,
      reversed ? "The compass counts the other way round: it decreases where the vehicle turns right."
               : "The compass turns with the gyro: " + with_sigma(best.slope, best.sigma) + " of it.",
      best.slope, "", best.sigma);
  std::optional<CompassFit> by_attitude;
  if (joint.done && !reversed) by_attitude = fit_compass(series.heading, joint.rpy_rad, latency);
  std::optional<LatencyFit> late;
  if (by_attitude) {
    late = LatencyFit{by_attitude->latency_s.value, by_attitude->latency_s.sigma};
  } else {  // the parabola through three latencies
    const double h = 0.05;
    const double left = compare_turns(series.heading, gyro, latency - h).squares;
    const double right = compare_turns(series.heading, gyro, latency + h).squares;
    late = parabola(latency, h, left, best.squares, right, static_cast<double>(best.count));
  }
  if (late) report_heading_latency(*late, assumed, add);
  if (reversed) return out;
  const double configured_rad = geo::to_rpy(geo::from_matrix(assumed.heading.C_BD)).z();
  // Against the course: over ground by GPS, in the body by DVL, or straight ahead where there is none.
  std::vector<double> difference;
  std::vector<double> psi;
  std::vector<double> weight;
  for (std::size_t i = 0; i < gps.velocity_N.size(); ++i) {
    const double t = gps.velocity_N.t_s[i];
    const Vector3d& v = gps.velocity_N.v[i];
    if (std::hypot(v.x(), v.y()) < std::max(0.7, 6.0 * gps.sigma_m_s)) continue;
    const auto heading = at(series.heading, t, kTurnGap_s);
    const auto body = at(dvl_B, t, kTurnGap_s);
    if (!heading || (!body && dvl_B.size() > 0)) continue;
    const double ahead = body ? std::atan2(body->y(), body->x()) : 0.0;
    psi.push_back(*heading);
    difference.push_back(geo::wrap_pi(*heading + ahead - std::atan2(v.y(), v.x())));
    weight.push_back(1.0);
  }
  if (difference.size() < 20 && !by_attitude) {
    add("offset", FindingKind::datum, false, Severity::ok,
        "Whether the compass reads true or magnetic heading cannot be told: there is no run with GPS "
        "velocity. A straight run of a minute "
        "at the surface, out and back, would tell.");
    return out;
  }
  const double by_course = difference.empty() ? 0.0 : median(difference);
  std::vector<double> apart;
  for (double& d : difference) {
    d = geo::wrap_pi(d - by_course);
    apart.push_back(std::abs(d));
  }
  const double scatter = apart.empty() ? 1e-4 : std::max(1e-4, median(apart) / 0.6745);
  // Fixes of ten seconds count as one: what sways the vehicle lasts.
  const double duration = gps.velocity_N.t_s.back() - gps.velocity_N.t_s.front();
  const double independent =
      std::max(3.0, std::min(static_cast<double>(difference.size()) / 5.0, duration / 5.0));
  double middle = by_course;
  double sigma = std::max(scatter / std::sqrt(independent), dvl_B.size() > 0 ? 0.0 : 2.0 * kRadPerDeg);
  if (by_attitude) {
    middle = by_attitude->deviation_rad[0].value;
    sigma = std::hypot(by_attitude->deviation_rad[0].sigma, joint.yaw_sigma_rad);
  }
  const double excess = geo::wrap_pi(middle - configured_rad);
  const bool wrong =
      std::abs(excess) > 4.0 * sigma && std::abs(excess) > 4.0 * kRadPerDeg && !series.heading_magnetic;
  const bool note =
      assumed.heading.configured && !series.heading_magnetic && differs(excess, sigma, kNoticedHeading_rad);
  const double variation =
      known(assumed.variation_rad) ? assumed.variation_rad : series.heading_variation_rad;
  std::string text = "The compass reads " + with_sigma(middle / kRadPerDeg, sigma / kRadPerDeg) +
                     " degrees more than the true heading by GPS";
  text += dvl_B.size() > 0 ? " and DVL." : ", if the vehicle goes straight ahead.";
  if (wrong) {
    text += known(variation) && std::abs(middle + variation) < 3.0 * std::max(sigma, 0.5 * kRadPerDeg)
                ? " That is the magnetic variation: it gives magnetic heading and calls it true."
                : " It gives magnetic for true heading where the magnetic variation is " +
                      number(-middle / kRadPerDeg, 1) +
                      " degrees (east positive), else it is mounted turned by so much.";
  }
  add("offset", FindingKind::datum, true,
      wrong  ? Severity::wrong
      : note ? Severity::note
             : Severity::ok,
      text, middle / kRadPerDeg, "deg", sigma / kRadPerDeg);
  // Deviation A + B sin + C cos + D sin 2 + E cos 2, where all headings were steered.
  std::array<int, 8> sectors{};
  for (const double p : by_attitude ? series.heading.v : psi)
    ++sectors[static_cast<std::size_t>(geo::wrap_two_pi(p) / (2.0 * std::numbers::pi) * 7.9999)];
  const bool all_round = std::all_of(sectors.begin(), sectors.end(), [](int n) { return n >= 5; });
  if (!all_round) {
    add("deviation", FindingKind::deviation, false, Severity::ok,
        "The deviation curve cannot be told: not all headings were steered with GPS. A slow circle at the "
        "surface would tell.");
    return out;
  }
  Eigen::Matrix<double, 5, 5> N = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> b = Eigen::Matrix<double, 5, 1>::Zero();
  double used = 0.0;
  for (std::size_t i = 0; i < psi.size(); ++i) {
    if (std::abs(difference[i]) > 5.0 * scatter) continue;
    Eigen::Matrix<double, 5, 1> a;
    a << 1.0, std::sin(psi[i]), std::cos(psi[i]), std::sin(2.0 * psi[i]), std::cos(2.0 * psi[i]);
    N += a * a.transpose();
    b += a * (difference[i] + by_course);
    used += 1.0;
  }
  const Eigen::Matrix<double, 5, 1> x = N.ldlt().solve(b);
  const Eigen::Matrix<double, 5, 5> inverse = N.ldlt().solve(Eigen::Matrix<double, 5, 5>::Identity());
  for (int i = 0; i < 5; ++i) {
    double value = x[i];
    double s = scatter * std::sqrt(inverse(i, i) * std::max(1.0, used / independent));
    if (by_attitude) {
      value = by_attitude->deviation_rad[static_cast<std::size_t>(i)].value;
      s = std::hypot(by_attitude->deviation_rad[static_cast<std::size_t>(i)].sigma,
                     i == 0 ? joint.yaw_sigma_rad : 0.0);
    }
    const std::string letter(1, static_cast<char>('A' + i));
    add(("deviation_" + letter).c_str(), FindingKind::deviation, true, Severity::ok,
        "Deviation coefficient " + letter + ": " + with_sigma(value / kRadPerDeg, s / kRadPerDeg) +
            " degrees.",
        value / kRadPerDeg, "deg", s / kRadPerDeg);
  }
  return out;
}

}  // namespace fathom::commission
