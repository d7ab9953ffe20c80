#include "cli/bench/hydro.hpp"

#include "cli/bench/floor.hpp"
#include "cli/bench/vehicle.hpp"
#include "cli/command.hpp"
#include "estimation/aiding/model_velocity.hpp"
#include "estimation/filter/error_filter.hpp"
#include "geo/so3.hpp"
#include "study/baselines/embedded_filter.hpp"
#include "study/hydro/vehicles.hpp"

namespace fathom::cli {
namespace {

using Eigen::Vector3d;
using estimation::hydro::Controls;
using study::hydro::EmbeddedFilter;

constexpr int kSteps = 40;
constexpr double kRpm = 1500.0;

/// Prediction and DVL; the floor is the vehicle's dynamics at the sigma points alone.
template <int N>
BenchRow ukf_step(const char* name, int rounds) {
  const auto coefficients = study::hydro::remus100();
  const estimation::hydro::VehicleModel model(coefficients);
  EmbeddedFilter<N> base(coefficients, {});
  const estimation::InitialState start = BenchVehicle("gps_ins15", 100.0).start();
  estimation::NavSolution nav;
  nav.position = {start.latitude_rad, start.longitude_rad, start.altitude_m};
  nav.v_N_m_s = geo::vec(start.velocity_N_m_s);
  nav.q_NB = geo::from_rpy(geo::vec(start.rpy_rad));
  base.start(nav, 0.0);
  EmbeddedFilter<N> filter = base;
  DvlSample dvl;
  dvl.velocity_D_m_s = {1.54, 0.01, 0.0};
  const Controls controls{kRpm, 0.02, -0.01};
  estimation::hydro::Vector6 nu;
  nu << 1.5, 0.05, -0.03, 0.02, -0.01, 0.03;
  estimation::hydro::Vector6 sum = estimation::hydro::Vector6::Zero();
  const BenchRow row = compare(
      name, rounds, kSteps, [&] { filter = base; }, [&] { filter.step(controls, dvl); },
      [&] {
        for (int i = 0; i < study::Ukf<N>::kPoints; ++i) {
          nu[5] += 1e-9;
          sum += model.step(nu, Vector3d::UnitZ(), controls, EmbeddedFilter<N>::kStep_s);
        }
      });
  if (!sum.allFinite() || !filter.nav().v_N_m_s.allFinite())
    throw Failure(ExitCode::runtime_failure, std::string("bench: ") + name + ": not finite");
  return row;
}

/// One step of the model and one measurement of it; the floor is the dense Joseph form of such a
/// measurement.
BenchRow model_velocity(int rounds) {
  const BenchVehicle vehicle("full", 100.0);
  estimation::EngineConfig config = vehicle.config();
  config.groups.current = config.groups.model_scale = config.groups.model_bias = true;
  config.vehicle_model.enabled = true;
  config.vehicle_model.coefficients = study::hydro::remus100();
  config.vehicle_model.settle_s = 0.0;
  const estimation::StateIndex index(config.groups);
  const estimation::hydro::VelocityModel model(config.vehicle_model.coefficients);
  std::array<double, estimation::kMaxStates> sigma{};
  sigma.fill(0.01);
  estimation::ErrorFilter base(index.size());
  base.reset(sigma);
  estimation::ErrorFilter filter = base;
  estimation::FilterState state;
  const estimation::InitialState start = vehicle.start();
  state.nav.position = {start.latitude_rad, start.longitude_rad, start.altitude_m};
  state.nav.v_N_m_s = geo::vec(start.velocity_N_m_s);
  state.nav.q_NB = geo::from_rpy(geo::vec(start.rpy_rad));
  estimation::hydro::WaterVelocity water;
  water.begin({1.54, 0.0, 0.0});
  water.set_rpm(kRpm);
  water.set_fins(0.02, -0.01);
  PropulsionSample shaft;
  shaft.rpm = kRpm;
  const auto floor = dense_floor(index.size(), 2);
  bool good = true;
  const BenchRow row = compare(
      "model_velocity_step_full", rounds, kSteps,
      [&] {
        filter = base;
        floor->reset();
      },
      [&] {
        const estimation::AidingState now(index, state, Vector3d(1e-3, 2e-3, 0.02), 0.0);
        water.advance(model, now.rate_nb_B_rad_s, now.C_NB.row(2).transpose(), 0.01);
        good = good && estimation::ModelVelocity::usable(now, config.vehicle_model, water, shaft, 0.0) ==
                           estimation::Usable::yes;
        estimation::Observation observation;
        observe(estimation::ModelVelocity(now, config.vehicle_model, water), index, observation);
        observation.list_columns(index.size());
        estimation::InnovationStatistics statistics;
        filter.statistics(observation, 1.0, statistics);
        std::array<double, estimation::kMaxStates> x{};
        good = filter.update(observation, statistics, x) && good;
      },
      [&] { floor->update(); });
  if (!good) throw Failure(ExitCode::runtime_failure, "bench: model_velocity: refused");
  return row;
}

}  // namespace

void bench_hydro(int rounds, const std::function<void(const BenchRow&)>& done) {
  done(ukf_step<study::hydro::kPrintedStates>("ukf_step_printed", rounds));
  done(ukf_step<study::hydro::kLinkedStates>("ukf_step_linked", rounds));
  done(model_velocity(rounds));
}

}  // namespace fathom::cli
