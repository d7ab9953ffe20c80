#pragma once

#include "archive/covariance.hpp"
#include "archive/values.hpp"
#include "estimation/alignment/drop_alignment.hpp"
#include "estimation/alignment/rest_window.hpp"
#include "estimation/alignment/under_way.hpp"
#include "estimation/alignment/velocity_track.hpp"
#include "estimation/alignment/velocity_window.hpp"

/// Fields of the parts that find the attitude. What is made from the configuration is left out.
namespace fathom::estimation {

template <class Archive, class Self>
void RestWindow::fields(Archive& archive, Self& self) {
  archive("duration_s", self.duration_s_, fathom::archive::at_least_zero());
  archive("count", self.count_, fathom::archive::kCount);
  archive("q_start_now", self.q_start_now_);
  archive("rate_sum", self.rate_sum_, fathom::archive::finite());
  archive("rate_square", self.rate_square_, fathom::archive::at_least_zero());
  archive("force_first", self.force_first_, fathom::archive::finite());
  archive("force_sum", self.force_sum_, fathom::archive::finite());
  archive("force_square", self.force_square_, fathom::archive::at_least_zero());
  archive("turn_sum", self.turn_sum_, fathom::archive::finite());
  archive("turn_square", self.turn_square_, fathom::archive::at_least_zero());
  archive("time_sum", self.time_sum_, fathom::archive::at_least_zero());
  archive("time_square", self.time_square_, fathom::archive::at_least_zero());
  archive("turn_time", self.turn_time_, fathom::archive::finite());
  archive("headings", self.headings_, fathom::archive::kCount);
  archive("two_antenna", self.two_antenna_);
  archive("heading_sigma_rad", self.heading_sigma_rad_, fathom::archive::at_least_zero());
  archive("heading_sine", self.heading_sine_, fathom::archive::finite());
  archive("heading_cosine", self.heading_cosine_, fathom::archive::finite());
  if constexpr (Archive::kReads)
    archive.expect((self.count_ > 0) == (self.duration_s_ > 0.0), "duration_s", "the time of its samples");
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, InertialSpan>
void fields(Archive& archive, Self& self) {
  archive("duration_s", self.duration_s, fathom::archive::at_least_zero());
  archive("q_start_now", self.q_start_now);
  archive("dv_m_s", self.dv_m_s, fathom::archive::finite());
  archive("by_accel_bias", self.by_accel_bias, fathom::archive::finite());
  archive("turn_by_bias", self.turn_by_bias, fathom::archive::finite());
  archive("dv_by_gyro_bias", self.dv_by_gyro_bias, fathom::archive::finite());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, VelocityMark>
void fields(Archive& archive, Self& self) {
  archive("v_N_m_s", self.v_N_m_s, fathom::archive::finite());
  archive("sigma_m_s", self.sigma_m_s, fathom::archive::at_least_zero());
  archive("rate_B_rad_s", self.rate_B_rad_s, fathom::archive::finite());
  archive("span", self.span);
}

template <class Archive, class Self>
void VelocityWindow::fields(Archive& archive, Self& self) {
  archive("open", self.open_);
  archive("complete", self.complete_);
  archive("has_middle", self.has_middle_);
  archive("pending", self.pending_);
  archive("measured_ns", self.measured_ns_, fathom::archive::kInstant);
  archive("pending_v_N_m_s", self.pending_v_N_m_s_, fathom::archive::finite());
  archive("pending_sigma_m_s", self.pending_sigma_m_s_, fathom::archive::at_least_zero());
  archive("now", self.now_);
  archive("first", self.first_);
  archive("middle", self.middle_);
  archive("last", self.last_);
}

template <class Archive, class Self>
void VelocityTrack::fields(Archive& archive, Self& self) {
  archive("count", self.count_, fathom::archive::Whole{0, kMarks});
  // Those that are not in use are as constructed; the layout is told by the first.
  const std::size_t used = std::clamp<std::size_t>(self.count_, 1, kMarks);
  for (std::size_t i = 0; i < used; ++i) archive.element("marks", i, self.marks_[i]);
  archive.left_out(self.marks_);
  archive("now", self.now_);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, UnderWay>
void fields(Archive& archive, Self& self) {
  constexpr auto kOrUnknown = fathom::archive::or_unknown(fathom::archive::finite());
  archive("heading_ns", self.heading_ns, fathom::archive::kInstant);
  archive("heading_rad", self.heading_rad, fathom::archive::or_unknown(fathom::archive::within(-20.0, 20.0)));
  archive("heading_sigma_rad", self.heading_sigma_rad,
          fathom::archive::or_unknown(fathom::archive::at_least_zero()));
  archive("two_antenna", self.two_antenna);
  archive("dvl_ns", self.dvl_ns, fathom::archive::kInstant);
  archive("dvl_velocity_B_m_s", self.dvl_velocity_B_m_s, fathom::archive::finite());
  archive("usbl_ns", self.usbl_ns, fathom::archive::kInstant);
  archive("usbl_latitude_rad", self.usbl_latitude_rad,
          fathom::archive::or_unknown(fathom::archive::within(-1.5708, 1.5708)));
  archive("usbl_longitude_rad", self.usbl_longitude_rad,
          fathom::archive::or_unknown(fathom::archive::within(-6.2832, 6.2832)));
  archive("usbl_depth_m", self.usbl_depth_m, kOrUnknown);
  archive("usbl_sigma_m", self.usbl_sigma_m, fathom::archive::or_unknown(fathom::archive::at_least_zero()));
  archive("usbl_lever_B_m", self.usbl_lever_B_m, fathom::archive::finite());
  if (!archive.since(6)) return;
  archive("dvl_lever_B_m", self.dvl_lever_B_m, fathom::archive::finite());
  archive("dvl_sigma_m_s", self.dvl_sigma_m_s, fathom::archive::or_unknown(fathom::archive::at_least_zero()));
  if (!archive.since(17)) return;
  archive("usbl_agrees", self.usbl_agrees);
  archive("usbl_turned_N_m", self.usbl_turned_N_m, fathom::archive::finite());
  if (!archive.since(18)) return;
  archive("depth_ns", self.depth_ns, fathom::archive::kInstant);
  archive("depth_m", self.depth_m, kOrUnknown);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, StabilityWindow>
void fields(Archive& archive, Self& self) {
  archive("roll_rad", self.roll_rad, fathom::archive::finite());
  archive("pitch_rad", self.pitch_rad, fathom::archive::finite());
  archive("rate_B_rad_s", self.rate_B_rad_s, fathom::archive::finite());
  archive("force_B_m_s2", self.force_B_m_s2, fathom::archive::finite());
  archive("speed_m_s", self.speed_m_s, fathom::archive::finite());
  archive("speed_slope_m_s2", self.speed_slope_m_s2, fathom::archive::finite());
  archive("forward_spread_m_s2", self.forward_spread_m_s2, fathom::archive::at_least_zero());
  archive("flow_spread_m_s2", self.flow_spread_m_s2, fathom::archive::at_least_zero());
  archive("samples", self.samples, fathom::archive::kCount);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, StabilityGate::Watched>
void fields(Archive& archive, Self& self) {
  archive("value", self.value, fathom::archive::or_unknown(fathom::archive::finite()));
  archive("held_s", self.held_s, fathom::archive::at_least_zero());
  archive.left_out(self.limit);
  archive.left_out(self.needed_s);
}

template <class Archive, class Self>
void StabilityGate::fields(Archive& archive, Self& self) {
  archive.left_out(self.config_);
  archive("phase", self.phase_, Phase::full);
  archive("watched", self.watched_);
  archive("last_reset", self.last_reset_, StabilityReset::disagreement);
  archive("last_fault", self.last_fault_, StabilityReset::disagreement);
  archive("since_fault_s", self.since_fault_s_, fathom::archive::at_least_zero());
  archive("primed", self.primed_);
  archive("has_before", self.has_before_);
  archive("raw_rate", self.raw_rate_, fathom::archive::finite());
  archive("raw_force", self.raw_force_, fathom::archive::finite());
  archive("rate", self.rate_, fathom::archive::finite());
  archive("force", self.force_, fathom::archive::finite());
  archive("light_share", self.light_share_, fathom::archive::within(0.0, 1.0));
  archive("light_forward", self.light_forward_, fathom::archive::finite());
  archive("light_side", self.light_side_, fathom::archive::finite());
  archive("slow_side", self.slow_side_, fathom::archive::finite());
  archive("has_side", self.has_side_);
  archive("flow", self.flow_, fathom::archive::finite());
  archive("flow_weight", self.flow_weight_, fathom::archive::within(0.0, 1.0));
  archive("jitter", self.jitter_, fathom::archive::at_least_zero());
  archive("averaged_s", self.averaged_s_, fathom::archive::at_least_zero());
  archive("samples", self.samples_, fathom::archive::kCount);
  archive("sum", self.sum_);
  archive("first_light", self.first_light_, fathom::archive::finite());
  archive("excess", self.excess_, fathom::archive::finite());
  archive("excess_square", self.excess_square_, fathom::archive::at_least_zero());
  archive("window", self.window_);
}

template <class Archive, class Self>
void TiltFilter::fields(Archive& archive, Self& self) {
  archive("q_NB", self.q_NB_);
  archive("v_N", self.v_N_, fathom::archive::within(-1e5, 1e5));
  archive("depth_m", self.depth_m_, fathom::archive::within(-1e8, 1e8));
  archive("bias", self.bias_, fathom::archive::finite());
  fathom::archive::covariance(archive, "p", self.p_);
}

template <class Archive, class Self>
void SpeedTrack::fields(Archive& archive, Self& self) {
  archive("x", self.x_, fathom::archive::finite());
  fathom::archive::covariance(archive, "p", self.p_);
}

template <class Archive, class Self>
void DropAlignment::fields(Archive& archive, Self& self) {
  // Of the configuration what the release and gaps say; the rest is the owner's to set before.
  archive("tilt_sigma_rad", self.config_.tilt_sigma_rad, fathom::archive::at_least_zero());
  archive("heading_sigma_rad", self.config_.heading_sigma_rad, fathom::archive::at_least_zero());
  archive.left_out(self.config_);
  archive("phase", self.phase_, AlignmentPhase::lost);
  archive("time_s", self.time_s_, fathom::archive::at_least_zero());
  archive("phase_since_s", self.phase_since_s_, fathom::archive::at_least_zero());
  archive("hold_since_s", self.hold_since_s_, fathom::archive::finite());
  archive("entered_s", self.entered_s_, fathom::archive::finite());
  archive("q_NB", self.q_NB_);
  fathom::archive::covariance(archive, "covariance", self.covariance_);
  archive("gate", self.gate_);
  archive("filtering", self.filtering_);
  archive("filtering_since_s", self.filtering_since_s_, fathom::archive::at_least_zero());
  archive("next_slip_s", self.next_slip_s_, fathom::archive::at_least_zero());
  archive("turned", self.turned_);
  archive("filter", self.filter_);
  archive("consistency", self.consistency_, fathom::archive::at_least_zero());
  archive("contradicted_since_s", self.contradicted_since_s_, fathom::archive::finite());
  archive("level_force_B", self.level_force_B_, fathom::archive::finite());
  archive("rate_NB_B", self.rate_NB_B_, fathom::archive::finite());
  archive("slip_rate", self.slip_rate_, fathom::archive::finite());
  archive("g_m_s2", self.g_m_s2_, fathom::archive::within(0.0, 100.0));
  archive("depth_at_s", self.depth_at_s_, fathom::archive::finite());
  archive("depth_m", self.depth_m_, fathom::archive::within(-1e8, 1e8));
  archive("speed_at_s", self.speed_at_s_, fathom::archive::finite());
  archive("measured_speed_m_s", self.measured_speed_m_s_, fathom::archive::within(-1e5, 1e5));
  archive("behind_m_s", self.behind_m_s_, fathom::archive::finite());
  archive("speed", self.speed_);
  archive("q_release", self.q_release_);
  archive("release_heading_rad", self.release_heading_rad_, fathom::archive::within(-7.0, 7.0));
}

}  // namespace fathom::estimation
