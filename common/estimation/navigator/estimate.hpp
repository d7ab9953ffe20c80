#pragma once

#include <optional>

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "estimation/aiding/model.hpp"
#include "estimation/aiding/policy.hpp"
#include "estimation/doubt/bias_prior.hpp"
#include "estimation/doubt/motion_noise.hpp"
#include "estimation/doubt/slow_error.hpp"
#include "estimation/doubt/start_heading.hpp"
#include "estimation/filter/error_filter.hpp"
#include "estimation/navigator/inertial_step.hpp"
#include "estimation/navigator/setup.hpp"

namespace fathom::estimation {

/// What is believed of the vehicle at an instant: state, covariance, rate and specific force. Every part of
/// the navigator acts on it; what only one part needs is kept there.
struct Estimate {
  explicit Estimate(const Setup& setup)
      : filter(setup.index),
        bias_prior(setup.index),
        motion_noise(setup.index.estimated()),
        slow_gps(setup.index, Group::gps_position_bias, setup.initial_sigma),
        slow_usbl(setup.index, Group::usbl_bias, setup.initial_sigma),
        slow_antennas(setup.index, Group::antenna_bias, setup.initial_sigma) {}

  TimeNs now_ns = 0;
  bool navigating = false;  ///< state and filter are an estimate
  bool levelled = false;    ///< roll and pitch of the state are
  TimeNs began_ns = 0;      ///< when navigation did
  FilterState state;
  ErrorFilter filter;
  Eigen::Vector3d rate_B_rad_s = Eigen::Vector3d::Zero();  ///< against the stars, bias-corrected
  Eigen::Vector3d force_B_m_s2 = Eigen::Vector3d::Zero();  ///< specific force, bias-corrected
  /// Felt for so long that the gyro biases have learned what it does to the gyros (NOISE-4).
  Eigen::Vector3d usual_force_B_m_s2{0.0, 0.0, -kStandardGravity_m_s2};
  Eigen::Vector3d travelled_N_m = Eigen::Vector3d::Zero();  ///< integral of the velocity
  StartHeading start_heading;
  BiasPrior bias_prior;
  MotionNoise motion_noise;
  SlowError slow_gps;
  SlowError slow_usbl;
  SlowError slow_antennas;
  Stride stride;  ///< by which the filter is behind the state

  /// Seconds since an instant; unknown when it is 0, which stands for never.
  [[nodiscard]] double since(TimeNs stamp_ns) const {
    return stamp_ns == 0 ? kUnknown : to_seconds(now_ns - stamp_ns);
  }
  /// All of it are numbers, and the position is one on Earth.
  [[nodiscard]] bool is_sound() const;
  /// Integrates within the interval, from now_ns until an instant in it. The filter follows in strides.
  void advance(const Setup& setup, const ImuStep& step, TimeNs until_ns);
  /// Lets the filter follow to now: before anything is done with its covariance but to show it.
  void follow(const Setup& setup);
  /// Adds to `covariance` what moves biases in `dt_s` from `ahead_s` after now on, beside the drift of the
  /// setup: those that settle (NOISE-2), and a slow error that is larger than configured (GATE-13).
  void drive_biases(const Setup& setup, ErrorFilter& covariance, double ahead_s, double dt_s) const;
  /// Something may have happened while nothing was measured.
  void widen(const GapSigma& sigma);
  /// The heading has drifted by more than the filter knew, and so has what hangs on it; where the vehicle
  /// went meanwhile is uncertain by as much, along and across, and stays where it is (GATE-3).
  void widen_heading(double variance_rad2);
  /// Takes a gated measurement in and moves the state by the estimated error `x` (KF-3 to KF-5). `along`: of
  /// what is measured along the vehicle. False, with nothing changed, when the statistics are not positive.
  bool update(const Setup& setup, const Observation& observation, const InnovationStatistics& statistics,
              VelocityOver along, ShowsStart shows, std::array<double, kMaxStates>& x);
  /// The heading of the start was wrong (GATE-9): takes out what that has done since. Adds to `x` what the
  /// state is moved by.
  void correct_start(const Setup& setup, VelocityOver along, std::array<double, kMaxStates>& x);
  /// A bias of the inertial unit is larger than is said of it (GATE-11): takes back what was concluded from
  /// what is said. Adds to `x` what the state is moved by. False, with nothing changed, if none is.
  bool correct_bias(const Setup& setup, VelocityOver along, std::array<double, kMaxStates>& x);
  /// The slow error that is this state has this variance, and was taken for less (GATE-13): as
  /// correct_bias().
  bool correct_slow_error(const Setup& setup, int error, double variance_m2, VelocityOver along,
                          std::array<double, kMaxStates>& x);
  /// Another estimate for the same instant, as the smoother has it.
  void replace(const Setup& setup, const FilterState& other, const ErrorFilter& covariance);
  /// What was known of this state is not known any more.
  void forget(int state, double sigma);
  /// What is considered, from this state on, is as uncertain as at the start and shares nothing with others.
  void consider_anew(const Setup& setup, int from);
  /// The filter knows nothing but `sigma`.
  void forget_covariance(const std::array<double, kMaxStates>& sigma);
  /// Begins to navigate: the filter knows nothing but `sigma`.
  void begin(const FilterState& start, const std::array<double, kMaxStates>& sigma);

