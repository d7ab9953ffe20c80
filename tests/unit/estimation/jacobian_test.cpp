#include <map>

#include <gtest/gtest.h>

#include "estimation/aiding/constraints.hpp"
#include "estimation/aiding/model_velocity.hpp"
#include "estimation/aiding/non_holonomic.hpp"
#include "estimation/aiding/registry.hpp"
#include "estimation/aiding/zero_velocity.hpp"
#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/strapdown.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::Normal;

/// Everything that a model may look at, in two halves because there is room for 64 states only: what is met
/// under water, and what is met on land and in the air. GPS is met in both.
StateGroups all_groups(bool under_water) {
  StateGroups g;
  g.accel_scale = g.gyro_scale = g.accel_misalignment = g.gyro_misalignment = true;
  g.gps_position_bias = g.gps_latency = g.gps_lever = g.current = true;
  if (under_water) {
    g.dvl_scale = g.dvl_misalignment = g.dvl_bias = g.depth_bias = g.surface_altitude = true;
    g.heading_bias = g.heading_deviation = g.usbl_bias = g.usbl_misalignment = g.log_scale = true;
  } else {
    g.airspeed_bias = g.airspeed_scale = g.flow_angles = g.baro_bias = true;
    g.mount_angles = g.mount_lever = g.antenna_bias = g.beacon_place = true;
    g.model_scale = g.model_bias = true;  // no room in the other half
  }
  return g;
}

FilterState random_state(Normal& normal, const StateIndex& index) {
  FilterState state;
  state.nav.position = {normal.uniform(-1.2, 1.2), normal.uniform(-3.0, 3.0), normal.uniform(-500.0, 3000.0)};
  state.nav.v_N_m_s = normal.vector(10.0);
  state.nav.q_NB =
      geo::from_rpy({normal.uniform(-1.0, 1.0), normal.uniform(-0.9, 0.9), normal.uniform(-3.1, 3.1)});
  for (int i = kNavStates; i < index.size(); ++i)
    state.x[static_cast<std::size_t>(i)] = normal(i < index.imu_end() ? 1e-5 : 0.01);
  return state;
}

/// The estimate whose error is larger by `delta` in one state: the reverse of a correction.
FilterState perturbed(const FilterState& state, const StateIndex& index, int which, double delta) {
  std::array<double, kMaxStates> x{};
  x[static_cast<std::size_t>(which)] = -delta;
  FilterState out = state;
  remove_error(x, index.size(), out);
  return out;
}

/// A sample of each kind with every field known.
EventSample sample_of(const AidingEntry& entry, const FilterState& state, Normal& normal) {
  const SourceKind source = entry.source;
  const geo::Geodetic near = geo::moved_by(state.nav.position, normal.vector(5.0));
  switch (source) {
    case SourceKind::gps: {
      GpsSample s;
      s.fix = GpsFix::fix_3d;
      s.latitude_rad = near.latitude_rad;
      s.longitude_rad = near.longitude_rad;
      s.altitude_m = near.altitude_m;
      s.velocity_N_m_s = geo::arr(state.nav.v_N_m_s);
      return s;
    }
    case SourceKind::dvl: {
      DvlSample s;
      s.mode = normal(1.0) > 0.0 ? DvlMode::water : DvlMode::bottom;
      s.velocity_D_m_s = {1.0, 0.2, -0.1};
      s.beam_velocity_m_s = {0.3, -0.2, 0.5, -0.4};
      s.beam_angle_rad = normal(1.0) > 0.0 ? normal.uniform(0.3, 0.6) : kUnknown;
      return s;
    }
    case SourceKind::depth: {
      DepthSample s;
      s.depth_m = 12.0;
      return s;
    }
    case SourceKind::heading: {
      HeadingSample s;
      s.heading_rad = geo::wrap_two_pi(geo::to_rpy(state.nav.q_NB).z() + normal(0.1));
      return s;
    }
    case SourceKind::usbl: {
      UsblSample s;
      if (entry.name == std::string("usbl_position")) {
        s.latitude_rad = near.latitude_rad;
        s.longitude_rad = near.longitude_rad;
        s.depth_m = 15.0;
        return s;
      }
      const double which = normal.uniform(0.0, 3.0);
      s.frame = which < 1.0 ? UsblFrame::ned : which < 2.0 ? UsblFrame::vessel_frd : UsblFrame::vehicle_frd;
      // The station is where it was configured, or where the sample says.
      if (normal(1.0) > 0.0) {
        const geo::Geodetic ship = geo::moved_by(state.nav.position, normal.vector(20.0));
        s.station_latitude_rad = ship.latitude_rad;
        s.station_longitude_rad = ship.longitude_rad;
        s.station_depth_m = 18.0 - ship.altitude_m;
      }
      s.station_rpy_rad = geo::arr(normal.vector(0.5));
      if (entry.name == std::string("usbl_vector")) {
        s.relative_m = geo::arr(normal.vector(20.0));
        return s;
      }
      s.range_m = 30.0;
      if (normal(1.0) > -1.0) s.bearing_rad = normal.uniform(0.0, 6.28);
      if (normal(1.0) > -1.0 || !known(s.bearing_rad)) s.depression_rad = normal.uniform(-1.5, 1.5);
      return s;
    }
    case SourceKind::range: {
      RangeSample s;
      s.range_m = 200.0;
      if (normal(1.0) > 0.0) return s;  // to the beacon of the configuration
      const geo::Geodetic beacon = geo::moved_by(state.nav.position, normal.vector(200.0));
      s.beacon_latitude_rad = beacon.latitude_rad;
      s.beacon_longitude_rad = beacon.longitude_rad;
      s.beacon_depth_m = 18.0 - beacon.altitude_m;
      return s;
    }
    case SourceKind::fix: {
      FixSample s;
      const geo::Geodetic told = geo::moved_by(state.nav.position, normal.vector(50.0));
      s.latitude_rad = told.latitude_rad;
      s.longitude_rad = told.longitude_rad;
      s.sigma_m = 5.0;
      if (normal(1.0) > 0.0) s.depth_m = 12.0;
      return s;
    }
    case SourceKind::airspeed: {
      AirspeedSample s;
      s.airspeed_m_s = 25.0;
      s.baro_altitude_m = 300.0;
      if (normal(1.0) > 0.0) s.true_airspeed_m_s = 26.0;
      return s;
    }
    default: {
      PropulsionSample s;
      s.rpm = 1500.0;
      return s;
    }
  }
}

