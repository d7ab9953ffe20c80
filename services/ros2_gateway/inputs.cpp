#include "ros2_gateway/inputs.hpp"

#include <algorithm>
#include <functional>
#include <mutex>
#include <utility>

#include "bridge/sanity.hpp"
#include "bus/writer.hpp"

namespace fathom::ros2_gateway {
namespace {

// A reason that was logged is logged again when it had not occurred for this long.
constexpr DurationNs kQuiet_ns = 60 * kNsPerSecond;

config::SampleLimits limits_of(const config::RosInputConfig& config) {
  config::SampleLimits out;
  out.angular_rate_rad_s = config.max_angular_rate_rad_s;
  out.specific_force_m_s2 = config.max_specific_force_m_s2;
  out.dvl_speed_m_s = config.max_speed_m_s;
  out.depth_m = config.max_depth_m;
  return out;
}

ros2::DoorOptions door_options(const config::RosInputConfig& config, const std::string& vehicle) {
  ros2::DoorOptions out;
  out.vehicle = std::string_view(vehicle);
  out.sensor = config.sensor;
  out.frame_id = config.frame_id;
  out.oldest_ns = from_seconds(config.oldest_s);
  out.ahead_ns = from_seconds(config.ahead_s);
  out.stamp_on_arrival = config.stamp == config::RosStamp::arrival;
  return out;
}

template <class Message, class Sample>
class InputOf final : public Input {
 public:
  using Convert = std::function<ros2::Entry<Sample>(const Message&, const SampleHeader&)>;

  InputOf(const config::RosInputConfig& config, const InputSurroundings& around, Convert convert)
      : config_(config),
        topic_(config::ros_topic(around.name_space, config.topic)),
        limits_(limits_of(config)),
        convert_(std::move(convert)),
        clock_(around.clock),
        log_(around.log),
        door_(door_options(config, around.vehicle)),
        writer_(around.vehicle_network, writer_options(config, around.clock_rate)),
        subscription_(around.node, topic_,
                      config.quality == config::RosQuality::reliable ? bus::ros2::Quality::reliable
                                                                     : bus::ros2::Quality::sensor_data,
                      [this](const Message& message, const bus::SampleInfo&) { take(message); }) {}

  [[nodiscard]] const config::RosInputConfig& config() const override { return config_; }
  [[nodiscard]] InputCounts counts() const override {
    const std::lock_guard lock(mutex_);
    return counts_;
  }
  [[nodiscard]] int matched_publishers() const override { return subscription_.matched_publishers(); }

 private:
  /// As bridges promise it: three periods; nothing where nothing is regular.
  static bus::WriterOptions writer_options(const config::RosInputConfig& config, double clock_rate) {
    constexpr double kPeriods = 3.0;
    constexpr DurationNs kShortest_ns = 20 * kNsPerMillisecond;
    bus::WriterOptions out;
    if (config.rate_hz > 0.0)
      out.deadline_ns = std::max(kShortest_ns, from_seconds(kPeriods / config.rate_hz / clock_rate));
    return out;
  }

  void take(const Message& message) {
    const TimeNs now_ns = clock_.utc_ns();
    auto header = door_.enter(message.header, now_ns);
    if (!header.sample) return refuse(header.why, header.text);
    auto entry = convert_(message, *header.sample);
    if (!entry.sample) return refuse(entry.why, entry.text);
    if (const auto refused = bridge::refuse(AnySample(*entry.sample), limits_))
      return refuse(ros2::Refusal::value, bridge::sentence(*refused));
    door_.published(entry.sample->header);
    const bool written = writer_.write(*entry.sample);
    const std::lock_guard lock(mutex_);
    ++(written ? counts_.samples : counts_.not_written);
    counts_.last_ns = clock_.monotonic_ns();
  }

  void refuse(ros2::Refusal why, const std::string& text) {
    const TimeNs now_ns = clock_.monotonic_ns();
    const auto reason = static_cast<std::size_t>(why);
    bool is_news = false;
    {
      const std::lock_guard lock(mutex_);
      is_news = counts_.refused[reason] == 0 || now_ns - refused_ns_[reason] > kQuiet_ns;
      ++counts_.refused[reason];
      refused_ns_[reason] = now_ns;
    }
    if (is_news) log_.warning(topic_ + ": refused (" + std::string(to_string(why)) + "): " + text);
  }

  const config::RosInputConfig config_;
  const std::string topic_;
  const config::SampleLimits limits_;
  const Convert convert_;
  const Clock& clock_;
  runtime::Log& log_;
  ros2::Door door_;

  mutable std::mutex mutex_;  // of what follows up to writer_
  InputCounts counts_;
  std::array<TimeNs, ros2::kRefusals> refused_ns_{};

  bus::Writer<Sample> writer_;
  bus::ros2::Subscription<Message> subscription_;  // last: it hands over to all of the above
};

ros2::Axes axes_of(config::RosAxes word, ros2::Axes standard) {
  if (word == config::RosAxes::standard) return standard;
  return word == config::RosAxes::flu ? ros2::Axes::flu : ros2::Axes::frd;
}

std::unique_ptr<Input> make_input(const config::RosInputConfig& config, const InputSurroundings& around) {
  using config::RosInputKind;
  switch (config.kind) {
    case RosInputKind::imu: {
      ros2::ImuRule rule;
      if (axes_of(config.axes, ros2::Axes::flu) == ros2::Axes::flu) rule.R_BS = {1, 0, 0, 0, -1, 0, 0, 0, -1};
      return std::make_unique<InputOf<ros2::Imu, ImuSample>>(
          config, around, [rule](const auto& m, const auto& header) { return imu_sample(m, header, rule); });
    }
    case RosInputKind::nav_sat_fix:
      return std::make_unique<InputOf<ros2::NavSatFix, GpsSample>>(
          config, around, [](const auto& m, const auto& header) { return gps_sample(m, header); });
    case RosInputKind::fluid_pressure: {
      const ros2::PressureRule rule{config.latitude_rad, config.atmosphere_Pa};
      return std::make_unique<InputOf<ros2::FluidPressure, DepthSample>>(
          config, around,
          [rule](const auto& m, const auto& header) { return depth_sample(m, header, rule); });
    }
    case RosInputKind::dvl: {
      const ros2::VelocityRule rule{axes_of(config.axes, ros2::Axes::frd), DvlMode::bottom};
      return std::make_unique<InputOf<ros2::Dvl, DvlSample>>(
          config, around, [rule](const auto& m, const auto& header) { return dvl_sample(m, header, rule); });
    }
    case RosInputKind::twist: {
      const ros2::VelocityRule rule{axes_of(config.axes, ros2::Axes::flu),
                                    config.through_water ? DvlMode::water : DvlMode::bottom};
      return std::make_unique<InputOf<ros2::TwistWithCovarianceStamped, DvlSample>>(
          config, around, [rule](const auto& m, const auto& header) { return dvl_sample(m, header, rule); });
    }
    case RosInputKind::pose:
      return std::make_unique<InputOf<ros2::PoseWithCovarianceStamped, FixSample>>(
          config, around,
          [rule = around.poses](const auto& m, const auto& header) { return fix_sample(m, header, rule); });
  }
  return nullptr;
}

}  // namespace

std::vector<std::unique_ptr<Input>> make_inputs(const std::vector<config::RosInputConfig>& configs,
                                                const InputSurroundings& surroundings) {
  std::vector<std::unique_ptr<Input>> out;
  for (const config::RosInputConfig& config : configs) out.push_back(make_input(config, surroundings));
  return out;
}

}  // namespace fathom::ros2_gateway
