#include "ros2_gateway/outputs.hpp"

#include <mutex>
#include <optional>
#include <utility>

#include "ros2/output/messages.hpp"
#include "ros2_gateway/map_frame.hpp"
#include "ros2_gateway/pace.hpp"

namespace fathom::ros2_gateway {
namespace {

using bus::ros2::Publisher;
using bus::ros2::Quality;

Quality quality_of(config::RosQuality word) {
  return word == config::RosQuality::reliable ? Quality::reliable : Quality::sensor_data;
}

/// A topic and its pace; nothing where it is not published.
template <class Message>
struct Outlet {
  Outlet(bus::ros2::Node& node, const config::RosGraphConfig& ros, const config::RosOutputConfig& config)
      : pace(config.rate_hz) {
    if (config.topic.empty()) return;
    publisher = std::make_unique<Publisher<Message>>(node, config::ros_topic(ros.name_space, config.topic),
                                                     quality_of(config.quality));
  }
  [[nodiscard]] bool is_due(TimeNs stamp_ns) { return publisher != nullptr && pace.is_due(stamp_ns); }

  std::unique_ptr<Publisher<Message>> publisher;
  Pace pace;
};

}  // namespace

struct Outputs::Impl {
  Impl(bus::ros2::Node& node, const config::Ros2GatewayConfig& config, TimeNs now_ns)
      : frames(config.frames),
        names{frames.map, frames.odom, frames.base_link},
        noise{config.outputs.angular_rate_sigma_rad_s, config.outputs.specific_force_sigma_m_s2},
        convention(convention_of(frames)),
        odometry(node, config.ros, config.outputs.odometry),
        imu(node, config.ros, config.outputs.imu),
        fix(node, config.ros, config.outputs.fix),
        velocity(node, config.ros, config.outputs.velocity),
        pose(node, config.ros, config.outputs.pose),
        geo_pose(node, config.ros, config.outputs.geo_pose),
        tf(node, config.ros, config.outputs.tf),
        diagnostics(node, config.ros, config.outputs.diagnostics),
        map_origin(node, config::ros_topic(config.ros.name_space, "map_origin"), Quality::latched),
        tf_static(node, "/tf_static", Quality::latched),
        origin(configured_origin(frames)) {
    if (origin) say(map_origin, ros2::map_origin(now_ns, *origin, names));
    ros2::TFMessage fixed;
    for (const config::RosStaticFrame& one : frames.fixed) {
      fixed.transforms.push_back(ros2::transform(
          now_ns, one.parent, one.child, {geo::vec(one.position_m), geo::from_rpy(geo::vec(one.rpy_rad))}));
    }
    if (!fixed.transforms.empty()) say(tf_static, fixed);
  }

  template <class Message>
  void say(Publisher<Message>& publisher, const Message& message) {
    const bool written = publisher.publish(message);
    const std::lock_guard lock(mutex);
    ++(written ? counts.published : counts.not_published);
  }

  void unusable(const std::string& why) {
    const std::lock_guard lock(mutex);
    ++counts.unusable;
    counts.unusable_text = why;
  }

  void begin_anew() {
    odom = {};
    for (Pace* pace :
         {&odometry.pace, &imu.pace, &fix.pace, &velocity.pace, &pose.pace, &geo_pose.pace, &tf.pace})
      pace->begin_anew();
  }

