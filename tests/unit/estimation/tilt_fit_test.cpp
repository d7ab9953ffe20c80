// A car on flat roads: what tilts of a degree tell of the axes of its inertial unit.
#include "estimation/navigator/plausibility/tilt_fit.hpp"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "geo/so3.hpp"
#include "sim/random.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.01;
constexpr double kBelieved = 13.2;  // PLAUS-1

/// What may be off without any axis being wrong.
struct Flaws {
  double gps_late_s = 0.0;
  double heading_off_rad = 0.0;  ///< of the estimate against the vehicle, as a crab
  double gyro_bias_rad_s = 0.0;  ///< of x and y
  double antenna_m = 0.0;        ///< ahead, and nobody says so
};

struct Heard {
  std::string remedy;
  double after_s = kUnknown;
};

/// `wrong` changes what the unit measures: increments of velocity and of angle. Until something is believed,
/// or for `seconds`.
Heard drive(std::uint64_t seed, double seconds, const Flaws& flaws,
            const std::function<void(Vector3d&, Vector3d&)>& wrong) {
  sim::Random random(seed, "road");
  TiltFit fit;
  double speed_m_s = 8.0;
  double gain_m_s2 = 0.0;
  double yaw_rad = 0.0;
  double yaw_rate_rad_s = 0.0;
  double hill_rad = 0.0;
  double camber_rad = 0.0;
  double hill_to_rad = 0.0;
  double camber_to_rad = 0.0;
  geo::Quaternion q = geo::exp(Vector3d::Zero());
  geo::Quaternion before = q;
  Vector3d v_N_m_s(speed_m_s, 0.0, 0.0);
  for (int i = 0; i * kStep_s < seconds; ++i) {
    if (i % 400 == 0) {
      gain_m_s2 = std::clamp(0.3 * (10.0 - speed_m_s) + random.normal(0.8), -3.0, 3.0);
      yaw_rate_rad_s = random.uniform(0.0, 1.0) < 0.4 ? random.normal(0.25) : 0.0;
    }
    if (i % 300 == 0) {
      hill_to_rad = random.normal(0.8 * kRadPerDeg);
      camber_to_rad = random.normal(0.8 * kRadPerDeg);
    }
    const double share = kStep_s / 1.0;
    hill_rad += share * (hill_to_rad + 0.004 * gain_m_s2 - hill_rad);
    camber_rad += share * (camber_to_rad - 0.006 * speed_m_s * yaw_rate_rad_s - camber_rad);
    speed_m_s = std::max(2.0, speed_m_s + kStep_s * gain_m_s2);
    yaw_rad += kStep_s * yaw_rate_rad_s;
    q = geo::from_rpy({camber_rad, hill_rad, yaw_rad});
    const Vector3d v_before_N_m_s = v_N_m_s;
    v_N_m_s = speed_m_s * Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
    const geo::Quaternion turn = geo::conjugate(before) * q;
    Vector3d dtheta_rad = geo::log(turn) + kStep_s * flaws.gyro_bias_rad_s * Vector3d(1.0, -1.0, 0.0);
    Vector3d dv_m_s = geo::to_matrix(before).transpose() *
                      (v_N_m_s - v_before_N_m_s - kStep_s * Vector3d(0.0, 0.0, kStandardGravity_m_s2));
    for (int k = 0; k < 3; ++k) {
      dtheta_rad[k] += random.normal(4.0 * kRadPerDeg / 60.0 * std::sqrt(kStep_s));
      dv_m_s[k] += random.normal(0.02 * std::sqrt(kStep_s) + 0.3 * kStep_s);
    }
    before = q;
    wrong(dv_m_s, dtheta_rad);
    fit.add(dv_m_s, dtheta_rad, kStep_s);
    if (i % 20 != 0) continue;
    const Vector3d antenna_m_s = geo::to_matrix(q) * Vector3d(0.0, yaw_rate_rad_s * flaws.antenna_m, 0.0);
    Vector3d told_m_s =
        v_N_m_s + antenna_m_s -
        flaws.gps_late_s *
            Vector3d(gain_m_s2 * std::cos(yaw_rad) - speed_m_s * yaw_rate_rad_s * std::sin(yaw_rad),
                     gain_m_s2 * std::sin(yaw_rad) + speed_m_s * yaw_rate_rad_s * std::cos(yaw_rad), 0.0);
    for (int k = 0; k < 3; ++k) told_m_s[k] += random.normal(0.03);
    fit.measured({.v_N_m_s = told_m_s,
                  .noise_m_s = 0.05,
                  .lever_m = 0.5,
                  .attitude = {.q_NB = geo::from_rpy({0.0, 0.0, yaw_rad + flaws.heading_off_rad})}});
    if (const OtherAxes other = fit.other(); other.evidence > kBelieved)
      return {axes_hypothesis(other.number).remedy, i * kStep_s};
  }
  return {};
}

