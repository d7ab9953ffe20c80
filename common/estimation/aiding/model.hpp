#pragma once

#include <cmath>

#include "estimation/aiding/policy.hpp"
#include "estimation/engine_config.hpp"
#include "estimation/filter/nav_solution.hpp"
#include "estimation/filter/observation.hpp"

namespace fathom::estimation {

namespace hydro {
class WaterVelocity;
}

/// What an aiding model may look at. Models never see the filter.
struct AidingState {
  const StateIndex& index;
  const FilterState& state;
  Eigen::Matrix3d C_NB;
  Eigen::Vector3d rate_nb_B_rad_s;  ///< of B relative to N, bias-corrected
  double variation_rad;             ///< magnetic variation of the configuration, NaN when unknown
  Eigen::Vector3d force_B_m_s2;     ///< specific force, bias-corrected

  AidingState(const StateIndex& states, const FilterState& filter, const Eigen::Vector3d& rate_ib_B_rad_s,
              double magnetic_variation_rad,
              const Eigen::Vector3d& specific_force_B_m_s2 = Eigen::Vector3d::Zero())
      : index(states),
        state(filter),
        C_NB(geo::to_matrix(filter.nav.q_NB)),
        rate_nb_B_rad_s(rate_ib_B_rad_s - C_NB.transpose() * rate_in_N_rad_s(filter.nav)),
        variation_rad(magnetic_variation_rad),
        force_B_m_s2(specific_force_B_m_s2) {}

  /// Of N relative to inertial space.
  [[nodiscard]] static Eigen::Vector3d rate_in_N_rad_s(const NavSolution& nav) {
    const geo::LocalEarth earth(nav.position);
    return earth.earth_rate_N + earth.transport_rate_N(nav.v_N_m_s);
  }
  /// Value of the states of a group, `fallback` where the group is not estimated.
  [[nodiscard]] double value(Group group, int component, double fallback = 0.0) const {
    const int start = index.of(group);
    return start < 0 ? fallback : state.x[static_cast<std::size_t>(start + component)];
  }
  [[nodiscard]] Eigen::Vector3d value3(Group group) const {
    return {value(group, 0), value(group, 1), value(group, 2)};
  }
  /// Velocity relative to water or air whose horizontal motion is the `current` state; over ground where that
  /// is not estimated.
  [[nodiscard]] Eigen::Vector3d velocity_through_medium_N_m_s() const {
    return state.nav.v_N_m_s - Eigen::Vector3d(value(Group::current, 0), value(Group::current, 1), 0.0);
  }
  /// Of the velocity relative to the Earth, along N.
  [[nodiscard]] Eigen::Vector3d acceleration_N_m_s2() const {
    const NavSolution& nav = state.nav;
    const geo::LocalEarth earth(nav.position);
    const Eigen::Vector3d turning = 2.0 * earth.earth_rate_N + earth.transport_rate_N(nav.v_N_m_s);
    return C_NB * force_B_m_s2 + earth.gravity_N() - geo::cross(turning, nav.v_N_m_s);
  }
};

/// What a model can do with a sample.
enum class Usable : std::uint8_t {
  yes,
  out_of_range,
  no_fix,
  unknown_frame,
  not_estimated,
  other_model,  ///< the sample is for another model of its source: says nothing against it
};

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// Rows of H of one model, addressed by state group; groups that are not estimated are left out.
class Jacobian {
 public:
  Jacobian(const StateIndex& index, Observation& observation, int first_row)
      : index_(index), observation_(observation), first_row_(first_row) {}

  void set(int row, Group group, int component, double value) {
    const int start = index_.of(group);
    if (start < 0) return;
    observation_.h[static_cast<std::size_t>(first_row_ + row)][static_cast<std::size_t>(start + component)] =
        value;
  }
  /// All rows of a model, from its first one and the group's first state on.
  template <class Derived>
  void block(Group group, const Eigen::MatrixBase<Derived>& values) {
    for (int i = 0; i < values.rows(); ++i)
      for (int j = 0; j < values.cols(); ++j) set(i, group, j, values(i, j));
  }

