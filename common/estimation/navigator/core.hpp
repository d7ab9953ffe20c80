#pragma once

#include <optional>

#include "estimation/aiding/registry.hpp"
#include "estimation/alignment/drop_alignment.hpp"
#include "estimation/alignment/rest_window.hpp"
#include "estimation/alignment/under_way.hpp"
#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/gate.hpp"
#include "estimation/filter/strapdown.hpp"
#include "estimation/hydro/water_velocity.hpp"
#include "estimation/navigator/measurement.hpp"
#include "samples/nav_state.hpp"

namespace fathom::estimation {

inline constexpr int kMaxSensors = 24;
/// DVLs whose water layer is judged beside the bottom.
inline constexpr int kMaxWaterLayers = 4;

/// What never changes after construction: the configuration and what is made from it once.
struct Setup {
  explicit Setup(const EngineConfig& engine_config);

  EngineConfig config;
  StateIndex index;
  std::array<GateLimits, kMaxSensors> limits{};
  std::array<int, kMaxSensors> water_layer{};  ///< of each DVL a number; -1: none
  SensorConfig constraint_gate;                ///< how what no instrument measures is gated
  GateLimits constraint_limits;
  std::array<double, kMaxStates> initial_sigma{};  ///< of the states from index 9 on
  std::array<double, kMaxStates> walk{};
  std::array<double, kMaxStates> decay_per_s{};
  StateDrift drift;                                    ///< of walk and decay_per_s
  geo::Quaternion q_B_imu;                             ///< from the unit's own axes into B
  std::optional<hydro::VelocityModel> velocity_model;  ///< where it is switched on
  SensorConfig model_gate;  ///< for it: nothing is widened or believed in the end because it insists
  GateLimits model_limits;
};

/// What was wrong with inertial samples that were refused since the one before. They move nothing, but what
/// averages must not trust an interval in which the instrument was not well.
enum class ImuFault : std::uint8_t { none = 0, not_finite = 1, stale = 2 };

/// One inertial interval as the mechanisation takes it. Increments are along B, not yet corrected for bias.
struct ImuStep {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
  Increments increments;
  double gap_s = 0.0;  ///< part of the interval during which nothing was measured
  ImuFault fault = ImuFault::none;
};

/// The row looks at one of the three states from `first_state` on.
[[nodiscard]] bool measures(const Observation& observation, int row, int first_state);

/// What may have happened while nothing was measured: standard deviations along each axis.
struct GapSigma {
  GapSigma(const ImuConfig& imu, double gap_s)
      : position_m(0.5 * imu.gap_acceleration_sigma_m_s2 * gap_s * gap_s),
        velocity_m_s(imu.gap_acceleration_sigma_m_s2 * gap_s),
        angle_rad(imu.gap_rate_sigma_rad_s * gap_s) {}
  double position_m;
  double velocity_m_s;
  double angle_rad;
};

/// The axes O that are published, B or the wheels', and how well they are known.
struct OutputAttitude {
  geo::Quaternion q_NO;
  Eigen::Matrix3d covariance_N = Eigen::Matrix3d::Zero();  ///< of their attitude error about N, rad^2
  std::optional<Eigen::Matrix3d> C_BO;                     ///< none where they are B itself

  /// A vector given along B, along these axes.
  [[nodiscard]] Eigen::Vector3d along(const Eigen::Vector3d& a_B) const {
    return C_BO ? Eigen::Vector3d(C_BO->transpose() * a_B) : a_B;
  }
};

/// Why a start is not possible yet, or that it is.
struct StartConditions {
  bool window_full = false;
  bool quiet = false;
  bool slow = false;
  bool heading = false;
  bool position = false;
};

/// The navigator as a value: a deterministic function of the inertial steps and events applied to it so far.
/// Copying it is taking a snapshot; that is what makes late measurements possible (history.hpp). Nothing here
/// knows about arrival order, verdict queues or wall clocks.
class Core {
 public:
  /// What is remembered about one sensor.
  struct Sensor {
    bool enabled = true;
    TimeNs stamp_ns = 0;  ///< of the last measurement, 0 before the first
    TimeNs used_ns = 0;
    // Readings that repeat.
    std::array<double, 3> reading{kUnknown, kUnknown, kUnknown};
    Eigen::Vector3d first_prediction = Eigen::Vector3d::Zero();
    bool repeats = false;
    // Rejections that agree with each other.
    struct Rejections {
      TimeNs since_ns = 0;
      int count = 0;
      std::array<double, Observation::kMaxRows> innovation{};
    };
    /// Of each row where rows are judged alone, else all of them in the first.
    std::array<Rejections, Observation::kMaxRows> rejections{};
    // Refused fixes of a position that may yet prove right: the way by the velocity less that of the fixes.
    struct Candidate {
      TimeNs refused_since_ns = 0;  ///< the first refusal since the last use
      TimeNs since_ns = 0;          ///< of those that agree with each other and the motion; 0: none
      TimeNs last_ns = 0;
      int count = 0;
      geo::Geodetic origin;  ///< the estimate at the first
      Eigen::Vector2d first_N_m = Eigen::Vector2d::Zero();
      Eigen::Vector2d last_N_m = Eigen::Vector2d::Zero();
    };
    Candidate candidate;
  };

