#pragma once

#include <string_view>
#include <vector>

#include "estimation/engine_config.hpp"
#include "sim/simulation.hpp"
#include "study/hydro/vehicles.hpp"

namespace fathom::study::hydro {

/// What a case changes.
struct Case {
  std::string_view name;
  double coefficient_share =
      0.0;                      ///< by which the estimators' coefficients are off, uniform, each of its own
  double current_m_s = 0.0;     ///< in a direction drawn once a run
  double tilt_sigma_deg = 1.0;  ///< of the roll and pitch handed over, each
  bool dvl_loss = false;        ///< from kLossFrom_s on
  bool straight = false;        ///< one heading all the way
  bool other_vehicle = false;   ///< the estimators believe in another vehicle
};

inline constexpr double kPublished_s = 199.0;  ///< length of the published run
inline constexpr double kLossFrom_s = 150.0;
inline constexpr double kLoss_s = 300.0;
inline constexpr double kHeadingSigma_deg = 1.5;
inline constexpr TimeNs kEpochNs = 1'700'000'000 * kNsPerSecond;

inline constexpr double kSpeed_m_s = 1.54;
inline constexpr double kDvl_hz = 10.0;
inline constexpr double kDvlSigma_m_s = 0.01;  ///< of one component along x and y, white
inline constexpr double kDvlScaleSigma = 0.003;

/// White noise of a DVL component that stands for its scale error where the scale is no state: over the
/// published run the position drifts by as much, sqrt(T f) scale v for a constant error against noise of f
/// samples a second. The white noise of the instrument is in it.
[[nodiscard]] double dvl_equivalent_sigma_m_s();

[[nodiscard]] double duration_s(const Case& one);

/// One run: what the instruments said in the order of arrival, what happened, and what the estimators are
/// told beforehand.
struct Run {
  std::vector<sim::Measurement> measurements;
  std::vector<Truth> truth;  ///< each second, the start included
  estimation::InitialState start;
  HydroCoefficients coefficients;
};

[[nodiscard]] Run make_run(const Case& one, std::uint64_t seed);

/// Error of a solution at one second.
struct ErrorPoint {
  double t_s = 0.0;
  double north_m = 0.0;
  double east_m = 0.0;
  double nees = kUnknown;  ///< of the horizontal position, two degrees of freedom
};

}  // namespace fathom::study::hydro
