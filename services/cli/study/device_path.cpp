#include "cli/study/device_path.hpp"

#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "codec/registry.hpp"
#include "config/registry.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "geo/so3.hpp"

namespace fathom::cli {
namespace {

config::SensorPlan plan_of(std::string_view role, const std::string& directory,
                           const std::map<std::string, std::vector<std::string>>& overrides) {
  const std::string service(role);
  const auto found = overrides.find(service);
  const std::vector<std::string> sets = found == overrides.end() ? std::vector<std::string>() : found->second;
  return config::bridge_plans(role, {directory + "/" + service + ".json", sets}).front();
}

void turn_into_body(ImuSample& sample, const std::array<double, 9>& R_BS) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(R_BS.data());
  for (auto* vector : {&sample.angular_rate_B_rad_s, &sample.specific_force_B_m_s2, &sample.delta_angle_B_rad,
                       &sample.delta_velocity_B_m_s})
    *vector = geo::arr(Eigen::Vector3d(turn * geo::vec(*vector)));
}

}  // namespace

/// What one bridge does with the bytes of one instrument.
struct DevicePath::Channel : codec::Sink {
  explicit Channel(config::SensorPlan the_plan) : plan(std::move(the_plan)), tracker(plan.sensor.time) {
    plan.options.ascii_prefix = plan.ascii_prefix;
    codec = codec::find_protocol(plan.sensor.protocol)->make(plan.options);
  }

  void on_sample(const codec::Decoded& decoded) override {
    const runtime::Stamp stamp = tracker.stamp(decoded.time, {header.received_ns, header.received_ns});
    std::visit(
        [&](auto sample) {
          using Sample = decltype(sample);
          if constexpr (std::is_same_v<Sample, ImuSample>) turn_into_body(sample, plan.R_BS);
          sample.header = header;
          sample.header.sensor = plan.sensor.name;
          sample.header.stamp_ns = stamp.utc_ns;
          sample.header.sequence = ++sequence;
          (*take)(sample);
        },
        decoded.sample);
  }
  void on_rejected(const codec::Rejected&) override {}

  config::SensorPlan plan;
  std::unique_ptr<codec::Codec> codec;
  runtime::DeviceTimeTracker tracker;
  std::uint64_t sequence = 0;
  SampleHeader header;  ///< of the measurement under way
  const Take* take = nullptr;
};

DevicePath::DevicePath(const sim::Scenario& scenario, const std::string& config_directory, TimeNs power_on_ns)
    : encoder_(scenario, power_on_ns) {
  const auto overrides = config::service_overrides(scenario, {});
  for_each_kind([&](auto kind) {
    const sim::SensorCommon& sensor = scenario.sensors.of<typename decltype(kind)::Sample>();
    if (!sensor.enabled || sensor.protocol.empty() || !sim::can_encode(kind.kSource, sensor.protocol)) return;
    channels_.emplace(kind.kWord,
                      std::make_unique<Channel>(plan_of(kind.kRole, config_directory, overrides)));
  });
}

DevicePath::~DevicePath() = default;

DevicePath::Channel* DevicePath::channel_of(std::string_view sensor) {
  const auto found = channels_.find(sensor);
  return found == channels_.end() ? nullptr : found->second.get();
}

void DevicePath::send(const sim::Measurement& measurement, const Take& take) {
  const SampleHeader& header = header_of(measurement);
  Channel* channel = channel_of(header.sensor.view());
  if (channel == nullptr) return take(measurement);
  channel->header = header;
  channel->take = &take;
  const auto bytes = encoder_.encode(measurement);
  channel->codec->feed(bytes, *channel);
}

}  // namespace fathom::cli
