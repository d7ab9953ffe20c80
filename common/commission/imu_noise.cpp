#include "commission/imu_noise.hpp"

#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "base/units.hpp"
#include "commission/text.hpp"

namespace fathom::commission {
namespace {

constexpr double kRateTolerance =
    0.03;  // of the nominal rate: clocks differ by far less, data sheets by more

struct Noise {
  NoiseFigures figures;  // of the axis with the most
  bool known = false;
};

// Of a noise density: what shakes a vehicle at rest, and that the noisiest of three axes is taken, make it
// larger.
constexpr double kShaken = 0.02;

Noise largest(const std::array<std::vector<AllanPoint>, 3>& curves) {
  Noise out;
  for (const auto& curve : curves) {
    const NoiseFigures here = noise_figures(curve);
    if (!fathom::known(here.density)) continue;
    if (!out.known || here.density > out.figures.density) {
      const NoiseFigures before = out.figures;
      out.figures.density = here.density;
      out.figures.density_sigma = here.density_sigma;
      out.figures.instability = before.instability;
      out.figures.instability_sigma = before.instability_sigma;
    }
    if (fathom::known(here.instability) && !(here.instability <= out.figures.instability)) {
      out.figures.instability = here.instability;
      out.figures.instability_sigma = here.instability_sigma;
    }
    out.known = true;
  }
  return out;
}

}  // namespace

ImuNoise check_imu_noise(const Series& series, const Assumed& assumed, const std::vector<Span>& rest) {
  ImuNoise out;
  const auto add = [&](const char* what, FindingKind kind, bool is_known, Severity severity, std::string text,
                       double value = kUnknown, const char* unit = "", double sigma = kUnknown) {
    out.findings.push_back({"imu", what, kind, value, unit, sigma, is_known, severity, std::move(text)});
  };
  const ImuSeries& imu = series.imu;
  std::vector<double> steps;
  for (std::size_t i = 1; i < imu.size(); ++i) steps.push_back(imu.t_s[i] - imu.t_s[i - 1]);
  const double middle = median(steps);
  double regular = 0.0;
  double count = 0.0;
  double longest = 0.0;
  std::size_t gaps = 0;
  for (const double step : steps) {
    longest = std::max(longest, step);
    if (step > 3.0 * middle) {
      ++gaps;
      continue;
    }
    regular += step;
    count += 1.0;
  }
  const double rate = count / regular;
  const bool said = known(assumed.imu_rate_hz) && assumed.configured;
  const bool wrong = said && std::abs(rate / assumed.imu_rate_hz - 1.0) > kRateTolerance;
  add("rate", FindingKind::rate, true, wrong ? Severity::wrong : Severity::ok,
      "The inertial unit gives " + number(rate, 2) + " samples a second by its stamps" +
          (!said ? std::string(".")
                 : ", " + number(assumed.imu_rate_hz, 1) + " were configured" +
                       (wrong ? ": " + number(100.0 * (rate / assumed.imu_rate_hz - 1.0), 1) +
                                    " % off. Either the configuration is wrong, or its clock is."
                              : ".")),
      rate, "Hz", rate * 1e-4);
  add("gaps", FindingKind::rate, true, gaps * 1000 > imu.size() ? Severity::note : Severity::ok,
      gaps == 0 ? "It has no gap."
                : "It has " + std::to_string(gaps) + " gaps; the longest is " + number(longest, 3) + " s.",
      static_cast<double>(gaps), "");
  add("convention", FindingKind::convention, false, Severity::ok,
      "Whether a sample is a mean over its interval or a point cannot be told: that is half an interval of "
      "delay (" +
          number(500.0 / rate, 1) +
          " ms), which the other instruments' latencies hold as well. The data sheet tells.");
  const double rest_s = rest.empty() ? 0.0 : rest.front().to_s - rest.front().from_s;
  if (rest_s < 10.0) {
    const std::string why =
        "The noise of the inertial unit cannot be told: the vehicle was nowhere seen at rest for ten "
        "seconds. Let it lie still "
        "for five minutes, with GPS or DVL to say so.";
    add("rest", FindingKind::missing, false, Severity::ok, why);
    return out;
  }
  std::size_t n = 0;
  std::array<std::vector<double>, 3> rates;
  std::array<std::vector<double>, 3> forces;
  for (std::size_t i = 0; i < imu.size(); ++i) {
    if (imu.t_s[i] < rest.front().from_s || imu.t_s[i] > rest.front().to_s) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rates[axis].push_back(imu.rate[i][static_cast<Eigen::Index>(axis)]);
      forces[axis].push_back(imu.force[i][static_cast<Eigen::Index>(axis)]);
    }
    out.rate_bias += imu.rate[i];
    ++n;
  }
  out.rate_bias /= static_cast<double>(n);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.gyro[axis] = allan_deviation(rates[axis], 1.0 / rate);
    out.force[axis] = allan_deviation(forces[axis], 1.0 / rate);
  }
  Noise gyro = largest(out.gyro);
  Noise force = largest(out.force);
  for (Noise* each : {&gyro, &force})
    each->figures.density_sigma = std::hypot(each->figures.density_sigma, kShaken * each->figures.density);
  const auto note = [](double found, double sigma, double configured) {
    return known(configured) && std::abs(found - configured) > 3.0 * sigma &&
                   (found > 3.0 * configured || configured > 10.0 * found)
               ? Severity::note
               : Severity::ok;
  };
  const std::string over = " over " + number(rest_s, 0) + " s at rest";
  if (gyro.known) {
    out.angle_random_walk = gyro.figures.density;
    const double scale = 60.0 / kRadPerDeg;
    const double N = gyro.figures.density * scale;
    add("gyro_noise", FindingKind::noise, true,
        note(gyro.figures.density, gyro.figures.density_sigma, assumed.angle_random_walk),
        "Gyro noise " + with_sigma(N, gyro.figures.density_sigma * scale) +
            " deg/sqrt(h), of the noisiest axis" + over + ". Under way vibration adds to it.",
        N, "deg/sqrt(h)", gyro.figures.density_sigma * scale);
  }
  if (force.known) {
    out.velocity_random_walk = force.figures.density;
    const double scale = 60.0;
    const double N = force.figures.density * scale;
    add("accelerometer_noise", FindingKind::noise, true,
        note(force.figures.density, force.figures.density_sigma, assumed.velocity_random_walk),
        "Accelerometer noise " + with_sigma(N, force.figures.density_sigma * scale) +
            " m/s/sqrt(h), of the noisiest axis" + over + ".",
        N, "m/s/sqrt(h)", force.figures.density_sigma * scale);
  }
  const auto instability = [&](const char* what, const char* name, const Noise& noise, double scale,
                               const char* unit) {
    const bool is_known = noise.known && known(noise.figures.instability) && rest_s > 100.0;
    const double value = noise.figures.instability * scale;
    const double sigma = noise.figures.instability_sigma * scale;
    add(what, FindingKind::instability, is_known, Severity::ok,
        is_known
            ? std::string(name) + " bias instability " + with_sigma(value, sigma) + " " + unit + "."
            : std::string(name) +
                  " bias instability cannot be told: the Allan deviation still falls where the rest ends. " +
                  "Rest of an hour would tell.",
        is_known ? value : kUnknown, unit, is_known ? sigma : kUnknown);
  };
  instability("gyro_instability", "Gyro", gyro, 1.0 / kDegPerHour_rad_s, "deg/h");
  instability("accelerometer_instability", "Accelerometer", force, 1.0, "m/s^2");
  add("gyro_bias", FindingKind::bias, true, Severity::ok,
      "At rest the gyro reads " + number(out.rate_bias.x() / kRadPerDeg, 3) + ", " +
          number(out.rate_bias.y() / kRadPerDeg, 3) + ", " + number(out.rate_bias.z() / kRadPerDeg, 3) +
          " deg/s, the Earth's turn of 0.004 included.",
      out.rate_bias.norm() / kRadPerDeg, "deg/s",
      known(gyro.figures.density) ? gyro.figures.density / std::sqrt(rest_s) / kRadPerDeg : kUnknown);
  return out;
}

}  // namespace fathom::commission