  explicit Core(const Setup& setup);

  /// Integrates within the interval, from now_ns() until an instant in it.
  void advance(const ImuStep& step, TimeNs until_ns);
  /// Called once at the end of each interval: alignment, phases, zero velocity.
  void finish(const ImuStep& step);
  /// Applies one event at the present instant.
  Judgement apply(const Measurement& measurement);
  /// `used` when it is done. `rejected` when it is a position that is held until it is confirmed; innovation
  /// is the way to it (m, north and east), `limit` how long that may be, test_ratio its length over that.
  Judgement order(const Command& command);
  /// Starts at `now_ns` from a given state.
  void start(const InitialState& initial, TimeNs now_ns);
  /// Another estimate for the present instant, as the smoother has it.
  void replace(const FilterState& state, const ErrorFilter& filter);
  void record_to(FilterTape* tape) { filter_.record_to(tape); }
  /// Puts the present instant elsewhere on the time axis, after a step of the stamps.
  void rebase(TimeNs now_ns, double unobserved_s);

  [[nodiscard]] bool navigating() const { return navigating_; }
  /// Only a state from outside can start it: what the configuration says, and no release has happened yet.
  [[nodiscard]] bool waits_for_state() const;
  /// Roll and pitch are still those of the in-motion alignment after a drop.
  [[nodiscard]] bool dropping() const { return dropping_; }
  [[nodiscard]] const DropAlignment& drop() const { return drop_; }
  [[nodiscard]] bool levelled() const { return levelled_; }
  [[nodiscard]] TimeNs now_ns() const { return now_ns_; }
  [[nodiscard]] const FilterState& state() const { return state_; }
  [[nodiscard]] const ErrorFilter& filter() const { return filter_; }
  [[nodiscard]] const Eigen::Vector3d& rate_B_rad_s() const { return rate_B_; }
  [[nodiscard]] const Eigen::Vector3d& force_B_m_s2() const { return force_B_; }
  [[nodiscard]] AlignmentPhase phase() const { return phase_; }
  [[nodiscard]] TimeNs phase_since_ns() const { return phase_since_ns_; }
  [[nodiscard]] TimeNs aligned_hold_since_ns() const { return hold_since_ns_; }
  [[nodiscard]] const RestWindow& window() const { return window_; }
  [[nodiscard]] StartConditions conditions() const;
  [[nodiscard]] double gps_speed_m_s() const { return gps_speed_m_s_; }
  [[nodiscard]] NavMode mode() const;
  /// Since the last use, NaN before the first.
  [[nodiscard]] double gps_outage_s() const { return since(gps_used_ns_); }
  [[nodiscard]] double dvl_outage_s() const { return since(dvl_used_ns_); }
  [[nodiscard]] std::uint32_t reset_counter() const { return reset_counter_; }
  [[nodiscard]] const Eigen::Vector3d& last_reset_N_m() const { return last_reset_N_m_; }
  /// Sigmas of roll, pitch and yaw of the axes that are published.
  [[nodiscard]] Eigen::Vector3d rpy_sigma_rad() const;
  [[nodiscard]] const Sensor& sensor(int index) const { return sensors_[static_cast<std::size_t>(index)]; }
  /// Of a DVL, what is measured against the water; null for others.
  [[nodiscard]] const Sensor* water_layer(int index) const {
    const int layer = setup_->water_layer[static_cast<std::size_t>(index)];
    return layer < 0 ? nullptr : &water_layers_[static_cast<std::size_t>(layer)];
  }
  /// That of a step with this attitude, rate and force.
  [[nodiscard]] ProcessNoise process_noise(const Eigen::Matrix3d& C_NB, const Eigen::Vector3d& rate_B_rad_s,
                                           const Eigen::Vector3d& force_B_m_s2) const;
  [[nodiscard]] const hydro::WaterVelocity& water_velocity() const { return water_; }
  /// Adds to `filter` what the settling biases move by in `dt_s` from `ahead_s` after now on.
  void settle_biases(ErrorFilter& filter, double ahead_s, double dt_s) const;

