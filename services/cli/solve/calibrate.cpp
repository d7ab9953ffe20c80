#include "cli/solve/calibrate.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "estimation/hydro/calibration.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::cli {
namespace {

using estimation::hydro::Calibration;
using estimation::hydro::CalibrationPoint;

constexpr double kPointEvery_s = 0.1;
constexpr double kDvlFresh_s = 1.0;

/// The newest sample at or before an instant that never goes back.
template <class Sample>
class Latest {
 public:
  explicit Latest(const std::vector<Sample>& samples) : samples_(samples) {}
  const Sample* at(TimeNs stamp_ns) {
    while (next_ < samples_.size() && samples_[next_].header.stamp_ns <= stamp_ns) ++next_;
    return next_ == 0 ? nullptr : &samples_[next_ - 1];
  }

 private:
  const std::vector<Sample>& samples_;
  std::size_t next_ = 0;
};

/// Makes points of a tenth of a second out of navigation states.
class Log {
 public:
  explicit Log(const SolveRun& solve_run)
      : config_(solve_run.config->engine),
        rpm_(solve_run.data->of<PropulsionSample>()),
        fins_(solve_run.data->of<FinsSample>()) {}

  void add(const NavState& state) {
    const PropulsionSample* shaft = rpm_.at(state.header.stamp_ns);
    const FinsSample* fins = fins_.at(state.header.stamp_ns);
    if (!is_moving(state) || shaft == nullptr || !known(shaft->rpm)) return;
    const Eigen::Vector3d rate = geo::vec(state.angular_rate_B_rad_s);
    if (last_ns_ == 0) {
      last_ns_ = state.header.stamp_ns;
      keep(state, *shaft, fins, rate, 0.0);
      return;
    }
    rates_ += rate;
    ++count_;
    const double dt_s = to_seconds(state.header.stamp_ns - last_ns_);
    if (dt_s < kPointEvery_s - 1e-6) return;
    keep(state, *shaft, fins, rates_ / count_, dt_s);
    last_ns_ = state.header.stamp_ns;
    rates_.setZero();
    count_ = 0;
  }
  [[nodiscard]] const std::vector<CalibrationPoint>& points() const { return points_; }

 private:
  static bool is_moving(const NavState& state) {
    return known(state.latitude_rad) && known(state.velocity_N_m_s[0]) && known(state.q_NB[0]) &&
           known(state.angular_rate_B_rad_s[0]);
  }
  void keep(const NavState& state, const PropulsionSample& shaft, const FinsSample* fins,
            const Eigen::Vector3d& rate, double dt_s) {
    CalibrationPoint point;
    point.dt_s = dt_s;
    point.C_NB = geo::to_matrix({state.q_NB[0], state.q_NB[1], state.q_NB[2], state.q_NB[3]});
    // The state's rate is against the stars.
    const geo::Geodetic at{state.latitude_rad, state.longitude_rad, state.altitude_m};
    const Eigen::Vector3d v_N = geo::vec(state.velocity_N_m_s);
    point.omega_B_rad_s =
        rate - point.C_NB.transpose() * (geo::earth_rate_N(at.latitude_rad) + geo::transport_rate_N(at, v_N));
    const Eigen::Vector3d arm =
        geo::vec(config_.vehicle_model.origin_B_m) - geo::vec(config_.output_lever_B_m);
    point.V_ground_B_m_s = point.C_NB.transpose() * v_N + geo::cross(point.omega_B_rad_s, arm);
    point.controls.rpm = shaft.rpm;
    if (fins != nullptr && known(fins->rudder_rad) && known(fins->stern_rad)) {
      point.controls.rudder_rad = fins->rudder_rad;
      point.controls.stern_rad = fins->stern_rad;
    }
    const double least_m = config_.vehicle_model.min_depth_m;
    const bool submerged = least_m <= 0.0 || (known(state.depth_m) && state.depth_m >= least_m);
    point.vouched = submerged && state.dvl_outage_s <= kDvlFresh_s;
    points_.push_back(point);
  }

