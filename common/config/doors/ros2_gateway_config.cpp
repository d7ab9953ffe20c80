#include "config/doors/ros2_gateway_config.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "base/units.hpp"
#include "config/service_schema.hpp"

namespace fathom::config {
namespace {

constexpr std::size_t kLongestName = 200;
using Fault = std::pair<std::string, std::string>;

/// As ROS 2 names topics: words of letters, digits and '_' that do not begin with a digit, between slashes.
bool is_ros_name(const std::string& text, bool may_be_relative) {
  if (text.empty() || text.size() > kLongestName || (text.front() != '/' && !may_be_relative)) return false;
  bool begins = text.front() != '/';
  for (std::size_t i = begins ? 0 : 1; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : '/';
    const bool first = i == 0 || text[i - 1] == '/';
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (c == '/' ? first : !(letter || (digit && !first))) return false;
  }
  return true;
}
constexpr const char* kTopicForm = "words of letters, digits and '_' between slashes, e.g. imu/data or /tf";

bool is_frame(const std::string& text) {
  return !text.empty() && text.size() <= kLongestName && text.front() != '/' &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 127; });
}
constexpr const char* kFrameForm = "a frame such as base_link, without a slash before it";

/// The first fault of the tree of frames: every frame has one parent, and none is its own ancestor.
Fault fault_of_tree(const RosFramesConfig& frames) {
  std::map<std::string, std::string> parents{{frames.odom, frames.map}, {frames.base_link, frames.odom}};
  if (parents.size() != 2 || frames.map == frames.odom || frames.map == frames.base_link) {
    return {"map", "three different names for map, odom and base_link"};
  }
  for (std::size_t i = 0; i < frames.fixed.size(); ++i) {
    const RosStaticFrame& one = frames.fixed[i];
    const std::string key = "static." + std::to_string(i);
    if (!is_frame(one.parent)) return {key + ".parent", kFrameForm};
    if (!is_frame(one.child)) return {key + ".child", kFrameForm};
    if (one.child == frames.map || !parents.emplace(one.child, one.parent).second) {
      return {key + ".child", "a frame that has no other parent and is not map"};
    }
  }
  for (const auto& [child, parent] : parents) {
    std::string at = parent;
    for (std::size_t steps = 0; parents.contains(at); at = parents.at(at)) {
      if (++steps > parents.size()) return {"static", "a tree: " + child + " is its own ancestor"};
    }
  }
  return {};
}

}  // namespace

std::string ros_topic(const std::string& name_space, const std::string& topic) {
  if (topic.empty() || topic.front() == '/') return topic;
  return (name_space == "/" ? "" : name_space) + "/" + topic;
}

std::string ros_answer_topic(const std::string& topic) {
  return topic + "/answer";
}

void describe(Schema<RosGraphConfig>& s) {
  using C = RosGraphConfig;
  s.field("distro", &C::distro, "the distribution of ROS 2 that the others run, as far as the wire differs")
      .words({{"humble", RosDistro::humble}, {"jazzy", RosDistro::jazzy}, {"kilted", RosDistro::kilted}});
  s.field("domain", &C::domain, "ROS_DOMAIN_ID of the others; may be that of the vehicle network")
      .range(0, 232);
  s.field("interfaces", &C::interfaces, "IPv4 addresses of this host that are bound, nothing else is");
  s.field("peers", &C::peers, "IPv4 addresses asked for discovery besides multicast");
  s.field("namespace", &C::name_space, "of the node and of topics that do not begin with a slash");
  s.field("node", &C::node, "name of the node");
  s.check([](const C& ros) -> Fault {
    if (ros.name_space != "/" && !is_ros_name(ros.name_space, false)) {
      return {"namespace", "/ or words of letters, digits and '_' with a slash before each, e.g. /auv"};
    }
    if (!is_ros_name(ros.node, true) || ros.node.find('/') != std::string::npos) {
      return {"node", "letters, digits and '_', not beginning with a digit"};
    }
    if (ros.interfaces.empty()) return {"interfaces", "at least one IPv4 address of this host"};
    if (const std::string wanted = address_wanted(ros.interfaces); !wanted.empty())
      return {"interfaces", wanted};
    if (const std::string wanted = address_wanted(ros.peers); !wanted.empty()) return {"peers", wanted};
    return {};
  });
}