  // core_output.cpp
  [[nodiscard]] OutputAttitude output_attitude() const;

  /// For archives: see fields/core.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  [[nodiscard]] double since(TimeNs stamp_ns) const {
    return stamp_ns == 0 ? kUnknown : to_seconds(now_ns_ - stamp_ns);
  }
  [[nodiscard]] AidingState aiding_state() const;
  void enter(AlignmentPhase phase);
  void lose_attitude();
  /// No instant that is remembered lies after now.
  [[nodiscard]] bool remembers_the_past_only() const;

  // core_judge.cpp
  Judgement judge(const Measurement& measurement);
  /// What is known of the instrument behind a measurement.
  [[nodiscard]] Sensor& instrument_of(const Measurement& measurement);
  Judgement place(const Command& command);
  /// The same position was held, and this order confirms it.
  [[nodiscard]] bool is_confirmed(const Command& command, const geo::Geodetic& ordered) const;
  bool frozen(const Measurement& measurement, const SensorConfig& config, Sensor& sensor,
              const Observation& observation) const;

  // core_reacquire.cpp
  /// Rows, as a set of bits, whose refusal is not to be believed any longer.
  unsigned believed_rows(Sensor& sensor, const SensorConfig& config, const Observation& observation,
                         unsigned refused, bool fix);
  /// A fix behind an outage, too far off to be believed by itself.
  [[nodiscard]] bool on_probation(const SensorConfig& config, const Observation& observation) const;
  /// Refused fixes agree with each other and with the motion for long enough.
  bool believe_fix(Sensor::Candidate& candidate, const SensorConfig& config,
                   const Observation& observation) const;
  /// For so long fixes have to agree with each other and with the motion; infinite: a person has to decide.
  [[nodiscard]] double agreement_needed_s(const SensorConfig& config, const Observation& observation) const;
  /// Fixes of this receiver were refused for so long that a person should know.
  [[nodiscard]] bool disputed(const Sensor& sensor, const SensorConfig& config) const;
  /// The estimate was put where it is by a step, and so may have to go back.
  [[nodiscard]] bool stepped_lately(const SensorConfig& config) const;
  /// Of the position, from before to after; by a fix, or null.
  void note_step(const Eigen::Vector3d& step_N_m, const Observation* fix);
  /// Weighs the fix down until the position moves no further than allowed; whether it had to.
  bool bound_step(const SensorConfig& config, Observation& observation,
                  InnovationStatistics& statistics) const;
  bool believe(Sensor::Rejections& past, const SensorConfig& config, const Observation& observation,
               int first, int end) const;
  /// Variance that these rows ask for, added to `variance`.
  void make_room(SourceKind source, const Sensor& sensor, const Observation& observation, unsigned rows,
                 double factor, std::array<double, kNavStates>& variance) const;
  /// What is measured along the vehicle's own axes: over ground while a DVL does, else through the water.
  [[nodiscard]] Eigen::Vector3d velocity_of_log(const Measurement& measurement) const;
  void mark_used(const Measurement& measurement, bool with_position);

  // core_constraints.cpp
  void apply_constraints(const ImuStep& step);
  void constrain(Observation& observation);
  void apply_zero_velocity();

  // core_model.cpp: the vehicle's own dynamics as a virtual velocity log.
  /// True when the sample drives the model.
  bool drive_model(const Measurement& measurement);
  void foretell_velocity(const ImuStep& step);
  struct ModelTrial {
    bool usable = false;  ///< it has settled, and is that of where the vehicle is
    bool believed = false;
    bool fits = false;  ///< its gate would pass it
  };
  /// Notes how the model did beside the DVL.
  ModelTrial consider_model(const AidingState& state, const PropulsionSample& sample);

  // core_align.cpp
  void align(const ImuStep& step);
  void notice(const Measurement& measurement);
  void start_at_rest();
  void start_in_motion();

  // core_under_way.cpp
  void notice_under_way(const Measurement& measurement, const SensorConfig& config);
  [[nodiscard]] bool can_start_under_way() const;
  /// Only an acoustic fix says where the vehicle is.
  [[nodiscard]] bool usbl_places() const;
  void start_under_way();

