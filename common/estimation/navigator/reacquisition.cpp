#include "estimation/navigator/reacquisition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "base/units.hpp"

namespace fathom::estimation {
namespace {

constexpr int kRejectionsToBelieve = 3;
/// Rejections that agree with each other for each measurement that is accepted in between.
constexpr int kMajority = 3;
constexpr double kLeastUnheard_s = 1.0;
/// A level that goes wrong twice within it goes wrong by biases of the inertial unit.
constexpr double kLevelledLately_s = 120.0;
/// Sooner it is the same time.
constexpr double kLeastLevelled_s = 2.0;
constexpr double kLeastDispute_s = 5.0;
constexpr double kDeviations = 4.0;
/// However sure of its velocity the filter is.
constexpr double kLeastSpeed_m_s = 1.0;
/// Of reacquire_s, after which disagreement with the motion counts half, and how far that goes.
constexpr double kPatience = 3.0;
constexpr double kMostHalvings = 2.0;
/// A fix further off than so many of the estimate's own sigmas needs longer to be believed.
constexpr double kConceivable = 7.0;
/// Steps within it are one correction, spread over several fixes.
constexpr double kStepsTogether_s = 60.0;
constexpr double kStepsAtOnce = 2.0;
constexpr double kWeighDown = 1.4;
constexpr int kHalvings = 60;

/// For so long what lies so many squared sigmas off has to last until drift explains it better than a lie;
/// infinite: a person has to decide.
double drift_needed_s(const SensorConfig& config, double squared_sigmas) {
  // (GATE-5)
  const double most_s = config.dispute_s > 0.0 ? std::max(config.dispute_s, config.reacquire_s)
                                               : std::numeric_limits<double>::infinity();
  return std::min(config.reacquire_s * std::max(1.0, squared_sigmas / (kConceivable * kConceivable)), most_s);
}

/// A measurement was accepted: rejections are forgotten, but where they are by far the most.
void accepted(Instrument::Rejections& past) {
  ++past.accepted;
  if (past.believed || past.count < kMajority * past.accepted) past = {};
}

/// Refusals of these rows have agreed with each other for long enough.
bool believe(Instrument::Rejections& past, double needed_s, const Estimate& estimate,
             const Observation& observation, int first, int end) {
  double size = 0.0;
  double change = 0.0;
  double noise = 0.0;
  for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
    const double z = observation.innovation[i];
    size += z * z;
    change += (z - past.innovation[i]) * (z - past.innovation[i]);
    noise += observation.sigma[i] * observation.sigma[i];
    past.innovation[i] = z;
  }
  const bool agrees = past.count > 0 && std::sqrt(change) < 0.5 * std::sqrt(size) + 4.0 * std::sqrt(noise);
  if (!agrees) {
    past.count = 1;
    past.accepted = 0;
    past.believed = false;
    past.since_ns = estimate.now_ns;
    return false;
  }
  ++past.count;
  past.believed = needed_s > 0.0 && past.count >= kRejectionsToBelieve &&
                  to_seconds(estimate.now_ns - past.since_ns) >= needed_s;
  return past.believed;
}

/// Of the rows outside `left_out`, each by itself, those whose refusal is not to be believed.
unsigned believe_each(Instrument& instrument, double needed_s, const Estimate& estimate,
                      const Observation& observation, unsigned refused, unsigned left_out) {
  unsigned believed = 0;
  for (int row = 0; row < observation.rows; ++row) {
    if ((left_out & 1U << row) != 0) continue;
    Instrument::Rejections& past = instrument.rejections[static_cast<std::size_t>(row)];
    if ((refused & 1U << row) == 0) {
      accepted(past);
    } else if (believe(past, needed_s, estimate, observation, row, row + 1)) {
      believed |= 1U << row;
    }
  }
  return believed;
}

}  // namespace

bool measures(const Observation& observation, int row, int first_state) {
  const auto& h = observation.h[static_cast<std::size_t>(row)];
  const auto begin = h.begin() + first_state;
  return std::any_of(begin, begin + 3, [](double weight) { return weight != 0.0; });
}

unsigned position_rows(const Observation& observation) {
  unsigned out = 0;
  for (int row = 0; row < observation.rows; ++row)
    if (measures(observation, row, 0)) out |= 1U << row;
  return out;
}

bool places(const Observation& observation, unsigned refused) {
  for (int row = 0; row < observation.rows; ++row) {
    const auto& weights = observation.h[static_cast<std::size_t>(row)];
    if ((refused & 1U << row) == 0 && (weights[0] != 0.0 || weights[1] != 0.0)) return true;
  }
  return false;
}

