#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "estimation/navigator/inertial_step.hpp"
#include "estimation/navigator/measurement.hpp"
#include "estimation/navigator/plausibility/axes_fit.hpp"
#include "estimation/navigator/plausibility/pair_fit.hpp"
#include "estimation/navigator/plausibility/tilt_fit.hpp"
#include "estimation/navigator/setup.hpp"

namespace fathom::estimation {

/// What cannot be right.
enum class Implausible : std::uint8_t {
  none = 0,
  force_in_g,       ///< at rest the specific force is 1, not 9.8
  force_downwards,  ///< at rest it is felt downwards
  force_along_x,    ///< gravity lies along x
  force_along_y,
  imu_rate,      ///< another rate than was said
  gyro_negated,  ///< turns against compass or course
  gyro_axes,     ///< turns otherwise than gravity; `value` is the number of the exchange, see AxesHypothesis
  gyro_in_degrees,
  gyro_too_slow,  ///< rad/s taken for deg/s
  gps_axes,       ///< its velocity does not go along its positions
  gps_unit,
  dvl_unit,    ///< its speed is not that of GPS
  dvl_turned,  ///< its velocity does not point where that of GPS does
  dvl_mirrored,
  depth_unit,  ///< does not change as the vehicle goes down
  depth_upwards,
  heading_unit,     ///< turns 57 times less than gyro and course: radians taken for degrees
  heading_negated,  ///< turns against gyro and course
  gps_place_unit,   ///< its positions go 57 times less far than its velocity: radians taken for degrees
};
inline constexpr std::size_t kImplausibles = static_cast<std::size_t>(Implausible::gps_place_unit) + 1;
[[nodiscard]] std::string_view to_string(Implausible kind);

/// `value`: the factor that what is measured has to be multiplied by, the angle it has to be turned by (rad),
/// or the rate found (Hz).
struct PlausibilityFinding {
  Implausible kind = Implausible::none;
  double value = 0.0;
  explicit operator bool() const { return kind != Implausible::none; }
};

/// One sentence: what it is, and the axis, the factor or the turn that would make it right. Zero-terminated.
void write_sentence(const PlausibilityFinding& finding, double nominal_rate_hz, std::array<char, 128>& out);

/// Holds the instruments against each other and against gravity, as they are configured, and says which of a
/// few mistakes explains them by far better (PLAUS-1). A deterministic function of steps and measurements; a
/// value of fixed size. What a configuration says is believed until then.
class Plausibility {
 public:
  /// At the end of each inertial interval.
  void add(const Setup& setup, const ImuStep& step, TimeNs now_ns);
  /// Each measurement at its instant. `attitude`: of the estimate, none while its heading is not known.
  void measured(const Setup& setup, const Measurement& measurement, const TrustedAttitude* attitude,
                TimeNs now_ns);
  /// The sums go on, but no pair spans what was not measured.
  void interrupt();
  /// All evidence.
  void forget() { *this = Plausibility(); }

