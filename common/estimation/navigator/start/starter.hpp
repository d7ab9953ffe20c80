#pragma once

#include <optional>

#include "estimation/alignment/rest_window.hpp"
#include "estimation/alignment/under_way.hpp"
#include "estimation/alignment/velocity_track.hpp"
#include "estimation/alignment/velocity_window.hpp"
#include "estimation/navigator/estimate.hpp"
#include "estimation/navigator/measurement.hpp"
#include "estimation/navigator/start/alignment_watch.hpp"
#include "estimation/navigator/start/last_place.hpp"
#include "estimation/navigator/start/ordered_position.hpp"

namespace fathom::estimation {

struct MovingStart;

/// A fix that is older does not place the vehicle any more.
inline constexpr double kFreshFix_s = 5.0;
/// A velocity or a heading that is older is not that of now any more.
inline constexpr double kFreshVelocity_s = 1.0;

/// The filter's errors are small angles: a heading that is worse is none to begin with.
inline constexpr double kCoarsestHeading_rad = 0.3;
/// One by accelerations says less of how wrong it is (ALN-24).
inline constexpr double kCoarsestByAcceleration_rad = 0.2;
/// Whether the course of this vehicle is no heading at any speed, so that accelerations have to tell it.
[[nodiscard]] inline bool heads_by_acceleration(const AlignmentConfig& config) {
  return config.in_motion_heading_sigma_rad > kCoarsestHeading_rad && !(config.in_motion_speed_m_s > 0.0);
}

/// Why a start is not possible yet, or that it is.
struct StartConditions {
  bool window_full = false;
  bool quiet = false;
  bool slow = false;
  bool heading = false;
  bool position = false;
};

/// Where a vehicle is that starts, and what says so.
struct StartPlace {
  enum class By : std::uint8_t { gps, order, configuration, acoustics, memory };
  By by = By::gps;
  geo::Geodetic position;  ///< of the point at `lever_B_m`
  Eigen::Vector3d lever_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_N_m = Eigen::Vector3d::Zero();
  double age_s = 0.0;                    ///< by which it is to be carried on
  double surface_altitude_m = kUnknown;  ///< unknown: it is on the surface
  double surface_sigma_m = kUnknown;     ///< unknown: as configured
};

/// What a start is made from, beside what the starter itself remembers.
struct StartInputs {
  const Setup& setup;
  const Estimate& estimate;
  const OrderedPosition& ordered;
};

/// Finds an estimate to begin with: at rest from a quiet window, in motion from the course of GPS, under way
/// from a compass, or from accelerations where the course is no heading. A start after a drop
/// is Descent's.
class Starter {
 public:
  /// Remembers what a start needs; called for every measurement that is not refused outright.
  void collect(const Setup& setup, const Estimate& estimate, const Measurement& measurement);
  /// One inertial step without navigation. True when `estimate`, that of `in`, has begun to navigate with it.
  /// `released`: from an aircraft.
  [[nodiscard]] bool align(const StartInputs& in, bool released, const ImuStep& step, Estimate& estimate,
                           AlignmentWatch& alignment);
  /// Averages must not span a gap.
  void interrupt() {
    window_.reset();
    velocities_.reset();
    forget_accelerations();
  }
  /// The attitude was lost: what was averaged belongs to another one.
  void forget();
  /// GPS has to be heard anew.
  void forget_fix() { gps_seen_ns_ = 0; }
  /// Remembers where a vehicle is that navigates.
  void see(const Setup& setup, const Estimate& estimate) { last_.see(setup, estimate); }
  /// Nothing was measured for so long that the vehicle may have turned anywhere: it does not begin as the
  /// configuration says any more.
  void lose_sight() { out_of_sight_ = true; }
  [[nodiscard]] bool has_lost_sight() const { return out_of_sight_; }

