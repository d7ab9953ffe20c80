#include "study/alignment.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "base/units.hpp"
#include "estimation/alignment/drop_alignment.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"
#include "sim/triad_error.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::study {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using estimation::DropAlignment;
using estimation::DropConfig;
using estimation::DropStep;

constexpr double kMilliG_m_s2 = 9.80665e-3;
constexpr double kStep_s = 0.01;
constexpr double kEnd_s = 45.0;
constexpr double kRefined_s = 10.0;  // the fine solution is scored this long after the coarse one
constexpr double kSetDepth_m = 80.0;
constexpr double kHeading_rad = 45.0 * kRadPerDeg;
constexpr double kPitch_rad = -5.0 * kRadPerDeg;
constexpr double kSpeedPerRpm = 0.0068;

struct Case {
  std::string_view name;
  double roll_error_deg = 10.0;  ///< navigated less true, at the release
  double pitch_error_deg = 10.0;
  double turn_deg_s = 0.0;
  double turbulence_m_s = 0.03;
  double vibration_mg = 1.0;
  double sensor_errors = 1.0;  ///< factor
};

constexpr std::array kCases{
    Case{"+10+10", 10.0, 10.0},
    Case{"+10-10", 10.0, -10.0},
    Case{"-10+10", -10.0, 10.0},
    Case{"-10-10", -10.0, -10.0},
    Case{"+20+20", 20.0, 20.0},
    Case{"+30+30", 30.0, 30.0},
    Case{"pitch_11", 0.0, 11.0},
    Case{"pitch_14", 0.0, 14.0},
    Case{"roll_30", 30.0, 0.0},
    Case{"turn_6dps", 10.0, 10.0, 6.0},
    Case{"turbulence_0.1", 10.0, 10.0, 0.0, 0.1},
    Case{"vibration_20mg", 10.0, 10.0, 0.0, 0.03, 20.0},
    Case{"error_free", 10.0, 10.0, 0.0, 0.0, 0.0, 0.0},
};

const Case& case_of(std::string_view name) {
  for (const Case& one : kCases)
    if (one.name == name) return one;
  return kCases.front();
}

/// The published release. What differs from run to run comes from `random`.
sim::Scenario scenario_of(const Case& one, sim::Random& random) {
  sim::Scenario out;
  out.vehicle.kind = sim::VehicleConfig::Kind::air_drop;
  out.environment.turbulence_m_s = one.turbulence_m_s;
  out.environment.turbulence_tau_s = 1.0;
  out.environment.water_depth_m = 1000.0;
  out.start.latitude_rad = 36.4 * kRadPerDeg;
  out.start.longitude_rad = 127.4 * kRadPerDeg;
  out.start.depth_m = -380.0;
  out.start.speed_m_s = 61.7 + random.normal(2.0);
  out.start.rpy_rad = {0.0, kPitch_rad, kHeading_rad};
  sim::MissionStep step;
  step.speed_m_s = 17.0;
  step.heading_rad = kHeading_rad;
  step.depth_m = kSetDepth_m;
  out.mission.push_back(step);
  if (one.turn_deg_s != 0.0) {
    constexpr double from_s = 16.0;
    constexpr double every_s = 0.1;
    for (double t = from_s; t < kEnd_s; t += every_s) {
      sim::MissionStep turn;
      turn.at_s = t;
      turn.heading_rad = kHeading_rad + one.turn_deg_s * kRadPerDeg * (t - from_s);
      out.mission.push_back(turn);
    }
  }
  return out;
}

/// The published instruments (SENS-1, SENS-2): gyro 2 deg/h, 200 ppm, 1.5 arc minutes, 0.01 deg/s a sample;
/// accelerometer 1 mg, 300 ppm, 1.5 arc minutes, 1 mg a sample; log 1.5 %, 0.1 m/s; depth 0.05 m; 100 Hz.
class Instruments {
 public:
  Instruments(const Case& one, std::uint64_t seed)
      : random_(seed, "instruments"),
        errors_(one.sensor_errors),
        vibration_(one.vibration_mg * kMilliG_m_s2) {
    const double angle = 1.5 / 60.0 * kRadPerDeg * errors_;
    for (int i = 0; i < 3; ++i) {
      gyro_[i] = {random_.normal(2.0 * kRadPerDeg / 3600.0 * errors_), random_.normal(200e-6 * errors_),
                  random_.normal(angle), random_.normal(angle)};
      accelerometer_[i] = {random_.normal(kMilliG_m_s2 * errors_), random_.normal(300e-6 * errors_),
                           random_.normal(angle), random_.normal(angle)};
    }
    factor_error_ = random_.normal(0.015 * kSpeedPerRpm * errors_);
  }
  Vector3d rate(const Vector3d& truth) { return read(truth, gyro_, 0.01 * kRadPerDeg * errors_); }
  Vector3d force(const Vector3d& truth) { return read(truth, accelerometer_, vibration_); }
  /// As shaft speed of a propulsor of the factor that is believed.
  double rpm(double truth) {
    return sim::propulsor_speed(truth, kSpeedPerRpm, factor_error_, random_.normal(0.1 * errors_)) /
           kSpeedPerRpm;
  }
  double depth(double truth_m) { return truth_m + random_.normal(0.05 * errors_); }