  void take(const NavState& state, TimeNs monotonic_ns) {
    const OneWay::Step step = one_way.step(state.header.stamp_ns, monotonic_ns);
    {
      const std::lock_guard lock(mutex);
      ++counts.states;
      if (step == OneWay::Step::back) ++counts.back_in_time;
      if (step == OneWay::Step::anew) ++counts.begun_anew;
    }
    if (step == OneWay::Step::back) return;
    if (step == OneWay::Step::anew) begin_anew();
    const auto attitude = ros2::attitude_of(state, convention);
    if (!attitude) return unusable(attitude.error().message);
    if (!origin) {
      origin = ros2::place_of(state);
      if (origin) say(map_origin, ros2::map_origin(state.header.stamp_ns, *origin, names));
    }
    const auto motion = origin ? ros2::motion_of(state, convention, *origin)
                               : Result<ros2::Motion>(Error{"there has been no position yet"});
    if (motion) {
      say_motion(motion.value(), attitude.value());
    } else {
      unusable(motion.error().message);
    }
    if (imu.is_due(state.header.stamp_ns)) say(*imu.publisher, ros2::imu(attitude.value(), names, noise));
  }

  void say_motion(const ros2::Motion& motion, const ros2::Attitude& attitude) {
    const TimeNs stamp_ns = motion.map.stamp_ns;
    odom.update(motion.map);
    if (odometry.is_due(stamp_ns))
      say(*odometry.publisher, ros2::odometry(motion, attitude, odom, names, noise));
    if (tf.is_due(stamp_ns)) say_transforms(stamp_ns);
    if (velocity.is_due(stamp_ns)) say(*velocity.publisher, ros2::twist(motion, attitude, names, noise));
    if (pose.is_due(stamp_ns)) say(*pose.publisher, ros2::pose(motion, attitude, names));
    if (fix.is_due(stamp_ns)) say(*fix.publisher, ros2::nav_sat_fix(motion, names));
    if (geo_pose.is_due(stamp_ns)) say(*geo_pose.publisher, ros2::geo_pose(motion, names));
    const std::lock_guard lock(mutex);
    counts.unusable_text.clear();
  }

  void say_transforms(TimeNs stamp_ns) {
    using config::RosTransforms;
    ros2::TFMessage message;
    if (frames.transforms == RosTransforms::both || frames.transforms == RosTransforms::map_to_odom) {
      message.transforms.push_back(ros2::transform(stamp_ns, names.map, names.odom, odom.map_from_odom()));
    }
    if (frames.transforms == RosTransforms::both || frames.transforms == RosTransforms::odom_to_base_link) {
      message.transforms.push_back(
          ros2::transform(stamp_ns, names.odom, names.base_link, odom.odom_from_base()));
    }
    if (!message.transforms.empty()) say(*tf.publisher, message);
  }

  const config::RosFramesConfig frames;
  const ros2::FrameNames names;
  const ros2::RateNoise noise;
  const ros2::Convention convention;
  Outlet<ros2::Odometry> odometry;
  Outlet<ros2::Imu> imu;
  Outlet<ros2::NavSatFix> fix;
  Outlet<ros2::TwistWithCovarianceStamped> velocity;
  Outlet<ros2::PoseWithCovarianceStamped> pose;
  Outlet<ros2::GeoPoseStamped> geo_pose;
  Outlet<ros2::TFMessage> tf;
  Outlet<ros2::DiagnosticArray> diagnostics;
  Publisher<ros2::GeoPoseStamped> map_origin;
  Publisher<ros2::TFMessage> tf_static;
  std::optional<geo::Geodetic> origin;
  OneWay one_way;
  ros2::OdomFrame odom;

  mutable std::mutex mutex;  // of what follows
  OutputCounts counts;
};

Outputs::Outputs(bus::ros2::Node& node, const config::Ros2GatewayConfig& config, TimeNs now_ns)
    : impl_(std::make_unique<Impl>(node, config, now_ns)) {}
Outputs::~Outputs() = default;

void Outputs::take(const NavState& state, TimeNs monotonic_ns) {
  impl_->take(state, monotonic_ns);
}

void Outputs::diagnostics(const ros2::DiagnosticArray& message) {
  if (impl_->diagnostics.publisher != nullptr) impl_->say(*impl_->diagnostics.publisher, message);
}

OutputCounts Outputs::counts() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->counts;
}

}  // namespace fathom::ros2_gateway