  [[nodiscard]] const PlausibilityFinding& finding() const { return finding_; }
  /// What gravity and the clock tell of the inertial unit, whether it moves or not, has been heard.
  [[nodiscard]] bool has_heard() const { return unheard_s() <= 0.0; }
  [[nodiscard]] double unheard_s() const {
    return vouched_ || sound_ ? 0.0 : std::max(0.0, kHeard_s - interval_s_);
  }
  /// Something that cannot be claimed yet speaks against the configuration: what nobody should rely on.
  [[nodiscard]] bool is_doubted() const;
  /// The attitude is another's, who has heard.
  void vouch() { vouched_ = true; }

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.compass_.from_ns);
    visit(self.course_.from_ns);
    visit(self.track_.from_ns);
    visit(self.track_.last_ns);
    visit(self.depth_.from_ns);
    visit(self.dvl_ns_);
    visit(self.heading_ns_);
    visit(self.speed_ns_);
    visit(self.gain_.from_ns);
    visit(self.gain_.newest_ns);
  }

  /// For archives: see fields/plausibility.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);
  /// Those that came with version 8 and later.
  template <class Archive, class Self>
  static void later_fields(Archive& archive, Self& self);

 private:
  static constexpr double kHeard_s = 5.0;

  /// A direction at the begin of a pair, and the turn by the gyro since.
  struct Turn {
    TimeNs from_ns = 0;
    double angle_rad = 0.0;
    double turned_rad = 0.0;
    PairFit fit;
  };
  struct Track {
    TimeNs from_ns = 0;
    TimeNs last_ns = 0;
    double latitude_rad = 0.0;
    double longitude_rad = 0.0;
    Eigen::Vector2d velocity_m_s = Eigen::Vector2d::Zero();
    Eigen::Vector2d way_m = Eigen::Vector2d::Zero();
    PairFit fit;
  };
  /// How velocities of GPS change between the ends of two blocks of force.
  struct Gain {
    TimeNs from_ns = 0;  ///< of the newest one as the block before ended
    TimeNs newest_ns = 0;
    Eigen::Vector2d from_N_m_s = Eigen::Vector2d::Zero();
    Eigen::Vector2d newest_N_m_s = Eigen::Vector2d::Zero();
    double noise_m_s = 0.0;  ///< of one component
    /// Of the last block, and its variance, both components together; 0 where it is not known.
    Eigen::Vector2d acceleration_N_m_s2 = Eigen::Vector2d::Zero();
    double variance_m2_s4 = 0.0;
    /// At the end of a block.
    void close(TimeNs now_ns);
  };
  struct Dive {
    TimeNs from_ns = 0;
    double depth_m = 0.0;
    double way_m = 0.0;   ///< down, by the DVL
    double path_m = 0.0;  ///< its length
    PairFit fit;
  };

  void take(const Setup& setup, const SensorConfig& config, const GpsSample& gps,
            const TrustedAttitude* attitude, TimeNs now_ns);
  void take(const Setup& setup, const SensorConfig& config, const HeadingSample& heading, TimeNs now_ns);
  void take(const SensorConfig& config, const DvlSample& dvl, TimeNs now_ns);
  void take(const SensorConfig& config, const DepthSample& depth, TimeNs now_ns);
  /// Closes a pair where it has lasted, with `sigma_rad` of each end.
  void turn(Turn& turn, double angle_rad, double sigma_rad, double share, TimeNs now_ns);
  void feel(const Setup& setup, double dt_s, const Eigen::Vector3d& force_B_m_s2, double rate_rad_s,
            TimeNs now_ns);
  /// Positions of GPS and the way that its velocities make between them.
  void follow(const SensorConfig& config, const GpsSample& gps, const Eigen::Vector2d& v_N_m_s,
              double noise_m_s, TimeNs now_ns);
  void judge(const Setup& setup);
  struct Best;
  /// What pairs of figures say, and with them the tilts.
  void explain(const Proof& proof, const OtherAxes& by_tilts, Best& best) const;
  /// What has been claimed is still more likely than the configuration.
  [[nodiscard]] bool stands() const;
  /// By how much of itself a count of samples is another one than the configured rate gives.
  [[nodiscard]] double off(const Setup& setup, double count) const;
  /// What gravity alone says, and whether that says that nothing else can be judged.
  [[nodiscard]] bool judge_force();

  PlausibilityFinding finding_;
  bool vouched_ = false;
  bool upright_ = false;  ///< gravity was felt upwards for seconds
  bool sound_ = false;    ///< gravity was felt upwards, at the rate that is configured
  Eigen::Vector3d down_B_ = Eigen::Vector3d::Zero();  ///< against the smoothed force; zero: none yet
  double felt_s_ = 0.0;
  double felt_rate_rad_s_ = 0.0;
  Eigen::Vector3d felt_m_s_ = Eigen::Vector3d::Zero();
  double in_g_s_ = 0.0;       ///< for how long the mean force has been one
  double downwards_s_ = 0.0;  ///< or felt downwards
  double upwards_s_ = 0.0;    ///< as it should be
  double along_x_s_ = 0.0;    ///< or along another axis than down
  double along_y_s_ = 0.0;
  Eigen::Vector3d felt_turn_rad_ = Eigen::Vector3d::Zero();
  AxesFit axes_;
  TiltFit tilts_;
  TimeNs speed_ns_ = 0;
  double speed_m_s_ = 0.0;
  Gain gain_;
  double interval_s_ = 0.0;  ///< sum of inertial intervals
  double intervals_ = 0.0;
  double slots_ = 0.0;  ///< at the configured rate, lost samples too
  TimeNs dvl_ns_ = 0;
  Eigen::Vector3d dvl_velocity_B_m_s_ = Eigen::Vector3d::Zero();
  TimeNs heading_ns_ = 0;
  double heading_rad_ = 0.0;
  Turn compass_;
  Turn course_;
  Track track_;
  Dive depth_;
  PairFit speed_;   ///< of DVL and GPS
  PairFit ground_;  ///< velocity of DVL, turned by the compass, and GPS
  PairFit mirror_;  ///< the same with the DVL's y negated
};

}  // namespace fathom::estimation