void nothing(Vector3d&, Vector3d&) {}

TEST(TiltFit, NamesAxesOfACarOnFlatRoads) {
  const auto swap = [](Vector3d& v) { std::swap(v[0], v[1]); };
  const std::vector<std::pair<std::string, std::function<void(Vector3d&, Vector3d&)>>> mistakes{
      {"exchange gyro x and y", [&](Vector3d&, Vector3d& turn) { swap(turn); }},
      {"negate gyro x", [](Vector3d&, Vector3d& turn) { turn[0] *= -1.0; }},
      {"negate gyro y", [](Vector3d&, Vector3d& turn) { turn[1] *= -1.0; }},
      {"exchange accelerometer x and y", [&](Vector3d& force, Vector3d&) { swap(force); }},
      {"negate accelerometer x, or gyro y and z", [](Vector3d& force, Vector3d&) { force[0] *= -1.0; }},
      {"negate accelerometer y, or gyro x and z", [](Vector3d& force, Vector3d&) { force[1] *= -1.0; }}};
  for (const auto& [remedy, mistake] : mistakes) {
    std::vector<double> after_s;
    for (std::uint64_t seed = 1; seed <= 9; ++seed) {
      const Heard heard = drive(seed, 300.0, {}, mistake);
      EXPECT_EQ(heard.remedy, remedy) << "seed " << seed;
      after_s.push_back(heard.after_s);
    }
    std::sort(after_s.begin(), after_s.end());
    EXPECT_LT(after_s[4], 180.0) << remedy;
  }
}

TEST(TiltFit, LeavesACarAloneWhoseAxesAreRight) {
  const std::vector<Flaws> flaws{{},
                                 {.gps_late_s = 0.3},
                                 {.heading_off_rad = 25.0 * kRadPerDeg},
                                 {.heading_off_rad = -25.0 * kRadPerDeg},
                                 {.gyro_bias_rad_s = 1.0 * kRadPerDeg},
                                 {.antenna_m = 2.0},
                                 {.gps_late_s = 0.3, .heading_off_rad = 15.0 * kRadPerDeg, .antenna_m = 2.0}};
  for (std::size_t k = 0; k < flaws.size(); ++k)
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
      EXPECT_EQ(drive(seed, 600.0, flaws[k], nothing).remedy, "") << "flaw " << k << ", seed " << seed;
}