 private:
  Vector3d read(const Vector3d& truth, const std::array<sim::AxisError, 3>& axes, double noise) {
    Vector3d out;
    for (int i = 0; i < 3; ++i)
      out(i) = sim::axis_output(truth, i, axes[static_cast<std::size_t>(i)], random_.normal(noise));
    return out;
  }

  sim::Random random_;
  double errors_;
  double vibration_;
  std::array<sim::AxisError, 3> gyro_;
  std::array<sim::AxisError, 3> accelerometer_;
  double factor_error_ = 0.0;
};

constexpr std::string_view kPrinted = "printed";             // the published method
constexpr std::string_view kPrintedGated = "printed_gated";  // its form behind our conditions
constexpr std::string_view kRobust = "robust";
constexpr std::string_view kFine = "fine";

/// Takes away the conditions that the publication does not have, and the low-pass before them (ALN-11).
void publish_conditions(estimation::StabilityConfig& stability) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  stability.rate_z_rad_s = stability.gravity_defect_m_s2 = stability.speed_slope_m_s2 = kNone;
  stability.force_spread_m_s2 = stability.flow_spread_m_s2 = kNone;
  stability.low_pass_s = 0.0;
}

/// What the alignment believes. Its model of the vehicle is not the vehicle: each coefficient is known to
/// 10 % only.
DropConfig config_of(std::string_view method, sim::Random& random) {
  DropConfig config;
  config.set_depth_m = kSetDepth_m;
  config.speed_per_rpm = kSpeedPerRpm;
  const bool printed = method == kPrinted || method == kPrintedGated;
  config.form = printed ? DropConfig::Form::printed : DropConfig::Form::robust;
  config.fine = config.early = method == kFine;
  if (method == kPrinted) publish_conditions(config.stability);
  config.aligned_hold_s = 0.5;
  // As the data sheets say: 1 mg, and 1.5 arc minutes of gravity.
  config.accel_sigma_m_s2 = 0.0107;
  config.flow_sigma_m_s = 0.07;
  config.slip_per_turn_m = 1.58 * (1.0 + random.normal(0.1));
  config.trim_m2_s2 = 2.26 * (1.0 + random.normal(0.1));
  config.speed_lag_s = 0.1 * (1.0 + random.normal(0.2));
  config.flow_lag_m = 3.1 * (1.0 + random.normal(0.1));
  config.surge_tau_s = 1.5;
  return config;
}

struct Snapshot {
  bool taken = false;
  double t_s = 0.0;
  Vector2d error_rad = Vector2d::Zero();  ///< roll, pitch: navigated less true
  Vector2d sigma_rad = Vector2d::Zero();
  double nees = 0.0;

  [[nodiscard]] bool false_claim() const {
    for (int i = 0; i < 2; ++i)
      if (std::abs(error_rad(i)) > 3.0 * sigma_rad(i) || std::abs(error_rad(i)) > kRadPerDeg) return true;
    return false;
  }
};

Snapshot judge(const DropAlignment& alignment, const sim::TruthPoint& truth) {
  Snapshot out;
  out.taken = true;
  out.t_s = truth.t_s;
  const Vector3d rpy = geo::to_rpy(alignment.q_NB());
  const Vector3d wanted = sim::rpy_of(truth.q_NB);
  const Vector3d sigma = alignment.rpy_sigma_rad();
  for (int i = 0; i < 2; ++i) {
    out.error_rad(i) = geo::wrap_pi(rpy(i) - wanted(i));
    out.sigma_rad(i) = sigma(i);
  }
  // Roll and pitch of a nearly level vehicle are two turns of the attitude error: their covariance by it.
  const double c = std::cos(rpy.z());
  const double s = std::sin(rpy.z());
  const double level = std::cos(rpy.y());
  Eigen::Matrix<double, 2, 3> j;
  j << -c / level, -s / level, 0.0, s, -c, 0.0;
  const Eigen::Matrix2d p = j * alignment.attitude_covariance() * j.transpose();
  const double det = p(0, 0) * p(1, 1) - p(0, 1) * p(0, 1);
  const Vector2d& e = out.error_rad;
  out.nees = (p(1, 1) * e(0) * e(0) - 2.0 * p(0, 1) * e(0) * e(1) + p(0, 0) * e(1) * e(1)) / det;
  return out;
}

