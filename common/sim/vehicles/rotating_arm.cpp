#include <algorithm>

#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

class RotatingArm final : public Vehicle {
 public:
  explicit RotatingArm(const RotatingArmConfig& config) : config_(config) {}

  void control(const BodyState&, const Order& order, double) override { speed_m_s_ = order.speed_m_s; }

  [[nodiscard]] BodyRates dynamics(const BodyState& state) const override {
    // The axle fixes the turn rate to speed / radius: both grow together.
    const double acceleration = std::clamp(0.5 * (speed_m_s_ - state.V_B_m_s.x()), -config_.acceleration_m_s2,
                                           config_.acceleration_m_s2);
    BodyRates rates;
    rates.V_dot_B_m_s2.x() = acceleration;
    rates.omega_dot_B_rad_s2.z() = acceleration / config_.radius_m;
    return rates;
  }

 private:
  RotatingArmConfig config_;
  double speed_m_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Vehicle> make_rotating_arm(const RotatingArmConfig& config) {
  return std::make_unique<RotatingArm>(config);
}

}  // namespace fathom::sim