/// A multirotor that hovers, turns about its vertical axis as it likes and tilts to fly somewhere, so that it
/// feels hardly any of its tilts. The estimate takes the gyro to be off by `told_rad_s`.
std::string hover(std::uint64_t seed, const Vector3d& gyro_bias_rad_s, const Vector3d& told_rad_s) {
  sim::Random random(seed, "hover");
  TiltFit fit;
  Vector3d v_N_m_s = Vector3d::Zero();
  Vector3d aim_N_m_s = Vector3d::Zero();
  double yaw_rad = 0.0;
  double yaw_aim_rad = 0.0;
  geo::Quaternion before = geo::from_rpy({0.0, 0.0, 0.0});
  for (int i = 0; i * kStep_s < 900.0; ++i) {
    if (i % 3000 == 0) {  // to and fro, and every other time it looks elsewhere first
      const double course = random.uniform(0.0, 6.28);
      const double speed_m_s = i % 6000 == 0 ? random.uniform(5.0, 12.0) : 0.0;
      aim_N_m_s = speed_m_s * Vector3d(std::cos(course), std::sin(course), 0.0);
      if (random.uniform(0.0, 1.0) < 0.5) yaw_aim_rad = course;
    }
    yaw_rad += kStep_s * std::clamp(yaw_aim_rad - yaw_rad, -1.0, 1.0);
    const Vector3d gained_m_s2 = ((aim_N_m_s - v_N_m_s) / 1.5).cwiseMax(-3.0).cwiseMin(3.0) +
                                 Vector3d(random.normal(0.3), random.normal(0.3), 0.0);
    const Vector3d thrust_m_s2 = gained_m_s2 + 0.12 * v_N_m_s;  // and drag
    const double ahead_m_s2 = thrust_m_s2.x() * std::cos(yaw_rad) + thrust_m_s2.y() * std::sin(yaw_rad);
    const double right_m_s2 = thrust_m_s2.y() * std::cos(yaw_rad) - thrust_m_s2.x() * std::sin(yaw_rad);
    const geo::Quaternion aim = geo::from_rpy({std::atan2(right_m_s2, kStandardGravity_m_s2),
                                               -std::atan2(ahead_m_s2, kStandardGravity_m_s2), yaw_rad});
    const geo::Quaternion q = before * geo::exp(0.05 * geo::log(geo::conjugate(before) * aim));
    Vector3d dtheta_rad = geo::log(geo::conjugate(before) * q) + kStep_s * gyro_bias_rad_s;
    Vector3d dv_m_s = kStep_s * (geo::to_matrix(before).transpose() *
                                 (gained_m_s2 - Vector3d(0.0, 0.0, kStandardGravity_m_s2)));
    v_N_m_s += kStep_s * gained_m_s2;
    for (int k = 0; k < 3; ++k) {
      dtheta_rad[k] += random.normal(4.0 * kRadPerDeg / 60.0 * std::sqrt(kStep_s));
      dv_m_s[k] += random.normal(0.02 * std::sqrt(kStep_s));
    }
    before = q;
    fit.add(dv_m_s, dtheta_rad, kStep_s);
    if (i % 20 != 0) continue;
    Vector3d seen_m_s = v_N_m_s;
    for (int k = 0; k < 3; ++k) seen_m_s[k] += random.normal(0.1);
    fit.measured({.v_N_m_s = seen_m_s,
                  .noise_m_s = 0.1,
                  .lever_m = 0.5,
                  .attitude = {.q_NB = q, .gyro_bias_rad_s = told_rad_s}});
    if (const OtherAxes other = fit.other(); other.evidence > kBelieved)
      return axes_hypothesis(other.number).remedy;
  }
  return "";
}

TEST(TiltFit, ABiasThatTheEstimateKnowsOfIsNoExchangeOfAxes) {
  const Vector3d bias_rad_s = Vector3d(0.5, 0.0, 0.0) * kRadPerDeg;
  const Vector3d known_rad_s = bias_rad_s + Vector3d(0.02, -0.02, 0.05) * kRadPerDeg;
  int blamed = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    blamed += hover(seed, bias_rad_s, Vector3d::Zero()).empty() ? 0 : 1;
    EXPECT_EQ(hover(seed, bias_rad_s, known_rad_s), "") << "seed " << seed;
  }
  EXPECT_GT(blamed, 0) << "the test can fail";
}

}  // namespace
}  // namespace fathom::estimation