void describe(Schema<RosStaticFrame>& s) {
  using C = RosStaticFrame;
  s.field("parent", &C::parent, "frame in which it stands still").required();
  s.field("child", &C::child, "its name").required();
  s.field("position_m", &C::position_m, "of its origin, in the axes of the parent")
      .unit("m")
      .range(-1000, 1000);
  s.field("rpy_deg", &C::rpy_rad,
          "roll, pitch, yaw (about z, y, x in turn) of its axes in those of the parent")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
}

void describe(Schema<RosFramesConfig>& s) {
  using C = RosFramesConfig;
  s.field("convention", &C::convention,
          "axes of the frames: REP-103 (east-north-up, forward-left-up), or north-east-down and "
          "forward-right-down")
      .words({{"enu_flu", RosConvention::enu_flu}, {"ned_frd", RosConvention::ned_frd}});
  s.field("map", &C::map, "frame of positions, in which the vehicle may step");
  s.field("odom", &C::odom, "frame in which the vehicle moves without a step, and drifts");
  s.field("base_link", &C::base_link, "frame of the vehicle");
  s.field("transforms", &C::transforms, "which of them are published; others may be somebody else's")
      .words({{"both", RosTransforms::both},
              {"map_to_odom", RosTransforms::map_to_odom},
              {"odom_to_base_link", RosTransforms::odom_to_base_link},
              {"none", RosTransforms::none}});
  s.field("origin_lat_deg", &C::origin_latitude_rad, "of map; null: where the vehicle is first")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .nullable();
  s.field("origin_lon_deg", &C::origin_longitude_rad, "likewise")
      .unit("deg")
      .range(-180, 360)
      .scaled(kRadPerDeg)
      .nullable();
  s.field("origin_altitude_m", &C::origin_altitude_m, "likewise, above the WGS-84 ellipsoid")
      .unit("m")
      .range(-12'000, 100'000)
      .nullable();
  s.field("static", &C::fixed, "frames that stand still, published once on /tf_static");
  s.check([](const C& frames) -> Fault {
    for (const auto& [key, name] :
         {std::pair{"map", frames.map}, {"odom", frames.odom}, {"base_link", frames.base_link}}) {
      if (!is_frame(name)) return {key, kFrameForm};
    }
    const int known_ones = static_cast<int>(known(frames.origin_latitude_rad)) +
                           static_cast<int>(known(frames.origin_longitude_rad)) +
                           static_cast<int>(known(frames.origin_altitude_m));
    if (known_ones != 0 && known_ones != 3) {
      return {"origin_lat_deg", "origin_lat_deg, origin_lon_deg and origin_altitude_m, or none of them"};
    }
    return fault_of_tree(frames);
  });
}

void describe(Schema<RosOutputConfig>& s) {
  using C = RosOutputConfig;
  s.field("topic", &C::topic, "in the namespace, or from a slash on; empty: it is not published");
  s.field("rate_hz", &C::rate_hz, "at most so often; 0: with every navigation state")
      .unit("Hz")
      .range(0, 1000);
  s.field("qos", &C::quality,
          "reliable, which those who ask for best effort hear as well, or sensor_data: best effort")
      .words({{"reliable", RosQuality::reliable}, {"sensor_data", RosQuality::sensor_data}});
  s.check([](const C& output) -> Fault {
    if (!output.topic.empty() && !is_ros_name(output.topic, true)) return {"topic", kTopicForm};
    return {};
  });
}

