#pragma once

#include <optional>

#include "estimation/engine_config.hpp"
#include "samples/dvl.hpp"
#include "study/baselines/slaved_navigator.hpp"
#include "study/baselines/ukf.hpp"

namespace fathom::study::hydro {

using estimation::SensorConfig;
using estimation::StateIndex;
using estimation::hydro::HydroCoefficients;

inline constexpr int kPrintedStates = kEmbeddedStates;
/// The printed ones, remaining gyro bias (truth - estimate, B) and current north, east.
inline constexpr int kLinkedStates = kEmbeddedStates + 5;

/// Standard deviations; process noise per step of 0.1 s as in the publication.
struct EmbeddedFilterConfig {
  UkfTuning tuning;
  double position_m = 0.1;
  double velocity_m_s = 0.05;
  double tilt_rad = 0.0175;
  double heading_rad = 0.0262;
  double dvl_m_s = 0.012;
  // Of the linked form.
  double gyro_bias_rad_s = 4.85e-6;
  double gyro_rad_s = 1e-3;  ///< of the rate as a measurement, vibration included
  double link_m_s = 0.02;    ///< of the identity between the two velocities
  double current_m_s = 0.3;
  double current_walk_m_s = 3e-4;  ///< per step
  double motion_m_s = 0.01;        ///< process noise of V per step: what the coefficients do not tell
};

/// The hydrodynamics-embedded filter (HYD-UKF-1..3) of N states about its own navigator. kPrintedStates: as
/// published, measuring V by the DVL and nothing else; V and the navigator's velocity are strangers.
/// kLinkedStates: the DVL by the engine's own measurement model, the gyro as a measurement of omega, and the
/// link 0 = C'(v - c) - V.
template <int N>
class EmbeddedFilter {
 public:
  static constexpr double kStep_s = 0.1;
  using State = Eigen::Matrix<double, N, 1>;

  /// Precondition: coefficients.validate() is empty.
  EmbeddedFilter(const HydroCoefficients& coefficients, const EmbeddedFilterConfig& config);

  /// Starts at this state, under way ahead as fast as the propulsor drives.
  void start(const NavSolution& nav, double surface_altitude_m);
  /// One inertial interval.
  void advance(const Eigen::Vector3d& dtheta_rad, const Eigen::Vector3d& dv_m_s, double dt_s) {
    navigator_.advance(dtheta_rad, dv_m_s, dt_s);
  }
  void slave(double depth_m, double dt_s) { navigator_.slave(depth_m, dt_s); }
  /// One filter step of kStep_s, at its end the DVL where there was one; what is found goes back into the
  /// navigator.
  void step(const Controls& controls, const std::optional<DvlSample>& dvl);

  [[nodiscard]] const NavSolution& nav() const { return navigator_.nav(); }
  [[nodiscard]] const Ukf<N>& filter() const { return filter_; }

 private:
  void measure_dvl(const DvlSample& dvl);
  void measure_gyro();
  void link();
  void feed_back();

  EmbeddedFilterConfig config_;
  VehicleModel model_;
  SensorConfig dvl_;
  StateIndex index_;
  SlavedNavigator navigator_;
  Ukf<N> filter_;
  typename Ukf<N>::Matrix noise_;
};

extern template class EmbeddedFilter<kPrintedStates>;
extern template class EmbeddedFilter<kLinkedStates>;

}  // namespace fathom::study::hydro
