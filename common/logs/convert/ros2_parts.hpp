#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "logs/convert/build.hpp"
#include "logs/convert/vehicle.hpp"
#include "logs/series.hpp"

/// What the conversions of ROS 2 messages share: their instants and their axes.
namespace fathom::logs {

/// Stamps of messages. An instrument's own stamp, header.stamp, is when its measurement holds; the log time
/// is when it arrived. The stamps of a topic that are of another clock than the log's are not used, unless
/// all topics' are of one other clock: a simulation's.
class Ros2Clock {
 public:
  Ros2Clock(const Log& log, const ConvertOptions& options, Vehicle& vehicle);
  /// Nothing where the row has no stamp that can be used.
  [[nodiscard]] std::optional<SampleHeader> header(const Series& series, std::size_t row) const;
  /// header.stamp by its own clock; nothing where there is none.
  [[nodiscard]] std::optional<TimeNs> stamp_ns(const Series& series, std::size_t row) const;

 private:
  enum class Use : std::uint8_t { both, log_time, stamp };
  struct Place {
    std::optional<std::size_t> seconds, nanoseconds;
    Use use = Use::both;
  };
  const Log& log_;
  std::map<const Series*, Place> places_;
  TimeNs shift_ns_ = 0;  // from the log's clock to the data set's
};

/// How a topic's axes lie in the body's.
struct Mounting {
  Eigen::Matrix3d C_BS = Eigen::Matrix3d::Identity();  ///< the message's axes to forward-right-down
  bool turned = false;                                 ///< apart from the convention of its axes
  bool ned = false;  ///< world coordinates of this topic are north-east-down
  std::string how;   ///< in words
};

class Ros2Frames {
 public:
  Ros2Frames(const Log& log, const ConvertOptions& options);
  /// `frame`: which the message's vectors are in. `by_default`: axes where neither an option nor the frame's
  /// name tells.
  [[nodiscard]] Mounting of(const Series& series, const std::string& frame,
                            Ros2Options::Axes by_default = Ros2Options::Axes::flu) const;
  /// Where the frame's origin is in the body, forward-right-down, m. Nothing where the log does not tell.
  [[nodiscard]] std::optional<Eigen::Vector3d> lever_B_m(const std::string& frame) const;

 private:
  struct Pose {
    Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    std::string root;
  };
  [[nodiscard]] Pose to_root(std::string frame) const;
  [[nodiscard]] std::optional<Pose> in_base(const std::string& frame) const;

  const Ros2Options& options_;
  std::map<std::string, const Placement*> parents_;  // by child
};

/// The columns STEM.x, .y, .z; nothing when one is missing.
[[nodiscard]] std::optional<std::array<std::size_t, 3>> xyz_of(const Series& series, const std::string& stem);
[[nodiscard]] Eigen::Vector3d vector_at(const Series& series, std::size_t row,
                                        const std::array<std::size_t, 3>& xyz);
/// Of a variance: unknown where it is not above 0.
[[nodiscard]] double sigma_of(double variance);
/// The series of a type; all types that end so.
[[nodiscard]] std::vector<const Series*> of_type(const Log& log, std::string_view type);
/// Its topic, with the instance where the topic has several.
[[nodiscard]] std::string ros2_label(const Log& log, const Series& series);
/// Whether a topic or its frames are called after something.
[[nodiscard]] bool is_called(const Series& series, std::string_view word);

/// Velocities of a vehicle in a message of any of these types.
struct Twist {
  const Series* series = nullptr;
  std::array<std::size_t, 3> linear{};
  std::optional<std::array<std::size_t, 3>> variance{};
};
[[nodiscard]] std::optional<Twist> twist_of(const Series& series);

/// gps.csv of NavSatFix, with the velocity that a twist of the same receiver gives. Returns that twist's
/// series.
const Series* ros2_gps(const Log& log, const Ros2Clock& clock, const ConvertOptions& options, Vehicle& out);
/// dvl.csv of a DVL's messages, or of a twist or odometry that is called so or chosen.
void ros2_velocity(const Log& log, const Ros2Clock& clock, const Ros2Frames& frames, const Series* of_gps,
                   const ConvertOptions& options, Vehicle& out);

}  // namespace fathom::logs