void describe(Schema<RosOutputsConfig>& s) {
  using C = RosOutputsConfig;
  s.field("odometry", &C::odometry, "nav_msgs/Odometry, pose in odom, twist in base_link");
  s.field("imu", &C::imu, "sensor_msgs/Imu, REP-145");
  s.field("fix", &C::fix, "sensor_msgs/NavSatFix, the position that navigation has");
  s.field("velocity", &C::velocity, "geometry_msgs/TwistWithCovarianceStamped in base_link");
  s.field("pose", &C::pose, "geometry_msgs/PoseWithCovarianceStamped in map");
  s.field("geo_pose", &C::geo_pose,
          "geographic_msgs/GeoPoseStamped; where map begins is latched on NAMESPACE/map_origin besides");
  s.field("tf", &C::tf, "tf2_msgs/TFMessage, map -> odom -> base_link; /tf_static besides");
  s.field("diagnostics", &C::diagnostics, "diagnostic_msgs/DiagnosticArray of services and alarms");
  s.field("angular_rate_sigma_rad_s", &C::angular_rate_sigma_rad_s,
          "of one component, for covariances: navigation does not say it")
      .unit("rad/s")
      .range(1e-9, 10);
  s.field("specific_force_sigma_m_s2", &C::specific_force_sigma_m_s2, "likewise")
      .unit("m/s^2")
      .range(1e-9, 100);
}

