#include "commission/gps_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/median.hpp"
#include "base/units.hpp"
#include "commission/fit/signed_axes.hpp"
#include "commission/text.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLongestGap_s = 3.0;
constexpr double kGpsClaim = 20.0;  // log likelihood ratio of a claim: e^-20 in 48 hypotheses is no chance
constexpr const char* kNoVertical = " The receiver gives no vertical velocity.";
constexpr double kClearly = 2.0;  // and the residual shrinks by this much

struct Pairs {
  std::vector<Vector3d> moved;     // mean velocity by positions
  std::vector<Vector3d> velocity;  // mean of the two ends
};

// Over two seconds at least: the noise of a position counts by its inverse.
Pairs pairs_of(const Series& series) {
  Pairs out;
  const VectorSeries& p = series.gps_position;
  const VectorSeries& v = series.gps_velocity;
  std::size_t j = 0;
  for (std::size_t i = 0; i + 1 < p.size();) {
    std::size_t k = i + 1;
    bool gap = false;
    while (k + 1 < p.size() && p.t_s[k] - p.t_s[i] < 2.0 - 1e-3) {
      gap = gap || p.t_s[k] - p.t_s[k - 1] > kLongestGap_s;
      ++k;
    }
    const double span = p.t_s[k] - p.t_s[i];
    while (j < v.size() && v.t_s[j] < p.t_s[i] - 1e-6) ++j;
    Vector3d mean = Vector3d::Zero();
    double weight = 0.0;
    for (std::size_t n = j; n + 1 < v.size() && v.t_s[n + 1] <= p.t_s[k] + 1e-6; ++n) {
      const double dt = v.t_s[n + 1] - v.t_s[n];
      mean += 0.5 * dt * (v.v[n] + v.v[n + 1]);
      weight += dt;
    }
    if (!gap && span < 2.0 + kLongestGap_s && weight > 0.9 * span) {
      out.moved.push_back((p.v[k] - p.v[i]) / span);
      out.velocity.push_back(mean / weight);
    }
    i = k;
  }
  return out;
}

double squares(const Pairs& pairs, const GpsVelocity& velocity, const Matrix3d& P) {
  double out = 0.0;
  for (std::size_t i = 0; i < pairs.moved.size(); ++i) {
    // Robust: a jump of the position is no argument.
    const double r2 = velocity.measured(pairs.moved[i] - P * pairs.velocity[i]).squaredNorm();
    out += r2;
  }
  return out;
}

GpsVelocity from_positions(const VectorSeries& p) {
  GpsVelocity out;
  for (std::size_t i = 0; i + 1 < p.size();) {
    std::size_t k = i + 1;
    while (k + 1 < p.size() && p.t_s[k] - p.t_s[i] < 0.4 - 1e-3) ++k;
    const double span = p.t_s[k] - p.t_s[i];
    if (span < kLongestGap_s) {
      out.t_s.push_back(0.5 * (p.t_s[i] + p.t_s[k]));
      out.v.push_back((p.v[k] - p.v[i]) / span);
    }
    i = k;
  }
  return out;
}

// Squares of the changes of position less those by the velocity, whose stamps count as `lag_s` too late.
double lagged_squares(const VectorSeries& p, const ScalarSeries& north, const ScalarSeries& east,
                      double lag_s, std::size_t& count) {
  double squares = 0.0;
  count = 0;
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (p.t_s[i] - p.t_s[i - 1] > 1.5) continue;
    const auto n0 = at(north, p.t_s[i - 1] + lag_s, 1.5);
    const auto n1 = at(north, p.t_s[i] + lag_s, 1.5);
    const auto e0 = at(east, p.t_s[i - 1] + lag_s, 1.5);
    const auto e1 = at(east, p.t_s[i] + lag_s, 1.5);
    if (!n0 || !n1 || !e0 || !e1) continue;
    const double dn = p.v[i].x() - p.v[i - 1].x() - (*n1 - *n0);
    const double de = p.v[i].y() - p.v[i - 1].y() - (*e1 - *e0);
    squares += dn * dn + de * de;
    ++count;
  }
  return squares;
}

