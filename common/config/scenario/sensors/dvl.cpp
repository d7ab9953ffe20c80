#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<DvlSample>>& s) {
  using C = sim::DvlConfig;
  using Frame = C::Frame;
  common_fields(s);
  s.field("beam_angle_deg", &C::beam_angle_rad, "of the beams from the instrument's down axis")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(5, 60);
  s.field("beam_sigma_m_s", &C::beam_sigma_m_s, "white error of each beam").unit("m/s").range(0, 10);
  s.field("beam_sigma_per_speed", &C::beam_sigma_per_speed, "and this share of the speed").range(0, 1);
  s.field("scale_sigma", &C::scale_sigma, "scale error, drawn once a run").range(0, 0.5);
  s.field("scale", &C::scale, "known part of it").range(-0.5, 0.5);
  s.field("bias_sigma_m_s", &C::bias_sigma_m_s, "offset of each axis, drawn once a run")
      .unit("m/s")
      .range(0, 10);
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad, "attitude of the instrument's axes in the body")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-180, 180);
  s.field("misalignment_sigma_deg", &C::misalignment_sigma_rad, "error of that, each axis, drawn once a run")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 20);
  s.field("minimum_range_m", &C::minimum_range_m, "height above the bottom").unit("m").range(0, 1e3);
  s.field("maximum_range_m", &C::maximum_range_m, "along a beam").unit("m").range(1, 1e4);
  s.field("beam_dropout_probability", &C::beam_dropout_probability, "each beam of each ping").range(0, 1);
  s.field("working_beams", &C::working_beams, "3: the one astern is dead, 2: the one to starboard as well")
      .range(2, 4);
  s.field("water_track", &C::water_track, "pings that do not reach the bottom measure against the water");
  s.field("water_layer", &C::water_layer, "each ping measures against the water layer as well");
  s.field("bottom_lost", &C::bottom_lost, "when the bottom gives no echo; the water layer does");
  s.field("outlier_m_s", &C::outlier_m_s, "size of a wrong velocity").unit("m/s").range(0, 100);
  s.field("sound_speed_m_s", &C::sound_speed_m_s, "that the instrument uses").unit("m/s").range(1300, 1700);
  s.field("frame", &C::frame, "of the recorded velocities")
      .words({{"instrument", Frame::instrument}, {"ship", Frame::ship}, {"beam", Frame::beam}});
}

}  // namespace fathom::config