/// Rows of one registry entry at a state.
Observation rows(const AidingEntry& entry, const StateIndex& index, const FilterState& state,
                 const Vector3d& measured_rate, const Vector3d& measured_force, const SensorConfig& sensor,
                 const EventSample& sample) {
  const Vector3d rate = corrected_rate(index, state.x, measured_rate);
  const AidingState aiding(index, state, rate, 0.1, corrected_force(index, state.x, measured_force));
  Observation observation;
  VehicleModelConfig model;
  model.min_depth_m = 0.0;
  model.settle_s = 0.0;
  model.origin_B_m = {0.2, -0.1, 0.05};
  hydro::WaterVelocity water;
  water.begin({1.6, -0.2, 0.1});
  const bool modelled = entry.name == std::string_view(ModelVelocity::kName);
  EXPECT_EQ(entry.observe({aiding, sensor, 18.0, &model, modelled ? &water : nullptr}, sample, observation),
            Usable::yes)
      << entry.name;
  return observation;
}

/// H against central differences of the innovation on the manifold; the largest entry of H.
template <class Observe>
double expect_central_differences(const StateIndex& index, const FilterState& state, const char* name,
                                  const Observe& observe_at) {
  const Observation at = observe_at(state);
  EXPECT_GT(at.rows, 0) << name;
  double largest = 0.0;
  const auto of_group = [&index](Group group, int j) {
    return index.of(group) >= 0 && j >= index.of(group) && j < index.of(group) + group_size(group);
  };
  for (int j = 0; j < index.size(); ++j) {
    // Navigation errors are estimate minus truth, the others truth minus estimate: remove_error() knows.
    const double step = j < 6 ? 1e-3 : 1e-5;
    const Observation up = observe_at(perturbed(state, index, j, step));
    const Observation down = observe_at(perturbed(state, index, j, -step));
    for (std::size_t i = 0; i < static_cast<std::size_t>(at.rows); ++i) {
      const double slope = (up.innovation[i] - down.innovation[i]) / (2.0 * step);
      const double own = at.h[i][static_cast<std::size_t>(j)];
      // What the lever does with the frame's own rate is left out of H: micrometres per second.
      const double tolerance = 3e-4 * std::max(1.0, std::abs(slope));
      // So are scale and misalignment of the gyro, but as a whole: a column that is there has to be right.
      if (own == 0.0 && (of_group(Group::gyro_scale, j) || of_group(Group::gyro_misalignment, j))) continue;
      EXPECT_NEAR(own, slope, tolerance) << name << " row " << i << " " << index.name(j);
      largest = std::max(largest, std::abs(own));
    }
  }
  return largest;
}

class Jacobians : public ::testing::TestWithParam<int> {};

