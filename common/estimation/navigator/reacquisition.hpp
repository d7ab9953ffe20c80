#pragma once

#include "estimation/aiding/policy.hpp"
#include "estimation/navigator/estimate.hpp"
#include "estimation/navigator/instruments.hpp"

namespace fathom::estimation {

/// The row looks at one of the three states from `first_state` on.
[[nodiscard]] bool measures(const Observation& observation, int row, int first_state);
/// Those that look at the position, as a set of bits.
[[nodiscard]] unsigned position_rows(const Observation& observation);
/// A row that is not refused tells where the vehicle is, horizontally.
[[nodiscard]] bool places(const Observation& observation, unsigned refused);

/// Nothing is locked out for ever: refusals that agree with each other are believed, and the estimate is
/// given the room to follow (GATE-3). Fixes of a position have to agree with the motion, too (GATE-4,
/// GATE-5); a heading has to last, for the gyros know better for a while (GATE-7).
class Reacquisition {
 public:
  /// Rows, as a set of bits, whose refusal is not to be believed any longer: they have agreed with each other
  /// for `needed_s`. `fix`: they are those of a fix that has to agree with the motion.
  [[nodiscard]] unsigned believed_rows(Instrument& instrument, const SensorConfig& config,
                                       const Estimate& estimate, const Observation& observation,
                                       unsigned refused, bool fix, double needed_s) const;
  /// A fix behind an outage, too far off to be believed by itself.
  [[nodiscard]] static bool on_probation(const SensorConfig& config, const Observation& observation,
                                         bool in_outage);
  /// Fixes of this receiver were refused for so long that a person should know.
  [[nodiscard]] static bool disputed(const Instrument& instrument, const SensorConfig& config,
                                     const Estimate& estimate);
  /// For so long refused headings have to agree with each other (GATE-7), when the last of them is
  /// `deviations` sigmas off. `vouched`: another heading is being used meanwhile.
  [[nodiscard]] static double heading_needed_s(const Instrument& instrument, const SensorConfig& config,
                                               const Estimate& estimate, double deviations, bool vouched);
  /// A heading that is believed is that of another compass than before (GATE-8): its bias and deviation are
  /// as unknown as at the start, and the innovation becomes what it is without them.
  static void renew_compass(const Setup& setup, Estimate& estimate, Observation& heading);
  /// Weighs the fix down until the position moves no further than allowed; whether it had to.
  [[nodiscard]] static bool bound_step(const SensorConfig& config, const Estimate& estimate,
                                       Observation& observation, InnovationStatistics& statistics);
  /// Gives the estimate the variance that these rows ask for, `factor` times. `agrees_with_ground`: with a
  /// velocity over ground, which is measured as well.
  void make_room(const Setup& setup, const AidingPolicy& policy, bool agrees_with_ground,
                 const Instrument& instrument, Estimate& estimate, const Observation& observation,
                 unsigned rows, double factor);
  /// The position steps, from before to after; by a fix, or null.
  void note_step(const Eigen::Vector3d& step_N_m, const Observation* fix, const Estimate& estimate);

  [[nodiscard]] std::uint32_t reset_counter() const { return reset_counter_; }
  [[nodiscard]] const Eigen::Vector3d& last_reset_N_m() const { return last_reset_N_m_; }

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.stepped_ns_);
    visit(self.levelled_ns_);
  }

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  /// Of a fix that is judged as a whole, or of its position rows.
  [[nodiscard]] unsigned believed_rows_of_fix(Instrument& instrument, const SensorConfig& config,
                                              const Estimate& estimate, const Observation& observation,
                                              unsigned refused, double needed_s) const;
  /// Refused fixes agree with each other and with the motion for long enough.
  [[nodiscard]] bool believe_fix(Instrument::Candidate& candidate, const SensorConfig& config,
                                 const Estimate& estimate, const Observation& observation) const;
  /// For so long fixes have to agree with each other and with the motion; infinite: a person has to decide.
  [[nodiscard]] double agreement_needed_s(const SensorConfig& config, const Estimate& estimate,
                                          const Observation& observation) const;
  /// A velocity that shows the level is wrong by so much. Where that happens again soon after level and
  /// velocity got room, biases of the inertial unit are wrong.
  void doubt_biases(const Setup& setup, Estimate& estimate, double wrong_m2_s2);
  /// The estimate was put where it is by a step, and so may have to go back.
  [[nodiscard]] bool stepped_lately(const SensorConfig& config, const Estimate& estimate) const;

  std::uint32_t reset_counter_ = 0;
  Eigen::Vector3d last_reset_N_m_ = Eigen::Vector3d::Zero();
  TimeNs levelled_ns_ = 0;    ///< last time that the level got room, 0: never
  TimeNs stepped_ns_ = 0;     ///< last step of the position, 0: none
  double stepped_m_ = 0.0;    ///< how far it and those shortly before went, horizontally
  double stepped_m_s_ = 0.0;  ///< and by how much the velocity of the fix differed, at most
};

}  // namespace fathom::estimation