void describe(Schema<RosInputConfig>& s) {
  using C = RosInputConfig;
  const std::vector<std::string> kRegular{"imu", "nav_sat_fix", "fluid_pressure", "dvl", "twist"};
  s.field("kind", &C::kind, "which message it is")
      .words({{"imu", RosInputKind::imu},
              {"nav_sat_fix", RosInputKind::nav_sat_fix},
              {"fluid_pressure", RosInputKind::fluid_pressure},
              {"dvl", RosInputKind::dvl},
              {"twist", RosInputKind::twist},
              {"pose", RosInputKind::pose}})
      .decides()
      .required();
  s.field("topic", &C::topic, "in the namespace, or from a slash on").required();
  s.field("sensor", &C::sensor, "the instrument's name in the samples that are published").name().required();
  s.field("frame_id", &C::frame_id, "that its messages have to name; empty: any").required();
  s.field("qos", &C::quality,
          "sensor_data hears every publisher, reliable only reliable ones, and all of these")
      .words({{"reliable", RosQuality::reliable}, {"sensor_data", RosQuality::sensor_data}});
  s.field("axes", &C::axes,
          "of its frame: standard is forward-left-up (REP-103), and forward-right-down for a dvl")
      .words({{"standard", RosAxes::standard}, {"flu", RosAxes::flu}, {"frd", RosAxes::frd}})
      .only_for({"imu", "dvl", "twist"});
  s.field("stamp", &C::stamp, "when a message was valid: what it says, or its arrival")
      .words({{"message", RosStamp::message}, {"arrival", RosStamp::arrival}});
  s.field("oldest_s", &C::oldest_s, "an older stamp is refused").unit("s").range(0.01, 86'400);
  s.field("ahead_s", &C::ahead_s, "a stamp further ahead of this host's clock is refused")
      .unit("s")
      .range(0, 60);
  s.field("rate_hz", &C::rate_hz, "messages per second to expect")
      .unit("Hz")
      .range(0.001, 10'000)
      .only_for(kRegular)
      .required_for(kRegular);
  s.field("through_water", &C::through_water, "the velocity is relative to the water, not to the bottom")
      .only_for({"twist"});
  s.field("lat_deg", &C::latitude_rad, "of the area of operation, for gravity")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .only_for({"fluid_pressure"})
      .required_for({"fluid_pressure"});
  s.field("atmosphere_Pa", &C::atmosphere_Pa, "at the surface; 0: the messages are of gauge pressure")
      .unit("Pa")
      .range(0, 120'000)
      .only_for({"fluid_pressure"});
  s.field("max_angular_rate_rad_s", &C::max_angular_rate_rad_s, "more is refused")
      .unit("rad/s")
      .range(0.01, 1000)
      .only_for({"imu"});
  s.field("max_specific_force_m_s2", &C::max_specific_force_m_s2, "more is refused")
      .unit("m/s^2")
      .range(10, 10'000)
      .only_for({"imu"});
  s.field("max_speed_m_s", &C::max_speed_m_s, "more is refused")
      .unit("m/s")
      .range(0.1, 1000)
      .only_for({"dvl", "twist"});
  s.field("max_depth_m", &C::max_depth_m, "more is refused")
      .unit("m")
      .range(1, 12'000)
      .only_for({"fluid_pressure"});
  s.check([](const C& input) -> Fault {
    if (!is_ros_name(input.topic, true)) return {"topic", kTopicForm};
    if (!input.frame_id.empty() && !is_frame(input.frame_id)) return {"frame_id", kFrameForm};
    return {};
  });
}

void describe(Schema<RosOrdersConfig>& s) {
  using C = RosOrdersConfig;
  s.field(
      "topic", &C::topic,
      "std_msgs/String, in the namespace or from a slash on: orders as the console takes them; what becomes "
      "of each is said on TOPIC/answer; empty: none are taken, which is so on a protected vehicle network");
  s.check([](const C& orders) -> Fault {
    if (!orders.topic.empty() && !is_ros_name(orders.topic, true)) return {"topic", kTopicForm};
    return {};
  });
}

/// What a pose needs: it is a place only in a map that has one.
Fault fault_of_poses(const Ros2GatewayConfig& config) {
  for (std::size_t i = 0; i < config.inputs.size(); ++i) {
    const RosInputConfig& one = config.inputs[i];
    if (one.kind != RosInputKind::pose) continue;
    if (!known(config.frames.origin_latitude_rad)) {
      return {"frames.origin_lat_deg", "the place where map begins, because an input is a pose in it"};
    }
    if (one.frame_id != config.frames.map) {
      return {"inputs." + std::to_string(i) + ".frame_id",
              config.frames.map + ", the frame of positions (frames.map)"};
    }
  }
  return {};
}

void describe(Schema<Ros2GatewayConfig>& s) {
  using C = Ros2GatewayConfig;
  s.include(&C::common);
  s.field("ros", &C::ros, "the graph of ROS 2 that the gateway is a node of");
  s.field("frames", &C::frames, "names and axes of the frames");
  s.field("outputs", &C::outputs, "what navigation says there");
  s.field("inputs", &C::inputs, "instruments of the vehicle that are topics there");
  s.field("orders", &C::orders, "orders from there");
  s.check([](const C& config) -> Fault {
    std::set<std::string> topics{"/tf_static"};
    const auto& out = config.outputs;
    for (const auto& [key, one] : {std::pair{"odometry", &out.odometry},
                                   {"imu", &out.imu},
                                   {"fix", &out.fix},
                                   {"velocity", &out.velocity},
                                   {"pose", &out.pose},
                                   {"geo_pose", &out.geo_pose},
                                   {"tf", &out.tf},
                                   {"diagnostics", &out.diagnostics}}) {
      if (!one->topic.empty() && !topics.insert(ros_topic(config.ros.name_space, one->topic)).second) {
        return {std::string("outputs.") + key + ".topic", "a topic of its own"};
      }
    }
    std::set<std::pair<int, std::string>> sensors;
    for (std::size_t i = 0; i < config.inputs.size(); ++i) {
      const RosInputConfig& one = config.inputs[i];
      const std::string key = "inputs." + std::to_string(i);
      if (!topics.insert(ros_topic(config.ros.name_space, one.topic)).second) {
        return {key + ".topic", "a topic that nothing else reads or writes here"};
      }
      const RosInputKind kind = one.kind == RosInputKind::twist ? RosInputKind::dvl : one.kind;
      if (!sensors.insert({static_cast<int>(kind), one.sensor.str()}).second) {
        return {key + ".sensor", "a name that no other input of its kind has"};
      }
    }
    const std::string orders = ros_topic(config.ros.name_space, config.orders.topic);
    if (!orders.empty() &&
        !(topics.insert(orders).second && topics.insert(ros_answer_topic(orders)).second)) {
      return {"orders.topic", "a topic that nothing else reads or writes here"};
    }
    if (!config.common.bus.security.folder.empty()) {
      if (config.ros.domain == config.common.bus.domain) {
        return {"ros.domain", "another domain than bus.domain, which is protected: ROS 2 has no part in it"};
      }
      if (!orders.empty()) {
        return {"orders.topic", "nothing: the vehicle network is protected, and the graph of ROS 2 is not"};
      }
    }
    return fault_of_poses(config);
  });
}

template LoadedConfig<Ros2GatewayConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<Ros2GatewayConfig>();

ConfigKind ros2_gateway_kind() {
  return make_kind<Ros2GatewayConfig>("ros2_gateway");
}

}  // namespace fathom::config
