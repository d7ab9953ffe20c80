#pragma once

#include "archive/values.hpp"
#include "estimation/navigator/plausibility/plausibility.hpp"

/// Fields of what is held against each other.
namespace fathom::estimation {

template <class Archive, class Self>
void PairFit::fields(Archive& archive, Self& self) {
  archive("count", self.count_, fathom::archive::at_least_zero());
  archive("expected", self.expected_, fathom::archive::at_least_zero());
  archive("aa", self.aa_, fathom::archive::finite());
  archive("ba", self.ba_, fathom::archive::finite());
  archive("bb", self.bb_, fathom::archive::at_least_zero());
}

template <class Archive, class Self>
void AxesFit::fields(Archive& archive, Self& self) {
  archive("has_before", self.has_before_);
  archive("down_before", self.down_before_, fathom::archive::finite());
  archive("turn_rad", self.turn_rad_, fathom::archive::finite());
  archive("lasted_s", self.lasted_s_, fathom::archive::at_least_zero());
  archive("speed_before_m_s", self.before_.speed_m_s, fathom::archive::finite());
  archive("count", self.count_, fathom::archive::at_least_zero());
  archive("configured", self.configured_, fathom::archive::at_least_zero());
  archive("left", self.left_, fathom::archive::at_least_zero());
  if (!archive.since(21)) return;
  archive("acceleration_before_N_m_s2", self.before_.acceleration_N_m_s2, fathom::archive::finite());
  archive("variance_before_m2_s4", self.before_.variance_m2_s4, fathom::archive::at_least_zero());
}

template <class Archive, class Self>
void TiltFit::fields(Archive& archive, Self& self) {
  archive("has_velocity", self.has_velocity_);
  archive("has_down", self.has_down_);
  archive("v_N_m_s", self.v_N_m_s_, fathom::archive::finite());
  archive("dv_m_s", self.dv_m_s_, fathom::archive::finite());
  archive("turn_rad", self.turn_rad_, fathom::archive::finite());
  archive("lasted_s", self.lasted_s_, fathom::archive::at_least_zero());
  archive("turn_before_rad", self.turn_before_rad_, fathom::archive::finite());
  archive("down_B", self.down_B_, fathom::archive::finite());
  archive("variance", self.variance_, fathom::archive::at_least_zero());
  archive("count", self.count_, fathom::archive::at_least_zero());
  archive("left", self.left_, fathom::archive::at_least_zero());
  archive("over_configured", self.over_configured_, fathom::archive::finite());
  archive("over_nothing", self.over_nothing_, fathom::archive::finite());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, PlausibilityFinding>
void fields(Archive& archive, Self& self) {
  archive("kind", self.kind, Implausible::gps_place_unit);
  archive("value", self.value, fathom::archive::finite());
}

template <class Archive, class Self>
void Plausibility::fields(Archive& archive, Self& self) {
  archive("finding", self.finding_);
  archive("vouched", self.vouched_);
  archive("sound", self.sound_);
  archive("upright", self.upright_);
  archive("down_B", self.down_B_, fathom::archive::finite());
  archive("felt_s", self.felt_s_, fathom::archive::at_least_zero());
  archive("felt_rate_rad_s", self.felt_rate_rad_s_, fathom::archive::at_least_zero());
  archive("felt_m_s", self.felt_m_s_, fathom::archive::finite());
  archive("in_g_s", self.in_g_s_, fathom::archive::at_least_zero());
  archive("downwards_s", self.downwards_s_, fathom::archive::at_least_zero());
  archive("upwards_s", self.upwards_s_, fathom::archive::at_least_zero());
  archive("along_x_s", self.along_x_s_, fathom::archive::at_least_zero());
  archive("along_y_s", self.along_y_s_, fathom::archive::at_least_zero());
  archive("felt_turn_rad", self.felt_turn_rad_, fathom::archive::finite());
  archive("axes", self.axes_);
  archive("speed_ns", self.speed_ns_, fathom::archive::kInstant);
  archive("speed_m_s", self.speed_m_s_, fathom::archive::at_least_zero());
  archive("interval_s", self.interval_s_, fathom::archive::at_least_zero());
  archive("intervals", self.intervals_, fathom::archive::at_least_zero());
  archive("slots", self.slots_, fathom::archive::at_least_zero());
  archive("dvl_ns", self.dvl_ns_, fathom::archive::kInstant);
  archive("dvl_velocity_B_m_s", self.dvl_velocity_B_m_s_, fathom::archive::finite());
  archive("heading_ns", self.heading_ns_, fathom::archive::kInstant);
  archive("heading_rad", self.heading_rad_, fathom::archive::within(-30.0, 30.0));
  archive("compass_from_ns", self.compass_.from_ns, fathom::archive::kInstant);
  archive("compass_rad", self.compass_.angle_rad, fathom::archive::within(-30.0, 30.0));
  archive("compass_turned_rad", self.compass_.turned_rad, fathom::archive::finite());
  archive("compass", self.compass_.fit);
  archive("course_from_ns", self.course_.from_ns, fathom::archive::kInstant);
  archive("course_rad", self.course_.angle_rad, fathom::archive::within(-30.0, 30.0));
  archive("course_turned_rad", self.course_.turned_rad, fathom::archive::finite());
  archive("course", self.course_.fit);
  archive("track_from_ns", self.track_.from_ns, fathom::archive::kInstant);
  archive("track_last_ns", self.track_.last_ns, fathom::archive::kInstant);
  archive("track_latitude_rad", self.track_.latitude_rad, fathom::archive::within(-1.5708, 1.5708));
  archive("track_longitude_rad", self.track_.longitude_rad, fathom::archive::within(-6.2832, 6.2832));
  archive("track_velocity_m_s", self.track_.velocity_m_s, fathom::archive::finite());
  archive("track_way_m", self.track_.way_m, fathom::archive::finite());
  archive("track", self.track_.fit);
  archive("depth_from_ns", self.depth_.from_ns, fathom::archive::kInstant);
  archive("depth_m", self.depth_.depth_m, fathom::archive::finite());
  archive("depth_way_m", self.depth_.way_m, fathom::archive::finite());
  archive("depth_path_m", self.depth_.path_m, fathom::archive::at_least_zero());
  archive("depth", self.depth_.fit);
  archive("speed", self.speed_);
  archive("ground", self.ground_);
  archive("mirror", self.mirror_);
}

template <class Archive, class Self>
void Plausibility::later_fields(Archive& archive, Self& self) {
  archive("tilts", self.tilts_);
  if (!archive.since(21)) return;
  archive("gain_from_ns", self.gain_.from_ns, fathom::archive::kInstant);
  archive("gain_newest_ns", self.gain_.newest_ns, fathom::archive::kInstant);
  archive("gain_from_N_m_s", self.gain_.from_N_m_s, fathom::archive::finite());
  archive("gain_newest_N_m_s", self.gain_.newest_N_m_s, fathom::archive::finite());
  archive("gain_noise_m_s", self.gain_.noise_m_s, fathom::archive::at_least_zero());
  archive("gain_variance_m2_s4", self.gain_.variance_m2_s4, fathom::archive::at_least_zero());
  archive("gain_acceleration_N_m_s2", self.gain_.acceleration_N_m_s2, fathom::archive::finite());
}

}  // namespace fathom::estimation