// A receiver that smooths gives a velocity that is older than its position.
void report_lag(const Series& series, GpsCheck& out) {
  ScalarSeries north;
  ScalarSeries east;
  const VectorSeries& v = out.velocity_N;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (i > 0) sum += 0.5 * (v.t_s[i] - v.t_s[i - 1]) * (v.v[i] + v.v[i - 1]);
    north.t_s.push_back(v.t_s[i]);
    north.v.push_back(sum.x());
    east.t_s.push_back(v.t_s[i]);
    east.v.push_back(sum.y());
  }
  double best = 0.0;
  double least = std::numeric_limits<double>::max();
  std::size_t count = 0;
  for (int step = -50; step <= 50; ++step) {
    std::size_t now = 0;
    const double squares = lagged_squares(series.gps_position, north, east, 0.02 * step, now);
    if (now < 30 || squares / static_cast<double>(now) >= least) continue;
    least = squares / static_cast<double>(now);
    best = 0.02 * step;
    count = now;
  }
  if (count < 30) return;
  constexpr double kWing_s = 0.1;
  std::size_t n = 0;
  const double left =
      lagged_squares(series.gps_position, north, east, best - kWing_s, n) / static_cast<double>(n);
  const double right =
      lagged_squares(series.gps_position, north, east, best + kWing_s, n) / static_cast<double>(n);
  const double curvature = (left - 2.0 * least + right) / (kWing_s * kWing_s);
  if (!(curvature > 0.0)) return;
  const double lag = best - (right - left) / (2.0 * kWing_s) / curvature;
  // Two components a pair; neighbours share a position, which halves what they count.
  const double sigma = std::sqrt(2.0 * least / static_cast<double>(count) / curvature);
  if (sigma > 0.05 || std::abs(lag) < 5.0 * sigma || std::abs(lag) < 0.03) return;
  out.findings.push_back(
      {"gps", "velocity_lag", FindingKind::latency, lag, "s", sigma, true, Severity::note,
       "The GPS velocity is " + with_sigma(lag, sigma) +
           " s older than the GPS position of the same stamp. One latency cannot suit both: leave the "
           "one out that the receiver smooths."});
  for (double& t : out.velocity_N.t_s) t -= lag;
}

}  // namespace