  [[nodiscard]] AidingState aiding_state(const Setup& setup) const { return aiding_state(setup, state); }
  /// Of another state: that of the instant of a measurement that comes late.
  [[nodiscard]] AidingState aiding_state(const Setup& setup, const FilterState& then) const {
    return {setup.index, then, rate_B_rad_s, setup.magnetic_variation_rad(), force_B_m_s2};
  }
  /// About down.
  [[nodiscard]] double turn_rad_s() const;
  [[nodiscard]] Eigen::Vector3d gyro_bias_rad_s(const Setup& setup) const;
  /// Relative to ground or medium.
  [[nodiscard]] Eigen::Vector3d velocity_N_m_s(const Setup& setup, VelocityOver reference) const;
  /// Horizontal motion of the water or the air, along N; zero where it is not estimated.
  [[nodiscard]] Eigen::Vector3d current_N_m_s(const Setup& setup) const;

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);
  /// Those that came with version 5.
  template <class Archive, class Self>
  static void later_fields(Archive& archive, Self& self);

 private:
  /// Of the variance by which the settling biases move altogether (NOISE-2), what is due in `dt_s` from
  /// `ahead_s` after now on; 0 where none settles.
  [[nodiscard]] double settling_share(const Setup& setup, double ahead_s, double dt_s) const;
  /// Moves the state by the estimated error `x` (KF-4, KF-5). `before_N_m_s`: velocity_N_m_s(), not yet
  /// moved.
  void move(const Setup& setup, const std::array<double, kMaxStates>& x, const Eigen::Vector3d& before_N_m_s,
            VelocityOver along);
  /// The same by `moved`, beside the `x` by which a measurement has moved it: adds it to that.
  void move_further(const Setup& setup, const std::array<double, kMaxStates>& moved,
                    const Eigen::Vector3d& before_N_m_s, VelocityOver along,
                    std::array<double, kMaxStates>& x);
  /// The variance of a state was said too small: P grows by `share` times the square of its column, and the
  /// estimate goes on by as much where it is `beyond` what was expected (GATE-11).
  void take_back(const Setup& setup, int state, double share, double beyond, VelocityOver along,
                 std::array<double, kMaxStates>& x);
  /// (NOISE-4) What the stride's force, where it is not usual, makes of the gyros' g-sensitivity.
  void add_g_sensitivity(const Setup& setup, ProcessNoise& noise);
  /// (NOISE-3) What the products of heading error, tilt and rate leave out of a linear step.
  void add_second_order(const Setup& setup, const Eigen::Matrix3d& C_NB, const Eigen::Vector3d& force_N_m_s2,
                        ProcessNoise& noise) const;
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

// output_axes.cpp
/// (OUT-3)
[[nodiscard]] OutputAttitude output_attitude(const Setup& setup, const Estimate& estimate);
/// (OUT-1) Sigmas of roll, pitch and yaw of those axes, as the filter has them.
[[nodiscard]] Eigen::Vector3d rpy_sigma_rad(const OutputAttitude& output);
[[nodiscard]] Eigen::Vector3d rpy_sigma_rad(const Setup& setup, const Estimate& estimate);

}  // namespace fathom::estimation