unsigned Reacquisition::believed_rows(Instrument& instrument, const SensorConfig& config,
                                      const Estimate& estimate, const Observation& observation,
                                      unsigned refused, bool fix, double needed_s) const {
  if (observation.each_alone) return believe_each(instrument, needed_s, estimate, observation, refused, 0);
  if (fix) return believed_rows_of_fix(instrument, config, estimate, observation, refused, needed_s);
  if (config.gate_mode == GateMode::whole) {
    const bool believed = refused != 0 && believe(instrument.rejections[0], needed_s, estimate, observation,
                                                  0, observation.rows);
    if (refused == 0) accepted(instrument.rejections[0]);
    return believed ? refused : 0U;
  }
  return believe_each(instrument, needed_s, estimate, observation, refused, 0);
}

unsigned Reacquisition::believed_rows_of_fix(Instrument& instrument, const SensorConfig& config,
                                             const Estimate& estimate, const Observation& observation,
                                             unsigned refused, double needed_s) const {
  // Behind a fix stand two hypotheses for as long as it takes: it is wrong, or the estimate is.
  const unsigned position = position_rows(observation);
  if ((refused & position) == 0) instrument.candidate = {};
  const bool believed =
      (refused & position) != 0 && believe_fix(instrument.candidate, config, estimate, observation);
  if (config.gate_mode == GateMode::whole) return believed ? refused : 0U;
  return believe_each(instrument, needed_s, estimate, observation, refused, position) |
         (believed ? refused & position : 0U);
}

bool Reacquisition::on_probation(const SensorConfig& config, const Observation& observation, bool in_outage) {
  // (GATE-4)
  if (config.reacquire_s <= 0.0 || !in_outage) return false;
  return std::hypot(observation.innovation[0], observation.innovation[1]) > config.reacquire_step_m;
}

bool Reacquisition::believe_fix(Instrument::Candidate& candidate, const SensorConfig& config,
                                const Estimate& estimate, const Observation& observation) const {
  // (GATE-4)
  const Eigen::Vector2d innovation(observation.innovation[0], observation.innovation[1]);
  const auto way_less_fixes = [&] {
    // Not the estimated position: a compass may move that by tens of metres when it has drifted by hundreds.
    const Eigen::Vector3d moved_N = geo::difference_N(candidate.origin, estimate.state.nav.position);
    return Eigen::Vector2d(estimate.travelled_N_m.head<2>() - (moved_N.head<2>() - innovation));
  };
  Eigen::Vector2d off = way_less_fixes();
  if (candidate.refused_since_ns == 0) candidate.refused_since_ns = estimate.now_ns;
  double speed =
      std::max(kDeviations * std::sqrt(estimate.filter(3, 3) + estimate.filter(4, 4)), kLeastSpeed_m_s);
  // What never agrees is the motion's fault, not for ever that of the fix.
  double halvings = config.reacquire_s > 0.0
                        ? std::floor(to_seconds(estimate.now_ns - candidate.refused_since_ns) /
                                     (kPatience * config.reacquire_s))
                        : 0.0;
  if (stepped_lately(config, estimate)) {
    speed += stepped_m_s_;
  } else {
    halvings = std::min(halvings, kMostHalvings);
  }
  const double patience = std::exp2(halvings);
  const double noise =
      kDeviations * std::numbers::sqrt2 * std::max(observation.sigma[0], observation.sigma[1]);
  const auto agrees = [&](const Eigen::Vector2d& before, TimeNs stamp_ns) {
    return (off - before).norm() <= patience * (noise + speed * to_seconds(estimate.now_ns - stamp_ns));
  };
  if (candidate.since_ns == 0 || !agrees(candidate.first_N_m, candidate.since_ns) ||
      !agrees(candidate.last_N_m, candidate.last_ns)) {
    candidate.since_ns = estimate.now_ns;
    candidate.origin = estimate.state.nav.position;
    off = way_less_fixes();
    candidate.first_N_m = off;
    candidate.count = 0;
  }
  candidate.last_ns = estimate.now_ns;
  candidate.last_N_m = off;
  ++candidate.count;
  const double agreed_s = to_seconds(estimate.now_ns - candidate.since_ns);
  return candidate.count >= kRejectionsToBelieve &&
         agreed_s >= agreement_needed_s(config, estimate, observation);
}

