#include "study/rotating_arm/rotating_arm.hpp"

#include <array>
#include <cmath>
#include <mutex>

#include "estimation/filter/strapdown.hpp"
#include "geo/so3.hpp"
#include "study/baselines/dead_reckoning.hpp"
#include "study/engine_run.hpp"
#include "study/rotating_arm/rotating_arm_rig.hpp"

namespace fathom::study {
namespace {

using Eigen::Vector3d;

constexpr std::string_view kImuOnly = "imu_only";
constexpr std::string_view kDeadReckoning = "dead_reckoning";
constexpr std::string_view kHybrid = "hybrid25";
constexpr std::string_view kHybridEqual = "hybrid25_equal";
constexpr std::string_view kFull = "full";

constexpr std::string_view kEndError = "horizontal_end_error";
constexpr std::string_view kOverBound = "rmse_over_pcrlb";
constexpr std::string_view kNees = "nees_horizontal";
constexpr std::string_view kPerfectImu = "perfect_imu_error";

/// What does not depend on the seed.
struct Reference {
  double bound_m = 0.0;              ///< root of the trace of the horizontal position's bound at the end
  double perfect_imu_error_m = 0.0;  ///< largest error of the mechanisation with perfect instruments
};

/// Error-free measurements keep the engine on the true trajectory, so that its covariance is the Riccati
/// recursion linearised there (STUDY-2); the same inertial samples go through the mechanisation alone.
Reference reference_of(const ArmCase& one) {
  sim::Simulation simulation(arm_scenario(one, Instruments::perfect), {});
  EngineRun bound(arm_config(one, ArmFilter::bound, ArmStart{}), one.imu_every);
  bound.at_rest_for(kArmRest_s);

  const Truth start = simulation.truth();
  estimation::NavSolution nav;
  nav.position = {start.latitude_rad, start.longitude_rad, start.altitude_m};
  nav.q_NB = geo::from_rpy(geo::vec(start.rpy_rad));
  estimation::Increments in;
  ImuSum sum(one.imu_every);
  Reference out;
  const auto mechanise = [&](const sim::Measurement& measurement) {
    if (!std::holds_alternative<ImuSample>(measurement)) return;
    ImuSample sample = std::get<ImuSample>(measurement);
    if (!sum.add(sample)) return;
    in.dt_s = sample.delta_time_s;
    in.dtheta_before_rad = in.dtheta_rad;
    in.dv_before_m_s = in.dv_m_s;
    in.dtheta_rad = geo::vec(sample.delta_angle_B_rad);
    in.dv_m_s = geo::vec(sample.delta_velocity_B_m_s);
    nav = estimation::mechanise(nav, estimation::correct(in, 1.0));
    const Truth truth = simulation.truth();
    const Vector3d error =
        geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m}, nav.position);
    out.perfect_imu_error_m = std::max(out.perfect_imu_error_m, error.head<2>().norm());
  };
  const std::array<EngineRun*, 1> engines{&bound};
  carry_out(simulation, kArmDuration_s, engines, mechanise);
  out.bound_m = horizontal_error(bound.engine().nav_state(), simulation.truth()).sigma_m;
  return out;
}

class RotatingArm final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "rotating_arm"; }
  [[nodiscard]] std::string_view description() const override {
    return "600 s on a rotating arm of 8 m with IMU, DVL, compass and depth, no position fix";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override {
    std::vector<std::string_view> names;
    for (const ArmCase& one : arm_cases()) names.push_back(one.name);
    return names;
  }
  [[nodiscard]] std::vector<std::string_view> methods() const override {
    return {kImuOnly, kDeadReckoning, kHybrid, kHybridEqual, kFull};
  }
  [[nodiscard]] std::vector<Metric> metrics() const override {
    return {{kEndError, "m"}, {kOverBound, "1", Summary::root_mean_square}, {kNees, "1"}, {kPerfectImu, "m"}};
  }
  [[nodiscard]] int default_runs() const override { return 60; }

  void run(const RunRequest& request, Scores& scores) const override {
    const auto all = arm_cases();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const ArmCase& c) { return c.name == request.case_name; });
    const ArmCase& one = *found;
    const Reference& reference = reference_for(static_cast<std::size_t>(found - all.begin()), one);

    sim::Simulation::Options options;
    options.seed = request.seed;
    sim::Simulation simulation(arm_scenario(one, Instruments::real), options);
    const ArmStart start = draw_start(request.seed);
    std::vector<std::pair<std::string_view, EngineRun>> engines;
    engines.reserve(4);
    const auto enter = [&](std::string_view method, ArmFilter filter) {
      if (!request.wants(method)) return;
      engines.emplace_back(method, EngineRun(arm_config(one, filter, start), one.imu_every));
      engines.back().second.at_rest_for(kArmRest_s);
    };
    enter(kImuOnly, ArmFilter::imu_only);
    enter(kHybrid, ArmFilter::hybrid25);
    enter(kHybridEqual, ArmFilter::hybrid25_equal);
    enter(kFull, ArmFilter::full);
    std::vector<EngineRun*> running;
    for (auto& [method, engine] : engines) running.push_back(&engine);
    DeadReckoning dead_reckoning(start.position);
    carry_out(simulation, kArmDuration_s, running,
              [&](const sim::Measurement& measurement) { dead_reckoning.take(measurement); });

    const Truth truth = simulation.truth();
    for (const auto& [method, engine] : engines) {
      const HorizontalError error = horizontal_error(engine.engine().nav_state(), truth);
      scores.add(method, kEndError, error.error_m);
      if (method == kImuOnly) continue;
      scores.add(method, kOverBound, error.error_m / reference.bound_m);
      scores.add(method, kNees, error.nees);
    }
    if (request.wants(kImuOnly)) scores.add(kImuOnly, kPerfectImu, reference.perfect_imu_error_m);
    if (request.wants(kDeadReckoning)) {
      const Vector3d error = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                               dead_reckoning.position());
      scores.add(kDeadReckoning, kEndError, error.head<2>().norm());
    }
  }

 private:
  const Reference& reference_for(std::size_t index, const ArmCase& one) const {
    std::call_once(once_[index], [&] { references_[index] = reference_of(one); });
    return references_[index];
  }

  mutable std::array<std::once_flag, kArmCases> once_;
  mutable std::array<Reference, kArmCases> references_;
};

}  // namespace

std::unique_ptr<const Study> make_rotating_arm_study() {
  return std::make_unique<RotatingArm>();
}

}  // namespace fathom::study
