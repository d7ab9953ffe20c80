#include "commission/imu_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/median.hpp"
#include "base/units.hpp"
#include "commission/explanation.hpp"
#include "commission/fit/gps_fit.hpp"
#include "commission/fit/latency.hpp"
#include "commission/fit/signed_axes.hpp"
#include "commission/heading_check.hpp"
#include "commission/text.hpp"
#include "geo/so3.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPerImuWindow = 6.0;  // independent figures that a window counts for at most

Unit force_unit(const Series& series, double& found) {
  std::vector<double> length;
  Vector3d sum = Vector3d::Zero();
  std::size_t n = 0;
  double begin = series.imu.t_s.front();
  for (std::size_t i = 0; i < series.imu.size(); ++i) {
    sum += series.imu.force[i];
    ++n;
    if (series.imu.t_s[i] - begin < 1.0) continue;
    length.push_back((sum / static_cast<double>(n)).norm());
    sum.setZero();
    n = 0;
    begin = series.imu.t_s[i];
  }
  found = median(length);
  const double dt =
      (series.imu.t_s.back() - series.imu.t_s.front()) / static_cast<double>(series.imu.size() - 1);
  const std::array<Unit, 4> units{{{1.0, "m/s^2"},
                                   {kStandardGravity_m_s2, "g"},
                                   {kMilliG_m_s2, "mg"},
                                   {1.0 / dt, "m/s (increments of one interval)"}}};
  Unit best = units[0];
  for (const Unit& unit : units)
    if (std::abs(std::log(found * unit.factor / kStandardGravity_m_s2)) <
        std::abs(std::log(found * best.factor / kStandardGravity_m_s2)))
      best = unit;
  return best;
}

double log_ratio(double squares, double least, double count) {
  return least > 0.0 ? 0.5 * count * std::log(std::max(squares, least) / least) : 0.0;
}

// Returns what the best of them has against it where GPS and DVL prefer different ones.
double rate_all(std::vector<ReadingClass>& classes, double gps_count, double dvl_count,
                double heading_count) {
  double gps = std::numeric_limits<double>::max();
  double dvl = gps;
  double heading = gps;
  for (const ReadingClass& each : classes) {
    gps = std::min(gps, each.gps);
    dvl = std::min(dvl, each.dvl);
    heading = std::min(heading, each.heading);
  }
  double least = std::numeric_limits<double>::max();
  for (ReadingClass& each : classes) {
    each.against = log_ratio(each.gps, gps, gps_count) + log_ratio(each.dvl, dvl, dvl_count) +
                   log_ratio(each.heading, heading, heading_count);
    least = std::min(least, each.against);
  }
  for (ReadingClass& each : classes) each.against -= least;
  return least;
}

double least_of(const std::vector<ReadingClass>& classes, double ReadingClass::*member) {
  double least = std::numeric_limits<double>::infinity();
  for (const ReadingClass& each : classes) least = std::min(least, each.*member);
  return least;
}

// Those of a quarter of the windows where they are beyond `enough` already: further windows only add some.
double dvl_squares(const Series& series, const std::vector<Span>& windows, const ImuReading& reading,
                   double latency_s, double enough) {
  if (enough < std::numeric_limits<double>::infinity()) {
    const auto quarter = static_cast<std::ptrdiff_t>(windows.size() / 4);
    const double some =
        fit_dvl_linear(series, {windows.begin(), windows.begin() + quarter}, reading, latency_s).squares;
    if (some > enough) return some;
  }
  return fit_dvl_linear(series, windows, reading, latency_s).squares;
}

}  // namespace

double scan_gps_latency(const Series& series, const GpsCheck& gps, const std::vector<Span>& windows,
                        const ImuReading& reading) {
  double least = std::numeric_limits<double>::infinity();
  return scan_latency(0.1, 15, [&](double latency_s) {
    const double now = gps_squares(series, gps.velocity_N, windows, reading, latency_s, least).as_read;
    least = std::min(least, now);
    return now;
  });
}