double Reacquisition::agreement_needed_s(const SensorConfig& config, const Estimate& estimate,
                                         const Observation& observation) const {
  if (config.reacquire_s <= 0.0) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d innovation(observation.innovation[0], observation.innovation[1]);
  Eigen::Matrix2d s;
  s << estimate.filter(0, 0), estimate.filter(0, 1), estimate.filter(1, 0), estimate.filter(1, 1);
  for (int i = 0; i < 2; ++i)
    s(i, i) +=
        observation.sigma[static_cast<std::size_t>(i)] * observation.sigma[static_cast<std::size_t>(i)];
  if (stepped_lately(config, estimate)) s.diagonal().array() += stepped_m_ * stepped_m_;
  return drift_needed_s(config, innovation.dot(s.llt().solve(innovation)));
}

double Reacquisition::heading_needed_s(const Instrument& instrument, const SensorConfig& config,
                                       const Estimate& estimate, double deviations, bool vouched) {
  // (GATE-7)
  if (config.reacquire_s <= 0.0) return 0.0;
  const double needed_s = drift_needed_s(config, deviations * deviations);
  if (vouched) return needed_s;
  const TimeNs agreed_since_ns = std::max(instrument.agrees_since_ns, estimate.began_ns);
  const bool agreed = instrument.agrees_since_ns != 0 && instrument.used_ns > agreed_since_ns;
  const double agreed_s = agreed ? to_seconds(instrument.used_ns - agreed_since_ns) : 0.0;
  return std::min(needed_s, std::max(config.reacquire_s, agreed_s));
}

void Reacquisition::renew_compass(const Setup& setup, Estimate& estimate, Observation& heading) {
  // (GATE-8)
  for (const Group group : {Group::heading_bias, Group::heading_deviation}) {
    const int first = setup.index.of(group);
    if (first < 0 || first >= setup.index.estimated()) continue;
    for (int i = first; i < first + group_size(group); ++i) {
      const auto state = static_cast<std::size_t>(i);
      if (heading.h[0][state] == 0.0) continue;
      heading.innovation[0] += heading.h[0][state] * estimate.state.x[state];
      estimate.state.x[state] = 0.0;
      estimate.forget(i, setup.initial_sigma[state]);
    }
  }
  heading.innovation[0] = geo::wrap_pi(heading.innovation[0]);
}

bool Reacquisition::stepped_lately(const SensorConfig& config, const Estimate& estimate) const {
  return stepped_ns_ != 0 && estimate.since(stepped_ns_) <= std::max(config.dispute_s, config.reacquire_s);
}

void Reacquisition::note_step(const Eigen::Vector3d& step_N_m, const Observation* fix,
                              const Estimate& estimate) {
  ++reset_counter_;
  last_reset_N_m_ = step_N_m;
  if (stepped_ns_ == 0 || estimate.since(stepped_ns_) > kStepsTogether_s) {
    stepped_m_ = 0.0;
    stepped_m_s_ = 0.0;
  }
  stepped_ns_ = estimate.now_ns;
  stepped_m_ += step_N_m.head<2>().norm();
  if (fix == nullptr) return;
  double squared = 0.0;
  for (int row = 0; row < fix->rows; ++row) {
    const double z = fix->innovation[static_cast<std::size_t>(row)];
    if (!measures(*fix, row, 0) && measures(*fix, row, 3)) squared += z * z;
  }
  stepped_m_s_ = std::max(stepped_m_s_, std::sqrt(squared));
}

bool Reacquisition::disputed(const Instrument& instrument, const SensorConfig& config,
                             const Estimate& estimate) {
  if (instrument.candidate.refused_since_ns == 0) return false;
  const double refused_s = to_seconds(estimate.now_ns - instrument.candidate.refused_since_ns);
  return refused_s > std::max(config.reacquire_s, kLeastDispute_s);
}

bool Reacquisition::bound_step(const SensorConfig& config, const Estimate& estimate, Observation& observation,
                               InnovationStatistics& statistics) {
  const double most_m = kStepsAtOnce * config.reacquire_step_m;
  bool bounded = false;
  for (int i = 0; i < kHalvings; ++i) {
    // K z of the horizontal position.
    const auto rows = static_cast<std::size_t>(statistics.rows);
    const Eigen::Index m = statistics.rows;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Observation::kMaxRows, Observation::kMaxRows> s(
        m, m);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Observation::kMaxRows, 1> z(m);
    Eigen::Matrix<double, Eigen::Dynamic, 2, 0, Observation::kMaxRows, 2> ph(m, 2);
    for (std::size_t r = 0; r < rows; ++r) {
      const auto at = static_cast<Eigen::Index>(r);
      z(at) = observation.innovation[r];
      for (int axis = 0; axis < 2; ++axis)
        ph(at, axis) = statistics.ph[r * kMaxStates + static_cast<std::size_t>(axis)];
      for (std::size_t c = 0; c < rows; ++c)
        s(at, static_cast<Eigen::Index>(c)) = statistics.s[r * Observation::kMaxRows + c];
    }
    const Eigen::Vector2d step = ph.transpose() * s.llt().solve(z);
    if (!(step.norm() > most_m)) break;
    bounded = true;
    // All of the fix: after an outage its velocity, too, moves the position, by what they have in common.
    for (std::size_t row = 0; row < rows; ++row) observation.sigma[row] *= kWeighDown;
    estimate.filter.statistics(observation, 1.0, statistics);
  }
  return bounded;
}

