#pragma once

#include "estimation/fields/alignment.hpp"
#include "estimation/fields/doubt.hpp"
#include "estimation/fields/filter.hpp"
#include "estimation/fields/plausibility.hpp"
#include "estimation/navigator/navigator.hpp"

/// Fields of the navigator and of what it remembers.
namespace fathom::estimation {

namespace hydro {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Controls>
void fields(Archive& archive, Self& self) {
  archive("rpm", self.rpm, fathom::archive::within(-1e5, 1e5));
  archive("rudder_rad", self.rudder_rad, fathom::archive::within(-6.3, 6.3));
  archive("stern_rad", self.stern_rad, fathom::archive::within(-6.3, 6.3));
}

template <class Archive, class Self>
void WaterVelocity::fields(Archive& archive, Self& self) {
  archive("running", self.running_);
  archive("running_s", self.running_s_, fathom::archive::at_least_zero());
  archive("rpm_heard", self.rpm_heard_);
  archive("V_B", self.V_B_, fathom::archive::within(-kMost_m_s, kMost_m_s));
  archive("omega_before_B", self.omega_before_B_, fathom::archive::finite());
  archive("controls", self.controls_);
  archive("fins_age_s", self.fins_age_s_, fathom::archive::at_least_zero());
  archive("unmeasured_s", self.unmeasured_s_, fathom::archive::at_least_zero());
  archive("since_compared_s", self.since_compared_s_, fathom::archive::at_least_zero());
  archive("compared_s", self.compared_s_, fathom::archive::at_least_zero());
  archive("doubt", self.model_nis_, fathom::archive::at_least_zero());
}

}  // namespace hydro

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Instrument::Rejections>
void fields(Archive& archive, Self& self) {
  archive("since_ns", self.since_ns, fathom::archive::kInstant);
  archive("count", self.count, fathom::archive::kCount);
  archive("innovation", self.innovation, fathom::archive::finite());
  if (!archive.since(13)) return;
  archive("accepted", self.accepted, fathom::archive::kCount);
  archive("believed", self.believed);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Instrument::Candidate>
void fields(Archive& archive, Self& self) {
  archive("refused_since_ns", self.refused_since_ns, fathom::archive::kInstant);
  archive("since_ns", self.since_ns, fathom::archive::kInstant);
  archive("last_ns", self.last_ns, fathom::archive::kInstant);
  archive("count", self.count, fathom::archive::kCount);
  archive("origin", self.origin);
  archive("first_N_m", self.first_N_m, fathom::archive::finite());
  archive("last_N_m", self.last_N_m, fathom::archive::finite());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Instrument>
void fields(Archive& archive, Self& self) {
  archive("enabled", self.enabled);
  archive("stamp_ns", self.stamp_ns, fathom::archive::kInstant);
  archive("used_ns", self.used_ns, fathom::archive::kInstant);
  archive("reading", self.reading,
          fathom::archive::any_number());  // compared only
  archive("first_prediction", self.first_prediction, fathom::archive::finite());
  archive("repeats", self.repeats);
  archive("rejections", self.rejections);
  archive("candidate", self.candidate);
  if (!archive.since(11)) return;
  archive("agrees_since_ns", self.agrees_since_ns, fathom::archive::kInstant);
  archive("first_travelled_N_m", self.first_travelled_N_m, fathom::archive::finite());
  archive("normalised_square", self.normalised_square, fathom::archive::at_least_zero());
  if (archive.since(14)) archive("noise", self.noise);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, BeaconId>
void fields(Archive& archive, Self& self) {
  archive("name", self.name);
  archive("latitude_rad", self.latitude_rad, fathom::archive::or_unknown(fathom::archive::within(-1.6, 1.6)));
  archive("longitude_rad", self.longitude_rad,
          fathom::archive::or_unknown(fathom::archive::within(-6.3, 6.3)));
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, HeardBeacon>
void fields(Archive& archive, Self& self) {
  archive("sensor", self.sensor, fathom::archive::Whole{-1, kMaxSensors - 1});
  archive("id", self.id);
  archive("instrument", self.instrument);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, SquaredInputs>
void fields(Archive& archive, Self& self) {
  constexpr double kMost = 1e12;
  archive("rate_B", self.rate_B, fathom::archive::within(0.0, kMost));
  archive("force_B", self.force_B, fathom::archive::within(0.0, kMost));
  archive("felt", self.felt, fathom::archive::within(0.0, kMost));
}

/// Integrals over less than a second; the means are quotients by its length.
template <class Archive, class Self>
void Stride::fields(Archive& archive, Self& self) {
  constexpr double kMost = 1e6;
  constexpr double kShortest_s = 1e-10;  // stamps are whole nanoseconds
  archive("dt_s", self.dt_s_, fathom::archive::within(0.0, 1.0));
  archive("C_NB_s", self.C_NB_s_, fathom::archive::within(-1.0, 1.0));
  archive("turn_B_rad", self.turn_B_rad_, fathom::archive::within(-kMost, kMost));
  archive("dv_B_m_s", self.dv_B_m_s_, fathom::archive::within(-kMost, kMost));
  archive("dv_N_m_s", self.dv_N_m_s_, fathom::archive::within(-kMost, kMost));
  archive("squares_s", self.squares_s_);
  if constexpr (Archive::kReads) {
    archive.expect(self.dt_s_ == 0.0 || self.dt_s_ >= kShortest_s, "dt_s", "0 or a nanosecond at least");
    if (self.is_empty()) self = {};
  }
}

template <class Archive, class Self>
void Estimate::fields(Archive& archive, Self& self) {
  archive("now_ns", self.now_ns, fathom::archive::kInstant);
  archive("navigating", self.navigating);
  archive("levelled", self.levelled);
  archive("began_ns", self.began_ns, fathom::archive::kInstant);
  archive("state", self.state);
  archive("filter", self.filter);
  archive("rate_B", self.rate_B_rad_s, fathom::archive::finite());
  archive("force_B", self.force_B_m_s2, fathom::archive::finite());
  archive("travelled_N_m", self.travelled_N_m, fathom::archive::finite());
}

template <class Archive, class Self>
void Estimate::later_fields(Archive& archive, Self& self) {
  archive("usual_force_B", self.usual_force_B_m_s2, fathom::archive::finite());
}

template <class Archive, class Self>
void Reacquisition::fields(Archive& archive, Self& self) {
  archive("reset_counter", self.reset_counter_, fathom::archive::kAnyWhole);
  archive("last_reset_N_m", self.last_reset_N_m_, fathom::archive::finite());
  archive("stepped_ns", self.stepped_ns_, fathom::archive::kInstant);
  archive("stepped_m", self.stepped_m_, fathom::archive::at_least_zero());
  archive("stepped_m_s", self.stepped_m_s_, fathom::archive::at_least_zero());
  if (archive.since(13)) archive("levelled_ns", self.levelled_ns_, fathom::archive::kInstant);
}

template <class Archive, class Self>
void Constraints::fields(Archive& archive, Self& self) {
  archive("rest_until_ns", self.rest_until_ns_, fathom::archive::kInstant);
  archive("next_zero_velocity_ns", self.next_zero_velocity_ns_, fathom::archive::kInstant);
}

template <class Archive, class Self>
void ModelAiding::fields(Archive& archive, Self& self) {
  archive("water", self.water_);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, AlignmentWatch>
void fields(Archive& archive, Self& self) {
  archive("phase", self.phase, AlignmentPhase::lost);
  archive("phase_since_ns", self.phase_since_ns, fathom::archive::kInstant);
  archive("waiting_since_ns", self.waiting_since_ns, fathom::archive::kInstant);
  archive("hold_since_ns", self.hold_since_ns, fathom::archive::kInstant);
}

template <class Archive, class Self>
void Starter::fields(Archive& archive, Self& self) {
  archive("window", self.window_);
  archive("smooth_force", self.smooth_force_, fathom::archive::finite());
  archive("smooth_time_s", self.smooth_time_s_, fathom::archive::at_least_zero());
  archive("gps_seen_ns", self.gps_seen_ns_, fathom::archive::kInstant);
  archive("gps_position", self.gps_position_);
  archive("gps_velocity_N", self.gps_velocity_N_, fathom::archive::or_unknown(fathom::archive::finite()));
  archive("gps_sigma_N_m", self.gps_sigma_N_m_, fathom::archive::at_least_zero());
  archive("gps_speed_m_s", self.gps_speed_m_s_,
          fathom::archive::or_unknown(fathom::archive::at_least_zero()));
  archive("fast_fixes", self.fast_fixes_, fathom::archive::kCount);
  archive("under_way", self.under_way_);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, LastPlace>
void fields(Archive& archive, Self& self) {
  archive("seen_ns", self.seen_ns, fathom::archive::kInstant);
  archive("position", self.position);
  archive("surface_altitude_m", self.surface_altitude_m, fathom::archive::finite());
  archive("surface_sigma_m", self.surface_sigma_m, fathom::archive::at_least_zero());
  archive("sigma_N_m", self.sigma_N_m, fathom::archive::at_least_zero());
  archive("speed_m_s", self.speed_m_s, fathom::archive::at_least_zero());
}

template <class Archive, class Self>
void Starter::later_fields(Archive& archive, Self& self) {
  archive("velocities", self.velocities_);
}

template <class Archive, class Self>
void Starter::place_fields(Archive& archive, Self& self) {
  archive("gps_lever_B_m", self.gps_lever_B_m_, fathom::archive::finite());
  archive("last_place", self.last_);
  archive("out_of_sight", self.out_of_sight_);
}

template <class Archive, class Self>
void Starter::acceleration_fields(Archive& archive, Self& self) {
  archive("track", self.track_);
  archive("acceleration_heading_sigma_rad", self.acceleration_heading_sigma_rad_,
          fathom::archive::or_unknown(fathom::archive::at_least_zero()));
}

template <class Archive, class Self>
void Descent::fields(Archive& archive, Self& self, const Setup& setup) {
  archive("released", self.fall_.released);
  archive("dropping", self.fall_.aligning);
  archive("regained", self.fall_.regained);
  if constexpr (Archive::kReads) {
    archive.expect(self.fall_.released || !(self.fall_.aligning || self.fall_.regained), "released",
                   "a release before");
    if (self.fall_.released) self.drop_ = DropAlignment(setup.drop_config());
  }
  archive("drop", self.drop_);
  archive("fall_dv_N", self.fall_.dv_N, fathom::archive::finite());
  archive("fall_dp_N", self.fall_.dp_N, fathom::archive::finite());
  fathom::archive::covariance(archive, "fall_covariance", self.fall_.covariance);
  archive("fall_s", self.fall_.s, fathom::archive::at_least_zero());
  archive("carried_s", self.fall_.carried_s, fathom::archive::at_least_zero());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, OrderedPosition>
void fields(Archive& archive, Self& self) {
  archive("position_set", self.is_set);
  archive("set_position", self.position);
  archive("set_sigma_m", self.sigma_m, fathom::archive::at_least_zero());
  if (!archive.since(2)) return;
  archive("held_ns", self.held_ns, fathom::archive::kInstant);
  archive("held_position", self.held_position);
  if (!archive.since(18)) return;
  archive("set_ns", self.set_ns, fathom::archive::kInstant);
  archive("set_depth_m", self.depth_m, fathom::archive::or_unknown(fathom::archive::finite()));
}

/// Precondition of reading: `self` is a navigator of the setup that wrote it,
/// as constructed. The parts stand in a row without braces between them, which
/// is how they were written before there were parts; what came with a later
/// version stands at the end.
template <class Archive, class Self>
void Navigator::fields(Archive& archive, Self& self) {
  archive.left_out(self.setup_);
  Estimate::fields(archive, self.estimate_);
  if constexpr (Archive::kReads) {
    self.estimate_.consider_anew(*self.setup_, self.setup_->index.held().of(archive));
  }
  archive("sensors", self.instruments_.sensors);
  archive.left_out(self.instruments_.count);
  archive.left_out(self.instruments_.layer_count);
  archive("gps_used_ns", self.usage_.gps_used_ns, fathom::archive::kInstant);
  archive("usbl_used_ns", self.usage_.usbl_used_ns, fathom::archive::kInstant);
  archive("dvl_used_ns", self.usage_.dvl_used_ns, fathom::archive::kInstant);
  archive("velocity_used_ns", self.usage_.velocity_used_ns, fathom::archive::kInstant);
  Reacquisition::fields(archive, self.reacquisition_);
  Constraints::fields(archive, self.constraints_);
  ModelAiding::fields(archive, self.model_);
  estimation::fields(archive, self.alignment_);
  Starter::fields(archive, self.starter_);
  Descent::fields(archive, self.descent_, *self.setup_);
  estimation::fields(archive, self.ordered_);
  if (archive.since(2)) {
    archive("bottom_used_ns", self.usage_.bottom_used_ns, fathom::archive::kInstant);
    archive("water_layers", self.instruments_.water_layers);
  }
  if (archive.since(5)) {
    Estimate::later_fields(archive, self.estimate_);
    Starter::later_fields(archive, self.starter_);
  }
  if (archive.since(6)) archive("plausibility", self.plausibility_);
  if (archive.since(8)) Plausibility::later_fields(archive, self.plausibility_);
  if (archive.since(9)) archive("stride", self.estimate_.stride);
  if (archive.since(10)) archive("gap_ns", self.usage_.gap_ns, fathom::archive::kInstant);
  if (archive.since(12)) archive("start_heading", self.estimate_.start_heading);
  if (archive.since(13))
    archive("bottom_refused_ns", self.usage_.bottom_refused_ns, fathom::archive::kInstant);
  if (archive.since(15)) {
    archive("bias_prior", self.estimate_.bias_prior);
  } else if constexpr (Archive::kReads) {
    self.estimate_.bias_prior.begin(self.estimate_.state, self.estimate_.filter);
  }
  if (archive.since(16)) archive("motion_noise", self.estimate_.motion_noise);
  if (archive.since(18)) {
    Starter::place_fields(archive, self.starter_);
    archive("beacon_count", self.instruments_.beacon_count, fathom::archive::Whole{0, kMaxBeacons});
    // Those that are not in use are as constructed; the layout is told by the first.
    const std::size_t used = std::clamp<std::size_t>(self.instruments_.beacon_count, 1, kMaxBeacons);
    for (std::size_t i = 0; i < used; ++i) archive.element("beacons", i, self.instruments_.beacons[i]);
    archive.left_out(self.instruments_.beacons);
  } else if constexpr (Archive::kReads) {
    self.starter_.forget_fix();
    self.ordered_.set_ns = self.estimate_.now_ns;
  }
  if (archive.since(19)) {
    archive("slow_gps", self.estimate_.slow_gps);
    archive("slow_usbl", self.estimate_.slow_usbl);
    archive("slow_antennas", self.estimate_.slow_antennas);
  } else if constexpr (Archive::kReads) {
    self.estimate_.slow_gps.begin();
    self.estimate_.slow_usbl.begin();
    self.estimate_.slow_antennas.begin();
  }
  if (archive.since(22)) Starter::acceleration_fields(archive, self.starter_);
  if constexpr (Archive::kReads) archive.expect(self.remembers_the_past_only(), "now_ns", "no later instant");
}

}  // namespace fathom::estimation
