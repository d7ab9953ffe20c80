#pragma once

#include "estimation/hydro/vehicle_model.hpp"

namespace fathom::estimation::hydro {

/// The part of a vehicle model that predicts the velocity through the water where the turning is measured:
/// made once from the coefficients.
class VelocityModel {
 public:
  /// Precondition: coefficients.validate() is empty.
  explicit VelocityModel(const HydroCoefficients& coefficients);

  /// `V_B` after `dt_s` with the rate of turn, the direction of gravity and the controls held (HYD-3).
  [[nodiscard]] Eigen::Vector3d step(const Eigen::Vector3d& V_B_m_s,
                                     const Eigen::Vector3d& omega_before_B_rad_s,
                                     const Eigen::Vector3d& omega_B_rad_s, const Eigen::Vector3d& gamma_B,
                                     const Controls& controls, double dt_s) const;

 private:
  VehicleModel model_;
  Eigen::Matrix3d inverse_;  ///< of the mass matrix's force block
  Eigen::Matrix3d turning_;  ///< inverse_ times how the rates of turn add to the momentum
};

/// The velocity through the water as foretold by the vehicle's shape, propulsor and fins, and how well it has
/// been doing. A value: copied with the navigator.
class WaterVelocity {
 public:
  /// Starts from this velocity.
  void begin(const Eigen::Vector3d& V_B_m_s);
  void stop() { *this = WaterVelocity{}; }
  [[nodiscard]] bool running() const { return running_; }
  /// Since begin(): what was wrong at the start dies out as the hull's drag and lift have it.
  [[nodiscard]] double running_s() const { return running_s_; }

  void set_rpm(double rpm) {
    controls_.rpm = rpm;
    rpm_heard_ = true;
  }
  void set_fins(double rudder_rad, double stern_rad);
  [[nodiscard]] bool rpm_heard() const { return rpm_heard_; }

  /// Moves on by dt_s; without a begin() nothing happens.
  void advance(const VelocityModel& model, const Eigen::Vector3d& omega_B_rad_s,
               const Eigen::Vector3d& gamma_B, double dt_s);
  [[nodiscard]] const Eigen::Vector3d& V_B_m_s() const { return V_B_; }
  /// Since the last fin angles, infinite before the first.
  [[nodiscard]] double fins_age_s() const { return fins_age_s_; }
  /// Since measured() was last called, at most `longest_s`.
  [[nodiscard]] double unmeasured_s(double longest_s) const;
  void measured() { unmeasured_s_ = 0.0; }

  /// Takes note of a normalised squared innovation per component, one where all is as believed, while another
  /// instrument vouches for the velocity (HYD-4).
  void compare(double normalised, double memory_s);
  /// Mean normalised squared innovation, at least 1: what the model's noise is to be multiplied by.
  [[nodiscard]] double model_nis() const { return model_nis_ < 1.0 ? 1.0 : model_nis_; }
  /// How long the model has been compared.
  [[nodiscard]] double compared_s() const { return compared_s_; }

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  /// Faster than any vehicle: beyond it the model has come apart.
  static constexpr double kMost_m_s = 1e3;
  [[nodiscard]] static bool possible(const Eigen::Vector3d& V_B_m_s) {
    return (V_B_m_s.array().abs() <= kMost_m_s).all();  // false for NaN
  }

  bool running_ = false;
  double running_s_ = 0.0;
  bool rpm_heard_ = false;
  Eigen::Vector3d V_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_before_B_ = Eigen::Vector3d::Zero();
  Controls controls_;
  double fins_age_s_ = 1e9;
  double unmeasured_s_ = 1e9;
  double since_compared_s_ = 1e9;
  double compared_s_ = 0.0;
  double model_nis_ = 1.0;
};

}  // namespace fathom::estimation::hydro
