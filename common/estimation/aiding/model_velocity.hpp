#pragma once

#include "estimation/aiding/model.hpp"
#include "estimation/hydro/shaft_speed.hpp"
#include "estimation/hydro/water_velocity.hpp"
#include "samples/actuator.hpp"

namespace fathom::estimation {

/// Fins drive the vehicle model and have nothing of their own.
inline void set_defaults(SensorConfig& /*sensor*/, const FinsSample* /*kind*/) {}

/// Velocity through the water ahead and across as the vehicle's own dynamics predict it from shaft speed,
/// fins and turning: a virtual velocity log (AID-MOD-1..2). It errs by a share of itself and by a slow bias,
/// which are states, and by what changes within seconds, which is noise that lasts: R is multiplied by how
/// many samples come within its correlation time.
class ModelVelocity {
 public:
  using Sample = PropulsionSample;
  static constexpr const char* kName = "model_velocity";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (in.water == nullptr || in.vehicle_model == nullptr) return Usable::not_estimated;
    const Usable can = usable(in.state, *in.vehicle_model, *in.water, sample, in.surface_altitude_m);
    return can == Usable::yes ? append(ModelVelocity(in.state, *in.vehicle_model, *in.water), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& /*sample*/) {
    AidingPolicy policy;
    policy.velocity = VelocityOver::medium;
    return policy;
  }
  /// What it measures with is the vehicle model, not the sensor.
  [[nodiscard]] static bool may_aid(const SensorConfig& /*sensor*/) { return false; }

  ModelVelocity(const AidingState& s, const VehicleModelConfig& config, const hydro::WaterVelocity& water)
      : s_(s),
        config_(config),
        water_(water),
        lever_B_(geo::vec(config.origin_B_m)),
        through_N_(s.velocity_through_medium_N_m_s()) {}

  [[nodiscard]] static Usable usable(const AidingState& s, const VehicleModelConfig& config,
                                     const hydro::WaterVelocity& water, const PropulsionSample& sample,
                                     double surface_altitude_m) {
    if (!believable_rpm(sample.rpm) || !water.running()) return Usable::out_of_range;
    if (water.running_s() < config.settle_s) return Usable::out_of_range;
    const double depth =
        s.value(Group::surface_altitude, 0, surface_altitude_m) - s.state.nav.position.altitude_m;
    return config.min_depth_m <= 0.0 || depth >= config.min_depth_m ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 2; }
  [[nodiscard]] Vector3 measured() const {
    // (AID-MOD-1)
    const Vector3& V = water_.V_B_m_s();
    return {(1.0 + s_.value(Group::model_scale, 0)) * V.x() + s_.value(Group::model_bias, 0),
            (1.0 + s_.value(Group::model_scale, 1)) * V.y() + s_.value(Group::model_bias, 1), 0.0};
  }
  [[nodiscard]] Vector3 predicted() const {
    return s_.C_NB.transpose() * through_N_ + geo::cross(s_.rate_nb_B_rad_s, lever_B_);
  }
  void jacobian(Jacobian& h) const {
    // (AID-MOD-2)
    const Matrix3 to_B = s_.C_NB.transpose();
    h.block(Group::velocity, to_B.topRows<2>());
    h.block(Group::attitude, (-to_B * geo::skew(through_N_)).topRows<2>());
    h.block(Group::gyro_bias, (-geo::skew(lever_B_)).topRows<2>());
    h.block(Group::current, to_B.topLeftCorner<2, 2>());
    for (int i = 0; i < 2; ++i) {
      h.set(i, Group::model_scale, i, water_.V_B_m_s()(i));
      h.set(i, Group::model_bias, i, 1.0);
    }
  }
  /// Of one comparison by itself.
  [[nodiscard]] double sigma(int axis) const {
    // Without fin angles the side force of the fins is anybody's guess.
    const bool blind = axis == 1 && water_.fins_age_s() > config_.fins_timeout_s;
    return config_.sigma_m_s[static_cast<std::size_t>(axis)] * (blind ? 3.0 : 1.0);
  }
  [[nodiscard]] Vector3 noise() const {
    const double span = std::max(water_.unmeasured_s(config_.correlation_time_s), 1e-3);
    const double lasting = std::sqrt(config_.correlation_time_s / span * water_.model_nis());
    return {lasting * sigma(0), lasting * sigma(1), 0.0};
  }

 private:
  const AidingState& s_;
  const VehicleModelConfig& config_;
  const hydro::WaterVelocity& water_;
  Vector3 lever_B_;
  Vector3 through_N_;
};

}  // namespace fathom::estimation
