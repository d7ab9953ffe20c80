
#include "base/units.hpp"
#include "config/scenario/scenario_schema.hpp"

namespace fathom::config {
namespace {

// Fins, shaft and what the autopilot orders of them: the same fields in every vehicle that has them.
template <class C>
void describe_steering(Schema<C>& s) {
  s.field("fin_limit_deg", &C::fin_limit_rad, "largest fin angle")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(1, 60);
  s.field("fin_tau_s", &C::fin_tau_s, "time constant of the fins").unit("s").range(0.02, 5);
  s.field("propulsor_tau_s", &C::propulsor_tau_s, "time constant of the shaft speed")
      .unit("s")
      .range(0.02, 30);
  s.field("maximum_pitch_deg", &C::maximum_pitch_rad, "ordered at most")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(1, 60);
  s.field("maximum_turn_rate_deg_s", &C::maximum_turn_rate_rad_s, "ordered at most")
      .unit("deg/s")
      .scaled(kRadPerDeg)
      .range(0.1, 60);
}
}  // namespace

void describe(Schema<sim::AuvConfig>& s) {
  using C = sim::AuvConfig;
  s.field("speed_per_rpm", &C::speed_per_rpm, "steady speed through the water per rpm")
      .unit("m/s")
      .range(1e-5, 1);
  s.field("surge_drag_1_m", &C::surge_drag_1_m, "deceleration = this times speed squared")
      .unit("1/m")
      .range(1e-4, 10);
  s.field("sway_length_m", &C::sway_length_m, "distance of one time constant of the side-slip")
      .unit("m")
      .range(0.1, 100);
  s.field("turn_slip_m", &C::turn_slip_m, "side-slip velocity per turn rate").unit("m").range(0, 10);
  s.field("heave_length_m", &C::heave_length_m, "distance of one time constant of the heave")
      .unit("m")
      .range(0.1, 100);
  s.field("yaw_length_m", &C::yaw_length_m, "distance of one time constant of the turn rate")
      .unit("m")
      .range(0.1, 100);
  s.field("pitch_length_m", &C::pitch_length_m, "distance of one time constant of the pitch rate")
      .unit("m")
      .range(0.1, 100);
  s.field("rudder_1_m", &C::rudder_1_m, "steady turn rate per speed and rudder angle")
      .unit("1/m")
      .range(0.01, 10);
  s.field("stern_1_m", &C::stern_1_m, "steady pitch rate per speed and stern plane angle")
      .unit("1/m")
      .range(0.01, 10);
  s.field("righting_1_s2", &C::righting_1_s2, "pitch stiffness of the low centre of gravity")
      .unit("1/s^2")
      .range(0, 10);
  s.field("roll_frequency_rad_s", &C::roll_frequency_rad_s, "natural frequency in roll")
      .unit("rad/s")
      .range(0.1, 20);
  s.field("roll_damping", &C::roll_damping, "damping ratio in roll").range(0.01, 2);
  s.field("roll_per_turn_s_m", &C::roll_per_turn_s_m, "heel per side acceleration")
      .unit("rad s^2/m")
      .range(-1, 1);
  s.field("buoyancy_ratio", &C::buoyancy_ratio, "displacement over weight").range(1.0001, 1.1);
  s.field("hull_diameter_m", &C::hull_diameter_m, "of the hull").unit("m").range(0.05, 5);
  describe_steering(s);
}

void describe(Schema<sim::AirDropConfig>& s) {
  using C = sim::AirDropConfig;
  s.field("coefficient_sigma", &C::coefficient_sigma,
          "1 sigma of the factor of each coefficient of the hull, drawn once a run")
      .range(0, 0.3);
  s.field("parachute_at_s", &C::parachute_at_s, "after release").unit("s").range(0, 60);
  s.field("terminal_speed_m_s", &C::terminal_speed_m_s, "under the parachute").unit("m/s").range(5, 200);
  s.field("mass_kg", &C::mass_kg, "of the vehicle").unit("kg").range(1, 1e5);
  s.field("buoyancy_kg", &C::buoyancy_kg, "of the water displaced").unit("kg").range(1, 1e5);
  s.field("added_surge_kg", &C::added_surge_kg, "added mass ahead").unit("kg").range(0, 1e5);
  s.field("added_sway_kg", &C::added_sway_kg, "added mass across").unit("kg").range(0, 1e5);
  s.field("inertia_roll_kg_m2", &C::inertia_roll_kg_m2, "about x").unit("kg m^2").range(0.01, 1e5);
  s.field("inertia_pitch_kg_m2", &C::inertia_pitch_kg_m2, "about y and z, with added mass")
      .unit("kg m^2")
      .range(0.1, 1e6);
  s.field("drag_coefficient", &C::drag_coefficient, "on the frontal area").range(0.001, 10);
  s.field("frontal_area_m2", &C::frontal_area_m2, "of the hull").unit("m^2").range(1e-4, 100);
  s.field("tail_lift_kg_m", &C::tail_lift_kg_m, "force per speed and cross flow at the tail")
      .unit("kg/m")
      .range(0, 1e5);
  s.field("body_lift_kg_m", &C::body_lift_kg_m, "force per speed and cross flow").unit("kg/m").range(0, 1e5);
  s.field("fin_lift_kg_m", &C::fin_lift_kg_m, "force per speed squared and fin angle")
      .unit("kg/m")
      .range(0, 1e5);
  s.field("munk_kg", &C::munk_kg, "destabilising moment per speed and cross flow").unit("kg").range(0, 1e5);
  s.field("tail_x_m", &C::tail_x_m, "place of the tail").unit("m").range(-20, 0);
  s.field("length_m", &C::length_m, "over which the vehicle enters the water").unit("m").range(0.2, 50);
  s.field("speed_per_rpm", &C::speed_per_rpm, "speed through the water per rpm").unit("m/s").range(1e-5, 1);
  s.field("dive_pitch_deg", &C::dive_pitch_rad, "of the dive after water entry")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-80, -1);
  s.field("limited_pitch_deg", &C::limited_pitch_rad, "largest pitch ordered near the set depth")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0.5, 45);
  s.field("limited_range_m", &C::limited_range_m, "what near means").unit("m").range(0.5, 100);
  s.field("pitch_slew_deg_s", &C::pitch_slew_rad_s, "of the pitch ordered after water entry")
      .unit("deg/s")
      .range(0.5, 200)
      .scaled(kRadPerDeg);
  s.field("flare_slew_deg_s", &C::flare_slew_rad_s, "of the pitch ordered from the flare on")
      .unit("deg/s")
      .range(0.5, 200)
      .scaled(kRadPerDeg);
  s.field("flare_s", &C::flare_s, "the flare starts at this depth error per sink rate")
      .unit("s")
      .range(0, 20);
  s.field("propulsor_delay_s", &C::propulsor_delay_s, "from water entry").unit("s").range(0, 20);
}