  // core_drop.cpp
  void start_drop(const InitialState& initial);
  /// Tilt is found again under way; heading, velocity and position are carried on, over `unobserved_s`
  /// without inertial samples as they were.
  void restart_drop(double tilt_sigma_rad, double unobserved_s);
  /// What the configuration says of a drop and what follows from it.
  [[nodiscard]] DropConfig drop_config() const;
  void begin_drop(const DropConfig& config);
  /// After a gap in which the attitude was lost; false where the heading is lost with it.
  bool resume_drop(double gap_s);
  void widen_drop(const GapSigma& sigma);
  void advance_drop(const ImuStep& step);
  [[nodiscard]] std::optional<Judgement> feed_drop(const Measurement& measurement);
  /// The attitude was turned: what was integrated with it turns along.
  void turn_drop(const Eigen::Vector3d& rotation_N_rad);
  void carry_drop_covariance();
  /// The position was set from outside along the first `axes` of N.
  void place_drop(int axes, double sigma_m);
  void hand_over_drop();

  // core_align.cpp
  void begin(const FilterState& state, const std::array<double, kMaxStates>& sigma);
  [[nodiscard]] std::optional<geo::Geodetic> start_position() const;
  void watch_alignment();

  const Setup* setup_;
  TimeNs now_ns_ = 0;
  bool navigating_ = false;
  bool levelled_ = false;
  TimeNs began_ns_ = 0;  ///< when navigation did
  FilterState state_;
  ErrorFilter filter_;
  Eigen::Vector3d rate_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d travelled_N_m_ = Eigen::Vector3d::Zero();  ///< integral of the velocity
  std::array<Sensor, kMaxSensors> sensors_{};
  /// One ping of a DVL measures the bottom and the water layer, both of one stamp: two instruments in one.
  std::array<Sensor, kMaxWaterLayers> water_layers_{};
  TimeNs gps_used_ns_ = 0;
  TimeNs usbl_used_ns_ = 0;
  TimeNs dvl_used_ns_ = 0;
  TimeNs bottom_used_ns_ = 0;  ///< of its velocities those over ground
  TimeNs velocity_used_ns_ = 0;
  std::uint32_t reset_counter_ = 0;
  Eigen::Vector3d last_reset_N_m_ = Eigen::Vector3d::Zero();
  TimeNs stepped_ns_ = 0;     ///< last step of the position, 0: none
  double stepped_m_ = 0.0;    ///< how far it and those shortly before went, horizontally
  double stepped_m_s_ = 0.0;  ///< and by how much the velocity of the fix differed, at most
  TimeNs rest_until_ns_ = 0;
  TimeNs next_zero_velocity_ns_ = 0;
  hydro::WaterVelocity water_;

  // Alignment.
  AlignmentPhase phase_ = AlignmentPhase::none;
  TimeNs phase_since_ns_ = 0;
  TimeNs waiting_since_ns_ = 0;
  TimeNs hold_since_ns_ = 0;
  RestWindow window_;
  Eigen::Vector3d smooth_force_ = Eigen::Vector3d::Zero();
  double smooth_time_s_ = 0.0;
  TimeNs gps_seen_ns_ = 0;
  geo::Geodetic gps_position_;
  Eigen::Vector3d gps_velocity_N_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gps_sigma_N_m_ = Eigen::Vector3d::Zero();
  double gps_speed_m_s_ = kUnknown;
  int fast_fixes_ = 0;
  UnderWay under_way_;
  bool released_ = false;  ///< from an aircraft; what is lost after that is found again by whatever there is
  bool dropping_ = false;
  bool regained_ = false;  ///< begun anew after a loss: the velocity is then that through the water
  DropAlignment drop_;
  // Since the release: integrals of C f, once and twice; covariance of position and velocity as if the
  // attitude were known, at the instant given.
  Eigen::Vector3d fall_dv_N_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d fall_dp_N_ = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> fall_covariance_ = Eigen::Matrix<double, 6, 6>::Zero();
  double fall_s_ = 0.0;
  double carried_s_ = 0.0;
  bool position_set_ = false;  ///< by an order
  geo::Geodetic set_position_;
  double set_sigma_m_ = 0.0;
  TimeNs held_ns_ = 0;           ///< of an ordered position that waits for its confirmation; 0: none
  geo::Geodetic held_position_;  ///< without altitude
};

}  // namespace fathom::estimation