void Reacquisition::make_room(const Setup& setup, const AidingPolicy& policy, bool agrees_with_ground,
                              const Instrument& instrument, Estimate& estimate,
                              const Observation& observation, unsigned rows, double factor) {
  // (GATE-3)
  if (policy.heading_alone) {
    estimate.widen_heading(factor * observation.innovation[0] * observation.innovation[0]);
    return;
  }
  const int current = setup.index.of(Group::current);
  const bool of_current =
      policy.velocity == VelocityOver::medium && current >= 0 && current < setup.index.estimated();
  std::array<double, kNavStates> variance{};
  double wrong_m2_s2 = 0.0;  // of velocities that show the level
  const double unheard_s = std::max(
      instrument.used_ns == 0 ? kLeastUnheard_s : estimate.since(instrument.used_ns), kLeastUnheard_s);
  for (int row = 0; row < observation.rows; ++row) {
    if ((rows & 1U << row) == 0) continue;
    const auto r = static_cast<std::size_t>(row);
    const double squared = factor * observation.innovation[r] * observation.innovation[r];
    int first = 6;
    if (measures(observation, row, 0)) {
      first = 0;
    } else if (measures(observation, row, 3)) {
      first = 3;
    }
    // Of states that would explain the innovation: h z / |h|^2, whatever unit the row has.
    const double* weights = observation.h[r].data() + first;
    double weight = 0.0;
    for (int i = 0; i < 3; ++i) weight += weights[i] * weights[i];
    if (weight == 0.0) continue;
    const auto share = [&](int i) { return squared * weights[i] * weights[i] / (weight * weight); };
    const bool through_medium = of_current && first == 3;
    if (through_medium)
      for (int i = 0; i < 2; ++i) estimate.filter.widen(current + i, share(i));
    // With the velocity over ground right the current has changed, which has no vertical component.
    const bool current_alone = through_medium && agrees_with_ground;
    for (int i = current_alone ? 2 : 0; i < 3; ++i) variance[static_cast<std::size_t>(first + i)] += share(i);
    if (current_alone) continue;
    // A velocity goes wrong by a level that is wrong: left as sure as it was, that would lead astray again.
    if (first == 3 && policy.shows_level && factor == 1.0) {
      const double tilt = observation.innovation[r] / (kStandardGravity_m_s2 * unheard_s);
      variance[6] += tilt * tilt;
      variance[7] += tilt * tilt;
      wrong_m2_s2 += squared;
    }
  }
  estimate.filter.widen_drifted(variance);
  if (wrong_m2_s2 > 0.0) doubt_biases(setup, estimate, wrong_m2_s2);
}

void Reacquisition::doubt_biases(const Setup& setup, Estimate& estimate, double wrong_m2_s2) {
  // (GATE-3)
  const double since_s = estimate.since(levelled_ns_);
  if (since_s < kLeastLevelled_s) return;
  levelled_ns_ = estimate.now_ns;
  if (!(since_s <= kLevelledLately_s)) return;  // or never
  const auto widen = [&](Group group, double sigma) {
    const int first = setup.index.of(group);
    if (first < 0 || first >= setup.index.estimated()) return;
    for (int i = first; i < first + group_size(group); ++i) {
      estimate.filter.widen(i, sigma * sigma);
      estimate.bias_prior.widen(i, sigma * sigma);
    }
  };
  const double wrong_m_s = std::sqrt(wrong_m2_s2);
  widen(Group::accel_bias, std::min(wrong_m_s / since_s, kMostAccelBias_m_s2));
  widen(Group::gyro_bias,
        std::min(wrong_m_s / (0.5 * kStandardGravity_m_s2 * since_s * since_s), kMostGyroBias_rad_s));
  estimate.bias_prior.interrupt();
  estimate.motion_noise.interrupt();
}

}  // namespace fathom::estimation