void describe(Schema<sim::AircraftConfig>& s) {
  using C = sim::AircraftConfig;
  s.field("roll_frequency_rad_s", &C::roll_frequency_rad_s, "how fast an ordered bank is taken")
      .unit("rad/s")
      .range(0.1, 10);
  s.field("pitch_frequency_rad_s", &C::pitch_frequency_rad_s, "how fast an ordered pitch is taken")
      .unit("rad/s")
      .range(0.1, 10);
  s.field("rate_tau_s", &C::rate_tau_s, "time constant of the body rates").unit("s").range(0.05, 5);
  s.field("speed_tau_s", &C::speed_tau_s, "time constant of the airspeed").unit("s").range(0.2, 60);
  s.field("slip_tau_s", &C::slip_tau_s, "time constant of side-slip and angle of attack")
      .unit("s")
      .range(0.1, 10);
  s.field("angle_of_attack_deg", &C::angle_of_attack_rad, "in level flight")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 15);
  s.field("maximum_climb_deg", &C::maximum_climb_rad, "of the path")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(1, 45);
  s.field("maximum_bank_deg", &C::maximum_bank_rad, "when turning to a heading")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(1, 60);
  s.field("dutch_roll_period_s", &C::dutch_roll_period_s, "of an ordered Dutch roll").unit("s").range(1, 30);
}

void describe(Schema<sim::RotatingArmConfig>& s) {
  s.field("radius_m", &sim::RotatingArmConfig::radius_m, "of the circle").unit("m").range(0.1, 1000);
  s.field("acceleration_m_s2", &sim::RotatingArmConfig::acceleration_m_s2, "along the circle")
      .unit("m/s^2")
      .range(0.001, 50);
}

void describe(Schema<sim::RemusBeyondModel>& s) {
  using C = sim::RemusBeyondModel;
  s.field("linear_damping_share", &C::linear_damping_share,
          "of the quadratic drag ahead and lift across at cruise, added linearly")
      .range(0, 1);
  s.field("cross_flow_share", &C::cross_flow_share,
          "of the cross-flow drag: coupling by the speed of the whole flow")
      .range(0, 1);
  s.field("thrust_lag_s", &C::thrust_lag_s, "of the thrust behind the shaft speed").unit("s").range(0, 10);
  s.field("trim_moment_sigma_N_m", &C::trim_moment_sigma_N_m,
          "1 sigma of a constant pitch and yaw moment, drawn once a run")
      .unit("N m")
      .range(0, 10);
}

void describe(Schema<sim::RemusConfig>& s) {
  using C = sim::RemusConfig;
  describe_steering(s);
  s.field("coefficient_share", &C::coefficient_share,
          "each hydrodynamic coefficient is off by up to this share, drawn once a run")
      .range(0, 0.5);
  s.field("beyond", &C::beyond, "what the hull does beyond the model that estimators are given");
  s.field("hull_diameter_m", &C::hull_diameter_m, "over which the vehicle floats up")
      .unit("m")
      .range(0.05, 5);
}

void describe(Schema<sim::VehicleConfig>& s) {
  using C = sim::VehicleConfig;
  using Kind = C::Kind;
  s.field("kind", &C::kind, "what moves")
      .words({{"auv", Kind::auv},
              {"air_drop", Kind::air_drop},
              {"aircraft", Kind::aircraft},
              {"rotating_arm", Kind::rotating_arm},
              {"remus", Kind::remus}})
      .required();
  s.field("auv", &C::auv, "torpedo-shaped vehicle with propulsor and fins");
  s.field("air_drop", &C::air_drop, "vehicle dropped from an aircraft");
  s.field("aircraft", &C::aircraft, "light aircraft");
  s.field("rotating_arm", &C::rotating_arm, "carriage on a rotating arm");
  s.field("remus", &C::remus, "REMUS 100 in six degrees of freedom");
}

}  // namespace fathom::config