double scan_dvl_latency(const Series& series, const std::vector<Span>& windows, const ImuReading& reading) {
  double least = std::numeric_limits<double>::infinity();
  return scan_latency(0.1, 15, [&](double latency_s) {
    const double now = dvl_squares(series, windows, reading, latency_s, least);
    least = std::min(least, now);
    return now;
  });
}

ImuAxes check_imu_axes(const Series& series, const Assumed& assumed, const GpsCheck& gps,
                       const Evidence& evidence) {
  ImuAxes out;
  const auto add = [&](const char* what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value = kUnknown, const char* unit = "", double sigma = kUnknown) {
    out.findings.push_back({"imu", what, kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  double force_found = kUnknown;
  const Unit unit = force_unit(series, force_found);
  // Vibration and banked turns make it larger than gravity, by far less than a quarter.
  if (!(std::abs(std::log(force_found * unit.factor / kStandardGravity_m_s2)) < 0.25)) {
    add("accelerometer_unit", FindingKind::unit, true, Severity::wrong,
        "The specific force is " + number(force_found, 3) +
            " in the middle, which is gravity in no unit: 9.81 m/s^2 is expected at rest.",
        force_found, "m/s^2");
    return out;
  }
  add("accelerometer_unit", FindingKind::unit, true, unit.factor == 1.0 ? Severity::ok : Severity::wrong,
      unit.factor == 1.0
          ? "The specific force is " + number(force_found, 2) + " m/s^2 in the middle, as gravity is."
          : "The specific force is " + number(force_found, 3) + " in the middle: gravity in " + unit.name +
                ", where m/s^2 is expected. The factor is " + number(unit.factor, 4) + ".",
      force_found, "m/s^2");

  Vector3d mean_force = Vector3d::Zero();
  for (const Vector3d& force : series.imu.force) mean_force += force;
  mean_force /= static_cast<double>(series.imu.size());
  Vector3d rest_rate = Vector3d::Zero();
  if (!evidence.rest.empty()) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < series.imu.size(); ++i) {
      if (series.imu.t_s[i] < evidence.rest.front().from_s || series.imu.t_s[i] > evidence.rest.front().to_s)
        continue;
      rest_rate += series.imu.rate[i];
      ++n;
    }
    rest_rate /= static_cast<double>(std::max<std::size_t>(n, 1));
  }
  const bool has_gps = evidence.gps.size() >= 3;
  const bool has_dvl = evidence.dvl.size() >= 3;
  const bool has_heading = !has_gps && !has_dvl && series.heading.size() > 50;
  out.reading.force = unit.factor * Matrix3d::Identity();
  out.reading.rate_bias = rest_rate;
  if (!has_gps && !has_dvl && !has_heading) {
    add("axes", FindingKind::missing, false, Severity::ok,
        "The axes of the inertial unit cannot be told: there is no motion that GPS, DVL or compass saw. "
        "Turns to both sides, a stop "
        "and a start under way with GPS or DVL would tell.");
    return out;
  }
  const double dt =
      (series.imu.t_s.back() - series.imu.t_s.front()) / static_cast<double>(series.imu.size() - 1);
  const std::array<Unit, 4> gyro_units{{{1.0, "rad/s"},
                                        {std::numbers::pi / 180.0, "deg/s"},
                                        {180.0 / std::numbers::pi, "rad/s, divided by 57.3 once too often"},
                                        {1.0 / dt, "rad (increments of one interval)"}}};
  const double gps_count = kPerImuWindow * static_cast<double>(evidence.gps.size());
  const double dvl_count = kPerImuWindow * static_cast<double>(evidence.dvl.size());
  const double heading_count =
      has_heading ? std::min(200.0, static_cast<double>(series.heading.size()) / 10.0) : 0.0;
  // Further windows only add squares: a class is left where it has `beyond`, a log likelihood ratio, against
  // the best so far, those `before` included.
  const auto classes_of = [&](double factor, double beyond, const std::vector<ReadingClass>& before) {
    std::vector<ReadingClass> classes;
    double gps_least = least_of(before, &ReadingClass::gps);
    double dvl_least = least_of(before, &ReadingClass::dvl);
    for (const Matrix3d& P : signed_axes()) {
      ImuReading reading;
      reading.rate = factor * P;
      reading.force = unit.factor * Matrix3d::Identity();
      reading.rate_bias = rest_rate;
      ReadingClass each;
      each.gyro = P;
      // The sign of the force is the DVL's own question: M takes it.
      if (has_dvl)
        each.dvl = dvl_squares(series, evidence.dvl, reading, evidence.dvl_latency_s,
                               dvl_least * std::exp(2.0 * beyond / dvl_count));
      dvl_least = std::min(dvl_least, each.dvl);
      if (has_heading) each.heading = heading_squares(series, reading);
      GpsSquares gps_of;
      if (has_gps)
        gps_of = gps_squares(series, gps.velocity_N, evidence.gps, reading, evidence.gps_latency_s,
                             gps_least * std::exp(2.0 * beyond / gps_count));
      gps_least = std::min({gps_least, gps_of.as_read, gps_of.force_negated});
      each.gps = gps_of.as_read;
      classes.push_back(each);
      each.force_sign = -1.0;
      each.gps = gps_of.force_negated;
      classes.push_back(each);
    }
    return classes;
  };
  // The unit first, by the classes of each: the right one has the least squares of all.
  std::vector<ReadingClass> classes = classes_of(1.0, 2.0 * kReject, {});
  const Unit* gyro_unit = &gyro_units[0];
  for (std::size_t i = 1; i < gyro_units.size(); ++i) {
    std::vector<ReadingClass> other = classes_of(gyro_units[i].factor, 2.0 * kReject, classes);
    const auto gain_of = [&](double ReadingClass::*member, double count) {
      return log_ratio(least_of(classes, member), least_of(other, member), count);
    };
    const double gain = gain_of(&ReadingClass::gps, gps_count) + gain_of(&ReadingClass::dvl, dvl_count) +
                        gain_of(&ReadingClass::heading, heading_count);
    if (gain < kReject) continue;
    classes = std::move(other);
    gyro_unit = &gyro_units[i];
  }
  // What was left early is refuted unless the best has more than half of that against it itself.
  if (rate_all(classes, gps_count, dvl_count, heading_count) > kReject) {
    classes = classes_of(gyro_unit->factor, std::numeric_limits<double>::infinity(), {});
    rate_all(classes, gps_count, dvl_count, heading_count);
  }

  if (gyro_unit->factor != 1.0)
    add("gyro_unit", FindingKind::unit, true, Severity::wrong,
        std::string("The gyro is in ") + gyro_unit->name + ", where rad/s is expected. The factor is " +
            number(gyro_unit->factor, 6) + ".",
        gyro_unit->factor, "");

  const auto best_class =
      *std::min_element(classes.begin(), classes.end(),
                        [](const ReadingClass& a, const ReadingClass& b) { return a.against < b.against; });
  ImuReading of_best;
  of_best.rate = gyro_unit->factor * best_class.gyro;
  of_best.force = best_class.force_sign * unit.factor * Matrix3d::Identity();
  of_best.rate_bias = rest_rate;
  Seen seen;
  seen.mean_force = mean_force;
  if (has_gps) {
    const GpsFit fit =
        fit_gps(series, gps.velocity_N, evidence.gps, of_best, evidence.gps_latency_s, Vector3d::Zero());
    seen.way = fit.way;
    seen.compass = fit.compass;
    seen.compass_yaw_rad = geo::to_rpy(geo::from_matrix(assumed.heading.C_BD)).z();
  }
  if (has_dvl) {
    const DvlFit fit = fit_dvl_linear(series, evidence.dvl, of_best, evidence.dvl_latency_s);
    const Similarity plain = fit_similarity(fit, false);
    const Similarity mirrored = fit_similarity(fit, true);
    Matrix3d D = Matrix3d::Identity();
    D(1, 1) = -1.0;
    const Matrix3d M = mirrored.chi2 + 30.0 < plain.chi2 ? Matrix3d(mirrored.C * D) : plain.C;
    // In the frame of the accelerometer as recorded.
    if (fit.done) seen.dvl = best_class.force_sign * M * assumed.dvl.C_BD.transpose();
  }
  const Explanation found = explain(classes, seen);
  out.reading.rate = gyro_unit->factor * found.gyro;
  out.reading.force = unit.factor * found.force;
  out.wrong = !found.gyro.isIdentity(1e-9) || !found.force.isIdentity(1e-9);
  static constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  // Axis by axis: whether the log would have noticed the other sign of the gyro.
  const Matrix3d Q = found.force * (std::abs(found.force.determinant() - 1.0) < 1e-9 ? 1.0 : -1.0);
  const double force_sign = found.force.determinant();
  std::string told;
  std::string untold;
  for (int axis = 0; axis < 3; ++axis) {
    Matrix3d flipped = Matrix3d::Identity();
    flipped(axis, axis) = -1.0;
    const Matrix3d other = Q.transpose() * flipped * found.gyro;
    const bool noticed = std::all_of(classes.begin(), classes.end(), [&](const ReadingClass& each) {
      return each.force_sign * force_sign < 0.0 || !each.gyro.isApprox(other, 1e-9) || each.against > kReject;
    });
    std::string& list = noticed ? told : untold;
    list += std::string(list.empty() ? "" : ", ") + kNames[static_cast<std::size_t>(axis)];
  }
  if (found.rival_turn_deg)
    add("turn_z", FindingKind::mounting, false, Severity::ok,
        "How the inertial unit is turned about the vertical cannot be told: turned by " +
            number(*found.rival_turn_deg, 0) +
            " degrees against what is said here, as many instruments are as configured. Turns to both sides "
            "and starts ahead on many courses with GPS velocity would tell.");
  if (out.wrong) {
    const bool both = found.gyro.isApprox(found.force, 1e-9);
    const std::string gyro = describe(found.gyro);
    const std::string force = describe(found.force);
    if (both && found.gyro.determinant() > 0.0) {
      add("mounting", FindingKind::mounting, true, Severity::wrong,
          "The inertial unit is mounted turned against what is configured: " + gyro + ".");
    } else if (both) {
      add("axes", FindingKind::axes, true, Severity::wrong,
          "Gyro and accelerometer are both not right-handed: " + gyro + ".");
    } else {
      if (!gyro.empty())
        add("gyro_axes", found.gyro.cwiseAbs().isIdentity(1e-9) ? FindingKind::sign : FindingKind::axes, true,
            Severity::wrong, "The gyro does not agree with the motion: " + gyro + ".");
      if (!force.empty())
        add("accelerometer_axes",
            found.force.cwiseAbs().isIdentity(1e-9) ? FindingKind::sign : FindingKind::axes, true,
            Severity::wrong, "The accelerometer does not agree with the motion: " + force + ".");
    }
    return out;
  }
  // As configured.
  if (!told.empty())
    add("gyro_axes", FindingKind::axes, true, Severity::ok,
        "Gyro " + told + " turn with gravity and motion as configured.");
  if (!untold.empty())
    add("gyro_axes", FindingKind::axes, false, Severity::ok,
        "The sign of gyro " + untold +
            " cannot be told: the vehicle turned too little about it while it accelerated. " +
            (untold.find('z') != std::string::npos ? "Turns to both sides under way would tell."
                                                   : "Rolling and pitching under way would tell."));
  return out;
}

}  // namespace fathom::commission
