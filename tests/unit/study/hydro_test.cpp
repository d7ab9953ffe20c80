#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "estimation/hydro/vehicle_model.hpp"
#include "geo/so3.hpp"
#include "sim/vehicles/vehicle.hpp"
#include "study/hydro/experiment.hpp"
#include "study/hydro/hydro_study.hpp"
#include "study/runner.hpp"

namespace fathom::study {
namespace {

using Eigen::Vector3d;
using estimation::hydro::VehicleModel;
using Table = std::map<std::string, Statistics>;  // "method metric"

Table hydro_table(const std::string& one, int runs, std::vector<std::string> methods) {
  RunOptions options;
  options.runs = runs;
  options.seed = 11;
  options.cases = {one};
  options.methods = std::move(methods);
  Table out;
  for (const Row& row : run_study(HydroStudy(), options))
    out[std::string(row.method) + " " + std::string(row.metric)] = row.statistics;
  return out;
}

// The simulator's vehicle and the estimator's model were written apart; of the same vehicle they say the
// same.
TEST(HydroVehicles, SimulatedRemusMovesAsItsCoefficientsSay) {
  const VehicleModel model(hydro::remus100());
  sim::EnvironmentConfig calm;
  const auto vehicle = sim::make_remus({}, calm, 1);
  sim::Random random(5, "states");
  for (int i = 0; i < 50; ++i) {
    sim::BodyState state;
    state.depth_m = 20.0;
    state.V_B_m_s = {random.uniform(-0.5, 2.0), random.normal(0.3), random.normal(0.3)};
    state.omega_NB_B_rad_s = {random.normal(0.3), random.normal(0.3), random.normal(0.3)};
    const geo::Quaternion q =
        geo::from_rpy(Vector3d(random.normal(0.3), random.normal(0.3), random.normal(1.0)));
    state.q_NB = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
    state.actuator = {random.uniform(-500.0, 1600.0), random.normal(0.1), random.normal(0.1)};
    const sim::BodyRates rates = vehicle->dynamics(state);
    estimation::hydro::Vector6 nu;
    nu << state.V_B_m_s, state.omega_NB_B_rad_s;
    const auto expected = model.derivative(nu, state.q_NB.conjugate() * Vector3d::UnitZ(),
                                           {state.actuator.x(), state.actuator.y(), state.actuator.z()});
    EXPECT_LT((rates.V_dot_B_m_s2 - expected.head<3>()).norm(), 1e-10) << i;
    EXPECT_LT((rates.omega_dot_B_rad_s2 - expected.tail<3>()).norm(), 1e-10) << i;
  }
}

TEST(HydroVehicles, CoefficientsThatAreOffAreStillAVehicle) {
  sim::Random random(2, "coefficients");
  const auto nominal = hydro::remus100();
  for (int i = 0; i < 20; ++i) {
    const auto off = hydro::perturbed(nominal, 0.3, random);
    EXPECT_EQ(off.validate(), "");
    EXPECT_EQ(off.weight, nominal.weight);
    EXPECT_NE(off.X_uu, nominal.X_uu);
    EXPECT_LE(std::abs(off.Y_uv / nominal.Y_uv - 1.0), 0.3);
  }
  EXPECT_EQ(hydro::air_dropped().validate(), "");
}

TEST(HydroStudy, PublishedFilterDriftsLessThanInertialAlone) {
  const Table t = hydro_table("perfect", 2, {"ins", "printed", "linked", "ins_dvl"});
  EXPECT_EQ(t.at("ins time_mean_ratio_to_ins").max, 1.0);
  EXPECT_LT(t.at("printed time_mean_ratio_to_ins").mean, 0.5);
  EXPECT_LT(t.at("linked position_rms_199s").rms, 15.0);
  EXPECT_LT(t.at("ins_dvl position_rms_199s").rms, 15.0);
  EXPECT_GT(t.at("ins position_rms_199s").rms, 500.0);
}

TEST(HydroStudy, ModelBridgesTheLossOfTheDvl) {
  const Table t = hydro_table("dvl_loss_300s", 2, {"engine", "engine_no_model"});
  EXPECT_LT(t.at("engine drift_since_loss").max, 0.3 * t.at("engine_no_model drift_since_loss").mean);
}

TEST(HydroStudy, UncertaintyWithoutTheDvlIsNeitherTooLargeNorTooSmall) {
  // 95 % of means of eight runs with two degrees of freedom: chi-squared of 16, over 8.
  for (const char* one : {"dvl_loss_300s", "dvl_loss_300s_coeff_30pct"}) {
    const double nees = hydro_table(one, 8, {"engine"}).at("engine nees_position").mean;
    EXPECT_GT(nees, 0.86) << one;
    EXPECT_LT(nees, 3.61) << one;
  }
}

TEST(HydroStudy, AnotherVehiclesCoefficientsDoNoHarm) {
  const Table t = hydro_table("dvl_loss_300s_other_vehicle", 2, {"engine", "engine_no_model"});
  EXPECT_LT(t.at("engine drift_since_loss").mean, 1.1 * t.at("engine_no_model drift_since_loss").mean);
  EXPECT_LT(t.at("engine position_rms_199s").rms, 1.1 * t.at("engine_no_model position_rms_199s").rms);
}

}  // namespace
}  // namespace fathom::study