TEST_P(Jacobians, EqualCentralDifferencesOnTheManifold) {
  const AidingEntry& entry = aiding_registry()[static_cast<std::size_t>(GetParam())];
  const bool under_water =
      entry.source != SourceKind::airspeed && entry.name != std::string_view(ModelVelocity::kName);
  const StateIndex index(all_groups(under_water));
  Normal normal(100 + static_cast<std::uint64_t>(GetParam()));
  SensorConfig sensor = default_sensor(entry.source, "sensor");
  sensor.scale_m_s_per_rpm = 0.002;
  sensor.sideslip_sigma_rad = sensor.attack_sigma_rad = 0.05;
  sensor.baro_sigma_m = 1.0;
  sensor.use_beams = entry.name == std::string("dvl_beams");
  sensor.beam_azimuth_rad = {-2.2, 2.3, 0.8, -0.7};
  double largest = 0.0;
  for (int trial = 0; trial < 120; ++trial) {
    sensor.lever_B_m = geo::arr(normal.vector(1.0));
    sensor.mounting_rpy_rad =
        entry.source == SourceKind::dvl ? geo::arr(normal.vector(0.5)) : std::array<double, 3>{0.0, 0.0, 0.3};
    FilterState state = random_state(normal, index);
    if (entry.source == SourceKind::usbl || entry.source == SourceKind::range)
      state.nav.position.altitude_m = normal.uniform(-500.0, 0.0);
    // Near enough for the slopes of a direction to stand out.
    const bool polar = entry.name == std::string("usbl_range_bearing");
    const geo::Geodetic transceiver = geo::moved_by(state.nav.position, normal.vector(polar ? 20.0 : 200.0));
    sensor.transceiver_known = true;
    sensor.transceiver_latitude_rad = transceiver.latitude_rad;
    sensor.transceiver_longitude_rad = transceiver.longitude_rad;
    sensor.transceiver_depth_m = 18.0 - transceiver.altitude_m;
    // An aircraft flies.
    if (!under_water) state.nav.v_N_m_s += state.nav.v_N_m_s.normalized() * 20.0;
    sensor.two_antenna = entry.source == SourceKind::heading && trial % 4 == 0;
    const Vector3d rate = normal.vector(0.2);
    const Vector3d force = normal.vector(3.0) - Vector3d(0.0, 0.0, 9.8);
    const EventSample sample = sample_of(entry, state, normal);
    largest =
        std::max(largest, expect_central_differences(index, state, entry.name, [&](const FilterState& one) {
                   return rows(entry, index, one, rate, force, sensor, sample);
                 }));
  }
  EXPECT_GT(largest, 0.5);
}

/// Rows that come from no sample.
template <class Model, class... Config>
void expect_constraint_rows(const Config&... config) {
  const StateIndex index(all_groups(false));
  Normal normal(200);
  double largest = 0.0;
  for (int trial = 0; trial < 120; ++trial) {
    const FilterState state = random_state(normal, index);
    const Vector3d rate = normal.vector(0.5);
    const auto at = [&](const FilterState& one) {
      Observation out;
      observe(Model(AidingState(index, one, corrected_rate(index, one.x, rate), kUnknown), config...), index,
              out);
      return out;
    };
    largest = std::max(largest, expect_central_differences(index, state, Model::kName, at));
  }
  EXPECT_GT(largest, 0.5);
}

TEST(ConstraintJacobians, EqualCentralDifferencesOnTheManifold) {
  NonHolonomicConfig wheels;
  wheels.lever_B_m = {-1.1, 0.2, 0.6};
  wheels.mounting_rpy_rad = {0.05, -0.1, 0.3};
  expect_constraint_rows<NonHolonomic>(wheels);
  expect_constraint_rows<ConstantDepth>(0.1);
  expect_constraint_rows<ZeroVelocity>(0.02);
}

INSTANTIATE_TEST_SUITE_P(Registry, Jacobians, ::testing::Range(0, static_cast<int>(aiding_registry().size())),
                         [](const auto& info) {
                           return std::string(aiding_registry()[static_cast<std::size_t>(info.param)].name);
                         });

TEST(AidingRegistry, ASampleWithoutRoomForItsRowsIsOutOfRange) {
  const StateIndex index(all_groups(true));
  Normal normal(300);
  const FilterState state = random_state(normal, index);
  const AidingState aiding(index, state, Vector3d::Zero(), kUnknown);
  for (const AidingEntry& entry : aiding_registry()) {
    if (entry.source != SourceKind::gps) continue;
    const SensorConfig sensor = default_sensor(entry.source, "sensor");
    Observation full;
    full.rows = Observation::kMaxRows - 1;
    EXPECT_EQ(entry.observe({aiding, sensor, 18.0}, sample_of(entry, state, normal), full),
              Usable::out_of_range)
        << entry.name;
    EXPECT_EQ(full.rows, Observation::kMaxRows - 1) << entry.name;
  }
}

