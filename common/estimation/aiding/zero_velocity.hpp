#pragma once

#include "estimation/aiding/model.hpp"

namespace fathom::estimation {

/// The vehicle does not move relative to the Earth, because somebody said so (AID-ZUPT-1).
class ZeroVelocity {
 public:
  static constexpr const char* kName = "zero_velocity";

  ZeroVelocity(const AidingState& s, double sigma_m_s) : s_(s), sigma_m_s_(sigma_m_s) {}
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return Vector3::Zero(); }
  [[nodiscard]] Vector3 predicted() const { return s_.state.nav.v_N_m_s; }
  void jacobian(Jacobian& h) const { h.block(Group::velocity, Matrix3::Identity()); }
  [[nodiscard]] Vector3 noise() const { return Vector3::Constant(sigma_m_s_); }

 private:
  const AidingState& s_;
  double sigma_m_s_;
};

}  // namespace fathom::estimation
