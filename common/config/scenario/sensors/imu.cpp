#include "base/units.hpp"
#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

void describe(Schema<sim::GyroConfig>& s) {
  using T = sim::TriadConfig;
  const auto field = [&s](const char* key, double T::*member, const char* text) -> FieldRef<double> {
    return s.field(key, static_cast<double sim::GyroConfig::*>(member), text);
  };
  field("bias_sigma_deg_h", &T::bias_sigma, "turn-on bias, drawn once a run")
      .unit("deg/h")
      .scaled(kDegPerHour_rad_s)
      .range(0, 1e5);
  field("instability_sigma_deg_h", &T::instability_sigma, "in-run bias, Gauss-Markov")
      .unit("deg/h")
      .scaled(kDegPerHour_rad_s)
      .range(0, 1e5);
  field("instability_tau_s", &T::instability_tau_s, "its correlation time").unit("s").range(0.1, 1e6);
  field("random_walk_deg_sqrt_h", &T::random_walk, "white noise")
      .unit("deg/sqrt(h)")
      .scaled(kRadPerDeg / 60.0)
      .range(0, 100);
  field("vibration_deg_s", &T::vibration_sigma, "white noise of each sample")
      .unit("deg/s")
      .scaled(kRadPerDeg)
      .range(0, 100);
  field("scale_ppm", &T::scale_sigma, "scale error of each axis").unit("ppm").scaled(1e-6).range(0, 1e5);
  field("misalignment_mrad", &T::misalignment_sigma_rad, "each cross term")
      .unit("mrad")
      .scaled(1e-3)
      .range(0, 100);
  field("quantum_rad", &T::quantum, "of an increment (of a rate where only rates are given)")
      .unit("rad")
      .range(0, 1);
  field("range_deg_s", &T::range, "clip; 0: none").unit("deg/s").scaled(kRadPerDeg).range(0, 1e5);
}

void describe(Schema<sim::AccelerometerConfig>& s) {
  using T = sim::TriadConfig;
  const auto field = [&s](const char* key, double T::*member, const char* text) -> FieldRef<double> {
    return s.field(key, static_cast<double sim::AccelerometerConfig::*>(member), text);
  };
  field("bias_sigma_mg", &T::bias_sigma, "turn-on bias, drawn once a run")
      .unit("mg")
      .scaled(kMilliG_m_s2)
      .range(0, 1e4);
  field("instability_sigma_mg", &T::instability_sigma, "in-run bias, Gauss-Markov")
      .unit("mg")
      .scaled(kMilliG_m_s2)
      .range(0, 1e4);
  field("instability_tau_s", &T::instability_tau_s, "its correlation time").unit("s").range(0.1, 1e6);
  field("random_walk_m_s_sqrt_h", &T::random_walk, "white noise")
      .unit("m/s/sqrt(h)")
      .scaled(kPerSqrtHour_per_sqrt_s)
      .range(0, 100);
  field("vibration_mg", &T::vibration_sigma, "white noise of each sample")
      .unit("mg")
      .scaled(kMilliG_m_s2)
      .range(0, 1e4);
  field("scale_ppm", &T::scale_sigma, "scale error of each axis").unit("ppm").scaled(1e-6).range(0, 1e5);
  field("misalignment_mrad", &T::misalignment_sigma_rad, "each cross term")
      .unit("mrad")
      .scaled(1e-3)
      .range(0, 100);
  field("quantum_m_s", &T::quantum, "of an increment (of m/s^2 where only rates are given)")
      .unit("m/s")
      .range(0, 10);
  field("range_g", &T::range, "clip; 0: none").unit("g").scaled(kStandardGravity_m_s2).range(0, 1e5);
}

template <>
void describe(Schema<sim::SimulatedSensor<ImuSample>>& s) {
  common_fields(s);
  s.field("mounting_rpy_deg", &sim::ImuConfig::mounting_rpy_rad, "attitude of the unit's axes in the body")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-180, 180);
  s.field("gyro", &sim::ImuConfig::gyro, "error model of the gyros");
  s.field("accelerometer", &sim::ImuConfig::accelerometer, "error model of the accelerometers");
  s.field("increments", &sim::ImuConfig::increments,
          "true: increments over the interval and their mean rates; false: rates at the instant");
}

}  // namespace fathom::config