/// The models of one source share its rows, and each component that a verdict names is of one of them.
TEST(AidingRegistry, TheModelsOfASourceDoNotShareComponents) {
  const StateIndex index(all_groups(true));
  Normal normal(301);
  const FilterState state = random_state(normal, index);
  const AidingState aiding(index, state, Vector3d::Zero(), kUnknown, Vector3d(0.0, 0.0, -9.8));
  std::map<SourceKind, EventSample> samples;
  std::map<SourceKind, Observation> observations;
  for (const AidingEntry& entry : aiding_registry()) {
    SensorConfig sensor = default_sensor(entry.source, "sensor");
    sensor.scale_m_s_per_rpm = 0.002;
    sensor.sideslip_sigma_rad = sensor.attack_sigma_rad = 0.05;
    sensor.baro_sigma_m = 1.0;
    const EventSample& sample =
        samples.try_emplace(entry.source, sample_of(entry, state, normal)).first->second;
    Observation& all = observations[entry.source];
    const auto before = static_cast<std::size_t>(all.rows);
    (void)entry.observe({aiding, sensor, 18.0}, sample, all);
    for (std::size_t i = before; i < static_cast<std::size_t>(all.rows); ++i) {
      for (std::size_t j = 0; j < before; ++j)
        EXPECT_NE(all.component[i], all.component[j]) << entry.name << " needs kFirstComponent";
    }
  }
  EXPECT_GE(observations.at(SourceKind::gps).rows, 6);
  EXPECT_GE(observations.at(SourceKind::airspeed).rows, 3);
}

TEST(ErrorDynamics, PredictsHowAnErrorGrows) {
  // Two mechanisations a small error apart, fed with the same instrument: F and the columns of the inertial
  // errors must say how the difference develops.
  const StateIndex index(all_groups(true));
  Normal normal(5);
  for (int trial = 0; trial < 100; ++trial) {
    FilterState state = random_state(normal, index);
    state.nav.v_N_m_s *= 3.0;
    const Vector3d rate = normal.vector(0.05);
    const Vector3d force = normal.vector(3.0) - Vector3d(0.0, 0.0, 9.8);
    const auto advanced = [&](const FilterState& from, double dt) {
      Increments in;
      in.dt_s = dt;
      in.dtheta_rad = dt * corrected_rate(index, from.x, rate);
      in.dv_m_s = dt * corrected_force(index, from.x, force);
      return mechanise(from.nav, correct(in));
    };
    const auto error = [&](const NavSolution& estimate, const NavSolution& truth) {
      Eigen::Matrix<double, 9, 1> e;
      e.segment<3>(0) = geo::difference_N(truth.position, estimate.position);
      e.segment<3>(3) = estimate.v_N_m_s - truth.v_N_m_s;
      e.segment<3>(6) = geo::log(truth.q_NB * geo::conjugate(estimate.q_NB));
      return e;
    };
    const Vector3d rate_hat = corrected_rate(index, state.x, rate);
    const Vector3d force_hat = corrected_force(index, state.x, force);
    const Eigen::Matrix3d c = geo::to_matrix(state.nav.q_NB);
    const Matrix9 f = error_dynamics(state.nav, c * force_hat);
    const ImuColumns g = imu_error_columns(index, c, rate_hat, force_hat);
    constexpr double dt = 0.01;
    const NavSolution truth = advanced(state, dt);
    for (int j = 0; j < index.imu_end(); ++j) {
      const double step = j < 3 ? 30.0 : (j < 6 ? 0.1 : 1e-3);
      const FilterState other = perturbed(state, index, j, step);
      const FilterState opposite = perturbed(state, index, j, -step);
      const auto after =
          ((error(advanced(other, dt), truth) - error(advanced(opposite, dt), truth)) / (2.0 * step)).eval();
      for (int i = 0; i < 9; ++i) {
        const double rate_of_change = j < kNavStates ? f(i, j) : g(i, j - kNavStates);
        const double second = j < kNavStates ? (f * f)(i, j) : (f * g)(i, j - kNavStates);
        const double own = (i == j ? 1.0 : 0.0) + dt * rate_of_change + 0.5 * dt * dt * second;
        // Latitude resolves a nanometre; what turns within the step is of second order.
        const double resolution = (i < 3 ? 4e-9 : 1e-12) / step;
        const double turning = (j < 6 ? 3e-6 : 2.0) * dt * dt;
        EXPECT_NEAR(after(i), own, resolution + turning + 1e-2 * std::abs(own - (i == j ? 1.0 : 0.0)))
            << "row " << i << " " << index.name(j) << " trial " << trial;
      }
    }
  }
}

}  // namespace
}  // namespace fathom::estimation