  [[nodiscard]] StartConditions conditions(const StartInputs& in) const;
  [[nodiscard]] const RestWindow& window() const { return window_; }
  /// Of the heading that the motion gives now: by the DVL and GPS, else by the course alone. Unknown without
  /// a fresh velocity of GPS.
  [[nodiscard]] double course_sigma_rad(const StartInputs& in) const;
  /// Of the heading by accelerations; unknown while they say nothing of it.
  [[nodiscard]] double acceleration_heading_sigma_rad() const { return acceleration_heading_sigma_rad_; }
  [[nodiscard]] double gps_speed_m_s() const { return gps_speed_m_s_; }
  /// By the speed of GPS a start under way would be possible.
  [[nodiscard]] bool goes_fast() const { return fast_fixes_ >= kFastFixes; }

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.gps_seen_ns_);
    VelocityWindow::for_each_instant(self.velocities_, visit);
    visit(self.under_way_.heading_ns);
    visit(self.under_way_.dvl_ns);
    visit(self.under_way_.usbl_ns);
    visit(self.under_way_.depth_ns);
    visit(self.last_.seen_ns);
  }

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);
  /// Those that came with version 5, with version 18 and with version 22.
  template <class Archive, class Self>
  static void later_fields(Archive& archive, Self& self);
  template <class Archive, class Self>
  static void place_fields(Archive& archive, Self& self);
  template <class Archive, class Self>
  static void acceleration_fields(Archive& archive, Self& self);

 private:
  void collect_gps(const Setup& setup, const Estimate& estimate, const SensorConfig& config,
                   const GpsSample& gps);

  // starter_place.cpp
  [[nodiscard]] std::optional<StartPlace> place(const StartInputs& in) const;
  [[nodiscard]] StartPlace ordered_place(const StartInputs& in) const;
  [[nodiscard]] StartPlace given_place(const StartInputs& in) const;
  [[nodiscard]] StartPlace acoustic_place(const StartInputs& in) const;
  /// Where navigation or a fix saw it last, as far as it may have moved since.
  [[nodiscard]] StartPlace remembered_place(const StartInputs& in) const;
  /// Below the surface, by a depth that was just heard; none otherwise.
  [[nodiscard]] std::optional<double> heard_depth_m(const Estimate& estimate) const;
  /// Begins with `state`, whose position is that of `place`, carried on to now.
  void begin(const StartInputs& in, const StartPlace& place, const FilterState& state,
             std::array<double, kMaxStates> sigma, Estimate& estimate) const;
  /// A fix at `place` now may be right if the one before was, and the other way round.
  [[nodiscard]] bool agrees(const Setup& setup, const Estimate& estimate, const geo::Geodetic& place,
                            double sigma_m) const;

  // starter_rest.cpp
  [[nodiscard]] bool start_at_rest(const StartInputs& in, Estimate& estimate) const;
  /// Heading of the middle of the window; none where the configuration or the instruments give none.
  struct Heading {
    double heading_rad = 0.0;
    double sigma_rad = 0.0;
    HeadingSource from = HeadingSource::given;
  };
  [[nodiscard]] std::optional<Heading> heading_at_rest(const Setup& setup, const RestResult& rest,
                                                       const Eigen::Vector2d& tilt, double gyro_sigma) const;

  // starter_moving.cpp
  void collect_under_way(const Setup& setup, const Estimate& estimate, const Measurement& measurement,
                         const SensorConfig& config);
  /// What the course of a velocity of GPS is the heading of.
  struct Course {
    Eigen::Vector3d axis_B = Eigen::Vector3d::UnitX();
    double sigma_rad = kUnknown;  ///< between the two, without the noise of GPS's velocity
    double whole_sigma_rad = kUnknown;
    bool by_dvl = false;
  };
  /// By `v_N_m_s` of GPS at `stamp_ns`.
  [[nodiscard]] Course course(const Setup& setup, TimeNs stamp_ns, const Eigen::Vector3d& v_N_m_s,
                              const Eigen::Vector3d& sigma_m_s, const Eigen::Vector3d& rate_B_rad_s) const;
  /// As configured; a heading that was given is that of the first start.
  [[nodiscard]] HeadingSource heading_source(const Setup& setup) const;
  [[nodiscard]] bool hears_compass(const StartInputs& in) const;
  [[nodiscard]] bool can_start_in_motion(const StartInputs& in) const;
  /// False, with nothing done, where what was measured gives no attitude.
  [[nodiscard]] bool start_in_motion(const StartInputs& in, Estimate& estimate) const;
  [[nodiscard]] bool can_start_under_way(const StartInputs& in) const;
  [[nodiscard]] bool start_under_way(const StartInputs& in, Estimate& estimate) const;
  /// By the velocities of GPS; heading from the course where none is given.
  [[nodiscard]] bool start_moving_by(const StartInputs& in, std::optional<double> heading_rad,
                                     double heading_sigma_rad, Estimate& estimate) const;
  /// By how the velocities of GPS change, the newest of which was just marked.
  [[nodiscard]] bool start_by_acceleration(const StartInputs& in, Estimate& estimate);
  /// Begins with what the motion says.
  void begin_moving(const StartInputs& in, const MovingStart& found, Estimate& estimate) const;
  void forget_accelerations() {
    track_.reset();
    acceleration_heading_sigma_rad_ = kUnknown;
  }

  RestWindow window_;
  Eigen::Vector3d smooth_force_ = Eigen::Vector3d::Zero();
  double smooth_time_s_ = 0.0;
  TimeNs gps_seen_ns_ = 0;
  geo::Geodetic gps_position_;
  Eigen::Vector3d gps_velocity_N_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gps_sigma_N_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gps_lever_B_m_ = Eigen::Vector3d::Zero();  ///< of the receiver that said so
  double gps_speed_m_s_ = kUnknown;
  static constexpr int kFastFixes = 2;
  int fast_fixes_ = 0;
  VelocityWindow velocities_;
  VelocityTrack track_;
  double acceleration_heading_sigma_rad_ = kUnknown;
  UnderWay under_way_;
  LastPlace last_;
  bool out_of_sight_ = false;
};

/// What a start is wrong by, per radian that its heading is (GATE-9); `by_compass`: that is wrong by the same
/// from then on.
[[nodiscard]] StartHeading::Column start_error(const StateIndex& index, bool by_compass);

/// Starts at `now_ns` from a given state: where it was measured somewhere else than at the IMU, or earlier,
/// it is carried there.
void begin_given(const Setup& setup, const InitialState& initial, TimeNs now_ns, Estimate& estimate);

}  // namespace fathom::estimation