GpsCheck check_gps(const Series& series) {
  GpsCheck out;
  out.velocity_N = series.gps_velocity;
  if (series.gps_position.size() < 5) return out;
  const auto add = [&](const char* what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value = kUnknown, const char* unit = "", double sigma = kUnknown) {
    out.findings.push_back({"gps", what, kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  if (series.gps_velocity.size() * 2 < series.gps_position.size()) {
    out.velocity_N = from_positions(series.gps_position);
    out.from_positions = true;
    out.usable = out.velocity_N.size() > 10;
    add("velocity_axes", FindingKind::axes, false, Severity::ok,
        (series.gps_velocity.size() == 0
             ? std::string("The receiver gives no velocity")
             : "The receiver gives a velocity with " + std::to_string(series.gps_velocity.size()) + " of " +
                   std::to_string(series.gps_position.size()) + " positions only") +
            "; what follows takes it from the change of position.");
    out.sigma_m_s = 0.3;
    return out;
  }
  out.usable = out.velocity_N.size() > 10;
  const Pairs pairs = pairs_of(series);
  const bool has_down = out.velocity_N.has_down;
  const int known_axes = out.velocity_N.known_axes();
  const auto squares_of = [&](const Matrix3d& P) { return squares(pairs, series.gps_velocity, P); };
  double moved2 = 0.0;
  for (const Vector3d& v : pairs.moved) moved2 += out.velocity_N.measured(v).squaredNorm();
  if (pairs.moved.size() < 5 || moved2 <= 0.0) {
    add("velocity_axes", FindingKind::axes, false, Severity::ok,
        "Whether the velocity has the axes of the position cannot be told: there is no run of some seconds "
        "with both.");
    return out;
  }
  // Every unit and permutation; what the data as they are leave over is the yardstick.
  static constexpr std::array<Unit, 5> kUnits{
      {{1.0, "m/s"}, {kKnot_m_s, "knots"}, {kKmh_m_s, "km/h"}, {1e-3, "mm/s"}, {0.01, "cm/s"}}};
  Matrix3d best = Matrix3d::Identity();
  const Unit* unit = &kUnits[0];
  Matrix3d best_axes = Matrix3d::Identity();
  const double plain = squares_of(Matrix3d::Identity());
  double least = plain;
  for (const Unit& each : kUnits) {
    for (const Matrix3d& P : signed_axes()) {
      if (!has_down && P(2, 2) != 1.0) continue;  // it stays unknown
      const double now = squares_of(each.factor * P);
      if (now >= least) continue;
      least = now;
      best = each.factor * P;
      best_axes = P;
      unit = &each;
    }
  }
  const auto n = static_cast<double>(pairs.moved.size());
  const auto beats = [&](double worse, double better) {
    return worse > kClearly * better && 0.5 * n * std::log(worse / std::max(better, 1e-12)) > kGpsClaim;
  };
  const double residual = std::sqrt(least / (known_axes * n));
  if (beats(plain, least)) {
    const std::string axes = describe(best_axes);
    const bool enu = best_axes(0, 1) == 1.0 && best_axes(1, 0) == 1.0 && best_axes(2, 2) == -1.0;
    const double with_z = squares_of(best);
    Matrix3d other = best;
    other.row(2) = -other.row(2);
    const bool z_told = beats(squares_of(other), with_z);
    if (!axes.empty()) {
      const bool swapped = best_axes(0, 1) == 1.0 && best_axes(1, 0) == 1.0;
      std::string name = !has_down && swapped ? "its components are east, north where north, east is expected"
                         : enu || (swapped && !z_told)
                             ? "its components are east, north, up where north, east, down is expected"
                             : "of its components " + axes;
      add("velocity_axes", FindingKind::axes, true, Severity::wrong,
          "The GPS velocity does not agree with the change of the GPS position: " + name +
              ". Corrected so, " + number(residual, 2) + " m/s rms are left; as it is " +
              number(std::sqrt(plain / (known_axes * n)), 2) + " m/s." +
              (!has_down ? kNoVertical
               : z_told  ? ""
                         : " The vertical moved too little to tell its sign."));
    }
    if (unit->factor != 1.0)
      add("velocity_unit", FindingKind::unit, true, Severity::wrong,
          std::string("The GPS velocity is in ") + unit->name + ", not in m/s.", unit->factor, "");
    for (Vector3d& v : out.velocity_N.v) v = best * v;
  } else {
    // Which of the axes the log would have noticed.
    std::string told;
    for (int axis = 0; axis < known_axes; ++axis) {
      Matrix3d flipped = Matrix3d::Identity();
      flipped(axis, axis) = -1.0;
      if (beats(squares_of(flipped), plain))
        told += std::string(told.empty() ? "" : ", ") + (axis == 0 ? "north" : axis == 1 ? "east" : "down");
    }
    const bool is_known = !told.empty();
    add("velocity_axes", FindingKind::axes, is_known, Severity::ok,
        is_known ? "The GPS velocity is the change of the GPS position, within " + number(residual, 2) +
                       " m/s rms (axes told: " + told + ")." + (has_down ? "" : kNoVertical)
                 : "The vehicle moved too little to tell the axes of the GPS velocity. A straight run of "
                   "some 50 m to each side would.");
  }
  report_lag(series, out);
  // Noise: differences over neighbours hold the motion as well, second differences little of it.
  std::vector<double> second;
  const VectorSeries& v = out.velocity_N;
  for (std::size_t i = 2; i < v.size(); ++i)
    for (int axis = 0; axis < 2; ++axis)
      second.push_back(std::abs(v.v[i][axis] - 2.0 * v.v[i - 1][axis] + v.v[i - 2][axis]));
  if (second.size() > 20) out.sigma_m_s = std::max(0.01, median(second) / 0.6745 / std::sqrt(6.0));
  return out;
}

}  // namespace fathom::commission