/// One vehicle from release to the end, steered by what this method believes.
void run_method(const Case& one, std::string_view method, std::uint64_t seed, Scores& scores) {
  sim::Random release(seed, "release");
  sim::Random model(seed, "model");
  sim::TruthGenerator truth(scenario_of(one, release), seed);
  Instruments instruments(one, seed);
  const DropConfig config = config_of(method, model);
  DropAlignment alignment(config);
  // The heading is handed over as well as it is said to be.
  const double heading_rad = kHeading_rad + release.normal(one.sensor_errors * config.heading_sigma_rad);
  alignment.start(geo::from_rpy(
      {one.roll_error_deg * kRadPerDeg, kPitch_rad + one.pitch_error_deg * kRadPerDeg, heading_rad}));
  const bool fine = method == kFine;
  Snapshot claimed;  // when the method says that it is done
  Snapshot refined;
  double coarse_at_s = kUnknown;
  for (int i = 1; static_cast<double>(i) * kStep_s <= kEnd_s; ++i) {
    const geo::Quaternion& q = alignment.q_NB();
    truth.steer_by({q.w, q.x, q.y, q.z});
    const sim::ImuTruth interval = truth.advance_to(i * kStep_s);
    const sim::TruthPoint& now = truth.point();
    DropStep step;
    step.dt_s = interval.dt_s;
    step.rate_IB_B_rad_s = instruments.rate(interval.delta_angle_B_rad / interval.dt_s);
    step.force_B_m_s2 = instruments.force(interval.delta_velocity_B_m_s / interval.dt_s);
    step.earth_rate_N_rad_s = geo::earth_rate_N(now.latitude_rad);
    step.rate_IN_N_rad_s = step.earth_rate_N_rad_s;
    step.g_m_s2 = geo::gravity(now.latitude_rad, -kSetDepth_m);
    alignment.add(step);
    if (now.depth_m > 0.0) {
      alignment.add_depth(instruments.depth(now.depth_m));
      alignment.add_rpm(instruments.rpm(now.rpm));
    }
    const AlignmentPhase phase = alignment.phase();
    const bool coarse =
        phase == AlignmentPhase::coarse || phase == AlignmentPhase::fine || phase == AlignmentPhase::aligned;
    if (coarse && !known(coarse_at_s)) coarse_at_s = now.t_s;
    const bool done = fine ? phase == AlignmentPhase::aligned : phase == AlignmentPhase::coarse;
    if (done && !claimed.taken) claimed = judge(alignment, now);
    if (fine && known(coarse_at_s) && !refined.taken && now.t_s >= coarse_at_s + kRefined_s && claimed.taken)
      refined = judge(alignment, now);
    if (refined.taken || (!fine && claimed.taken)) break;
  }
  const Snapshot& scored = fine ? refined : claimed;
  const auto value = [](const Snapshot& from, double v) { return from.taken ? v : kUnknown; };
  scores.add(method, "roll_error", value(scored, scored.error_rad(0) / kRadPerDeg));
  scores.add(method, "pitch_error", value(scored, scored.error_rad(1) / kRadPerDeg));
  scores.add(method, "time_to_aligned", value(claimed, claimed.t_s));
  scores.add(method, "aligned", claimed.taken ? 1.0 : 0.0);
  const bool falsely = (claimed.taken && claimed.false_claim()) || (scored.taken && scored.false_claim());
  scores.add(method, "falsely_aligned", falsely ? 1.0 : 0.0);
  scores.add(method, "timed_out", alignment.phase() == AlignmentPhase::timed_out ? 1.0 : 0.0);
  scores.add(method, "roll_sigma", value(scored, scored.sigma_rad(0) / kRadPerDeg));
  scores.add(method, "pitch_sigma", value(scored, scored.sigma_rad(1) / kRadPerDeg));
  scores.add(method, "nees_tilt", value(scored, scored.nees));
}

}  // namespace

std::vector<std::string_view> AlignmentStudy::cases() const {
  std::vector<std::string_view> names;
  for (const Case& one : kCases) names.push_back(one.name);
  return names;
}

std::vector<std::string_view> AlignmentStudy::methods() const {
  return {kPrinted, kPrintedGated, kRobust, kFine};
}

std::vector<Metric> AlignmentStudy::metrics() const {
  return {{"roll_error", "deg"},     {"pitch_error", "deg"},          {"time_to_aligned", "s"},
          {"aligned", "fraction"},   {"falsely_aligned", "fraction"}, {"nees_tilt", "1"},
          {"timed_out", "fraction"}, {"roll_sigma", "deg"},           {"pitch_sigma", "deg"}};
}

void AlignmentStudy::run(const RunRequest& request, Scores& scores) const {
  const Case& one = case_of(request.case_name);
  for (const std::string_view method : methods())
    if (request.wants(method)) run_method(one, method, request.seed, scores);
}

}  // namespace fathom::study
