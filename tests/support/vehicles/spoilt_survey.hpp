#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Cholesky>

#include "geo/wgs84.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::test {

/// What an engine made of a survey whose samples somebody has spoilt, against the truth.
struct SpoiltSurvey {
  double worst_h_sigmas = 0.0;
  double worst_yaw_rad = 0.0;
  double last_yaw_rad = 0.0;
  double worst_yaw_sigmas = 0.0;
  int frozen = 0;      ///< final verdicts
  int refused = 0;     ///< likewise
  std::string advice;  ///< of the alignment, at the end
};

/// The compass is off by so much within that time; `t_s` is the sample's, since the begin of the survey.
inline void turn_compass(Sample& sample, double t_s, double off_rad, double from_s, double until_s) {
  auto* heading = std::get_if<HeadingSample>(&sample);
  if (heading == nullptr || t_s < from_s || t_s >= until_s) return;
  heading->heading_rad = geo::wrap_two_pi(heading->heading_rad + off_rad);
}

/// Since the begin of the survey.
inline double seconds_of(const Sample& sample) {
  return to_seconds(header(sample).stamp_ns - SurveyRun::kEpochNs);
}

/// `spoil(sample, t_s)` changes each sample before the engine has it; the truth is looked at from `from_s`
/// on.
template <class Spoil>
SpoiltSurvey survey(const SurveyRun& run, double from_s, const Spoil& spoil,
                    const estimation::EngineConfig& config = SurveyRun::config()) {
  estimation::FusionEngine engine(config);
  SpoiltSurvey out;
  std::size_t row = 0;
  for (Sample sample : run.samples) {
    const double t_s = seconds_of(sample);
    spoil(sample, t_s);
    feed(engine, sample);
    Verdict verdict;
    while (engine.next_verdict(verdict)) {
      out.frozen += verdict.is_final && verdict.kind == VerdictKind::frozen ? 1 : 0;
      out.refused += verdict.is_final && verdict.kind == VerdictKind::rejected ? 1 : 0;
    }
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = run.truth[row++];
    const NavState& nav = engine.nav_state();
    if (t_s < from_s || nav.mode == NavMode::none || nav.mode == NavMode::aligning) continue;
    const Eigen::Vector2d off_m =
        geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                          {nav.latitude_rad, nav.longitude_rad, nav.altitude_m})
            .head<2>();
    Eigen::Matrix2d p;
    p << nav.position_covariance_N_m2[0], nav.position_covariance_N_m2[1], nav.position_covariance_N_m2[3],
        nav.position_covariance_N_m2[4];
    out.worst_h_sigmas = std::max(out.worst_h_sigmas, std::sqrt(off_m.dot(p.llt().solve(off_m))));
    out.last_yaw_rad = std::abs(geo::wrap_pi(nav.rpy_rad[2] - truth.rpy_rad[2]));
    out.worst_yaw_rad = std::max(out.worst_yaw_rad, out.last_yaw_rad);
    out.worst_yaw_sigmas = std::max(out.worst_yaw_sigmas, out.last_yaw_rad / nav.rpy_sigma_rad[2]);
  }
  AlignmentStatus status;
  engine.fill(status);
  out.advice = status.advice.data();
  return out;
}

inline SpoiltSurvey survey_with_compass_off(const SurveyRun& run, double off_rad, double from_s,
                                            double until_s, double seen_s) {
  return survey(run, seen_s,
                [=](Sample& sample, double t_s) { turn_compass(sample, t_s, off_rad, from_s, until_s); });
}

}  // namespace fathom::test