 private:
  const StateIndex& index_;
  Observation& observation_;
  int first_row_;
};

/// Takes the three rows of a vector model block by block and passes on what is seen along `along`.
template <int Rows>
struct ProjectedRows {
  Jacobian& h;
  const Eigen::Matrix<double, Rows, 3>& along;
  template <class Derived>
  void block(Group group, const Eigen::MatrixBase<Derived>& values) {
    h.block(group, along * values);
  }
};

/// All that an aiding model is given beside the sample.
struct AidingInput {
  const AidingState& state;
  const SensorConfig& sensor;
  double surface_altitude_m;  ///< used where it is not estimated
  const VehicleModelConfig* vehicle_model = nullptr;
  const hydro::WaterVelocity* water = nullptr;  ///< what the vehicle model predicts, where it is switched on
  double unused_s = kUnknown;                   ///< since the last measurement of this sensor that was used
  int beacon = 0;                               ///< which of those heard so far, where it is one
  /// Of the position of the IMU, for rows that are not straight within it.
  Matrix3 position_covariance_N_m2 = Matrix3::Zero();
  std::array<double, 3> gps_bias_sigma_N_m{};  ///< of the slow error of GPS; 0 where there is no state of it
};

/// What an instrument states of noise and slow error in one.
struct StatedError {
  double variance = 0.0;  ///< 0: nothing
  Group slow = Group::position;
  int component = 0;  ///< of the group
};

/// Appends the components of a model that are known to an observation, of which all models of one source
/// together have at most Observation::kMaxRows. A model offers
///   int dimension() const
///   Vector3 measured() const, predicted() const, noise() const    (noise: sigmas; longer vectors likewise)
///   void jacobian(Jacobian&) const                                 d(predicted - measured)/dx
///   double wrapped(double) const      only where the innovation is an angle
///   StatedError stated(int) const     only where noise and slow error are stated in one
///   static constexpr int kFirstComponent      only where another model of its source has those before
/// and to the registry
///   using Sample
///   static Usable append_rows(const AidingInput&, const Sample&, Observation&)
///   static constexpr const char* kName                            the word in the bench and in tests
///   static AidingPolicy policy(const SensorConfig&, const Sample&)
///   static bool may_aid(const SensorConfig&)          only where a configuration may switch it off for good
template <class Model>
void observe(const Model& model, const StateIndex& index, Observation& out) {
  const int first = out.rows;
  Jacobian rows(index, out, first);
  model.jacobian(rows);
  const auto measured = model.measured();
  const auto predicted = model.predicted();
  const auto sigma = model.noise();
  int first_component = 0;
  if constexpr (requires { Model::kFirstComponent; }) first_component = Model::kFirstComponent;
  for (int i = 0; i < model.dimension(); ++i) {
    double z = predicted(i) - measured(i);
    if constexpr (requires { model.wrapped(z); }) z = model.wrapped(z);
    const auto from = static_cast<std::size_t>(first + i);
    const auto to = static_cast<std::size_t>(out.rows);
    if (!std::isfinite(z)) {
      out.h[from].fill(0.0);
      continue;
    }
    if (from != to) {
      out.h[to] = out.h[from];
      out.h[from].fill(0.0);
    }
    out.innovation[to] = z;
    out.sigma[to] = sigma(i);
    if constexpr (requires { model.stated(i); }) {
      const StatedError stated = model.stated(i);
      const int slow = index.of(stated.slow);
      out.stated[to] = slow < 0 ? 0.0 : stated.variance;
      out.slow_state[to] = static_cast<std::uint8_t>(slow < 0 ? 0 : slow + stated.component);
    }
    out.component[to] = static_cast<std::uint8_t>(first_component + i);
    ++out.rows;
  }
}

/// Appends the model's rows; a sample none of whose components is finite is out of range, and so is one for
/// whose rows the models of its source before have left no room.
template <class Model>
[[nodiscard]] Usable append(const Model& model, const AidingInput& in, Observation& out) {
  const int before = out.rows;
  if (before + model.dimension() > Observation::kMaxRows) return Usable::out_of_range;
  observe(model, in.state.index, out);
  return out.rows > before ? Usable::yes : Usable::out_of_range;
}

/// Whether a sample's place is one, as far as its angles say; unknown ones are none.
[[nodiscard]] inline bool is_on_earth(double latitude_rad, double longitude_rad) {
  return std::abs(latitude_rad) <= 1.5707963267948966 && std::abs(longitude_rad) <= 6.2831853071795865;
}

/// The sigma that the sample carries, else the configured one.
[[nodiscard]] inline double stated_sigma(double configured, double reported, bool use_reported) {
  return use_reported && known(reported) ? reported : configured;
}

/// The larger of the configured sigma and the one the sample carries.
[[nodiscard]] inline double sigma_of(double configured, double reported, bool use_reported) {
  return use_reported && std::isfinite(reported) && reported > configured ? reported : configured;
}

}  // namespace fathom::estimation
