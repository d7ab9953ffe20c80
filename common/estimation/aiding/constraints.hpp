#pragma once

#include "estimation/aiding/model.hpp"
#include "estimation/aiding/non_holonomic.hpp"

namespace fathom::estimation {

/// The vehicle keeps its depth: the velocity down is zero (AID-LEVEL-1). Holds in the mean, so its sigma is
/// that of the heave.
class ConstantDepth {
 public:
  static constexpr const char* kName = "constant_depth";

  ConstantDepth(const AidingState& s, double sigma_m_s) : s_(s), sigma_m_s_(sigma_m_s) {}
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const { return Vector3::Zero(); }
  [[nodiscard]] Vector3 predicted() const { return {s_.state.nav.v_N_m_s.z(), 0.0, 0.0}; }
  void jacobian(Jacobian& h) const { h.set(0, Group::velocity, 2, 1.0); }
  [[nodiscard]] Vector3 noise() const { return {sigma_m_s_, 0.0, 0.0}; }

 private:
  const AidingState& s_;
  double sigma_m_s_;
};

/// What is known of the motion without an instrument, as configured. `visit` is given how often each holds
/// (Hz) and a function that makes its model from the state of an instant.
template <class Visit>
void for_each_constraint(const ConstraintsConfig& config, Visit&& visit) {
  if (config.non_holonomic.enabled)
    visit(config.non_holonomic.rate_hz,
          [&](const AidingState& state) { return NonHolonomic(state, config.non_holonomic); });
  if (config.constant_depth.enabled)
    visit(config.constant_depth.rate_hz,
          [&](const AidingState& state) { return ConstantDepth(state, config.constant_depth.sigma_m_s); });
}

}  // namespace fathom::estimation