  const estimation::EngineConfig& config_;
  Latest<PropulsionSample> rpm_;
  Latest<FinsSample> fins_;
  std::vector<CalibrationPoint> points_;
  TimeNs last_ns_ = 0;
  Eigen::Vector3d rates_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

std::string source_of(const estimation::hydro::CalibratedCoefficient& one) {
  return one.observable ? "calibrated" : "hardly observable in the log: mostly the value before";
}

void write_file(const std::string& path, const Calibration& found, const std::string& vehicle,
                const std::string& directory) {
  nlohmann::ordered_json entries;
  for (const auto& entry : estimation::hydro::coefficient_table()) {
    const double value = found.coefficients.*entry.member;
    if (value == 0.0) continue;
    entries[entry.name] = {{"value", value}, {"unit", entry.unit}, {"source", "as given"}};
  }
  for (const auto& one : found.found) {
    entries[one.entry->name]["source"] = source_of(one);
    entries[one.entry->name]["sigma"] = one.sigma;
  }
  nlohmann::ordered_json out;
  out["vehicle"] = vehicle;
  out["source"] = "calibrated from " + directory;
  out["coefficients"] = entries;
  std::ofstream file(path, std::ios::binary);
  file << out.dump(2) << "\n";
  file.close();
  if (!file) throw Failure(ExitCode::runtime_failure, path + ": cannot be written, expected a writable path");
}

std::string calibration_text(const Calibration& found) {
  std::string text;
  std::array<char, 200> line{};
  const auto say = [&](const char* format, auto... values) {
    std::snprintf(line.data(), line.size(), format, values...);
    text += line.data();
  };
  say("vehicle model, %.0f s with the DVL: velocity misses by %.4f %.4f %.4f m/s before, %.4f %.4f %.4f "
      "after\n",
      found.compared_s, found.residual_before_m_s.x(), found.residual_before_m_s.y(),
      found.residual_before_m_s.z(), found.residual_after_m_s.x(), found.residual_after_m_s.y(),
      found.residual_after_m_s.z());
  say("  current %.3f %.3f m/s north, east, sigma %.3f %.3f\n", found.current_N_m_s.x(),
      found.current_N_m_s.y(), found.current_sigma_m_s.x(), found.current_sigma_m_s.y());
  for (const auto& one : found.found) {
    say("  %-8s %10.4g -> %10.4g  sigma %9.3g %-12s %s\n", one.entry->name, one.before, one.after, one.sigma,
        one.entry->unit, one.observable ? "" : "hardly observable");
  }
  return text;
}

}  // namespace

void check_calibration(const SolveRun& solve_run, const std::string& directory,
                       const std::string& config_file) {
  const auto& start = solve_run.config->engine.vehicle_model.coefficients;
  if (const std::string complaint = start.validate(); !complaint.empty()) {
    throw Failure(ExitCode::bad_configuration,
                  config_file + ": engine.vehicle_model.coefficients." + complaint + ", to calibrate from");
  }
  if (solve_run.data->of<PropulsionSample>().empty()) {
    throw Failure(ExitCode::bad_input,
                  directory + "/propulsion.csv: no rows, expected the shaft speed to calibrate with");
  }
  if (solve_run.data->of<DvlSample>().empty()) {
    throw Failure(ExitCode::bad_input,
                  directory + "/dvl.csv: no rows, expected velocities over ground to calibrate with");
  }
}

std::string calibrate_hydro(const SolveRun& solve_run, const std::string& directory,
                            const std::string& out_file) {
  // What is to be calibrated must not have had a hand in the velocity.
  config::FusionConfig config = *solve_run.config;
  config.engine.vehicle_model.enabled = false;
  SolveRun own = solve_run;
  own.config = &config;
  own.label = "calibrate";
  Log log(own);
  own.on_state = [&](const NavState& state, estimation::FusionEngine&) { log.add(state); };
  (void)run(own);
  const auto& start = solve_run.config->engine.vehicle_model.coefficients;
  const Calibration found = estimation::hydro::calibrate(start, log.points());
  if (!found.failure.empty()) throw Failure(ExitCode::bad_input, directory + ": " + found.failure);
  write_file(out_file, found, solve_run.config->common.vehicle, directory);
  return calibration_text(found);
}

}  // namespace fathom::cli
