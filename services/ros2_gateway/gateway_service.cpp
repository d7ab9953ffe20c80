#include "ros2_gateway/gateway_service.hpp"

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "bus/reader.hpp"
#include "bus/ros2/node.hpp"
#include "ros2/output/diagnostics.hpp"
#include "ros2_gateway/inputs.hpp"
#include "ros2_gateway/map_frame.hpp"
#include "ros2_gateway/orders.hpp"
#include "ros2_gateway/outputs.hpp"

namespace fathom::ros2_gateway {
namespace {

/// Presence in the graph of ROS 2, which knows no protection.
bus::ParticipantOptions graph_options(const host::ServiceHost& host,
                                      const config::Ros2GatewayConfig& config) {
  bus::ParticipantOptions out;
  out.name = host.name() + "_graph";
  out.domain = static_cast<std::uint32_t>(config.ros.domain);
  out.interfaces = config.ros.interfaces;
  out.peers = config.ros.peers;
  out.profiles_dir = config.common.bus.profiles_dir;
  out.user_data = bus::ros2::kUserData;
  return out;
}

ros2::Distro distro_of(config::RosDistro word) {
  switch (word) {
    case config::RosDistro::humble:
      return ros2::Distro::humble;
    case config::RosDistro::jazzy:
      return ros2::Distro::jazzy;
    case config::RosDistro::kilted:
      return ros2::Distro::kilted;
  }
  return ros2::Distro::jazzy;
}

ros2::PoseRule poses_in(const config::RosFramesConfig& frames) {
  return {configured_origin(frames).value_or(geo::Geodetic{}), convention_of(frames)};
}

}  // namespace

struct GatewayService::Impl {
  Impl(host::ServiceHost& the_host, const config::Ros2GatewayConfig& the_config)
      : host(the_host),
        config(the_config),
        started_ns(host.clock().monotonic_ns()),
        graph(graph_options(host, config)),
        node(graph, {config.ros.name_space, config.ros.node, distro_of(config.ros.distro)}),
        outputs(node, config, host.clock().utc_ns()),
        inputs(make_inputs(config.inputs,
                           {host.participant(), node, host.clock(), host.log(), config.common.vehicle,
                            config.ros.name_space, config.common.clock.rate, poses_in(config.frames)})),
        orders(config.orders.topic.empty()
                   ? nullptr
                   : std::make_unique<Orders>(host, node,
                                              config::ros_topic(config.ros.name_space, config.orders.topic))),
        states(host.participant(), [this](const NavState& state, const bus::SampleInfo&) { take(state); }),
        services(host.participant(), [this](const ServiceStatus& s, const bus::SampleInfo&) { note(s); }),
        alarms(host.participant(), [this](const Alarm& alarm, const bus::SampleInfo&) { note(alarm); }) {
    graph.on_event([this](const bus::BusEvent& event) {
      host.log().warning("graph of ROS 2: " + event.topic + ": " + std::string(bus::to_string(event.kind)) +
                         ": " + event.detail);
    });
    host.on_status([this](ServiceStatus& status) { fill(status); });
    if (config.outputs.diagnostics.rate_hz > 0.0 && !config.outputs.diagnostics.topic.empty()) {
      host.on_tick(from_seconds(1.0 / config.outputs.diagnostics.rate_hz), [this] { say_diagnostics(); });
    }
    host.log().info("node " + config.ros.name_space + (config.ros.name_space == "/" ? "" : "/") +
                    config.ros.node + " in domain " + std::to_string(config.ros.domain) + ", " +
                    std::to_string(inputs.size()) + " inputs");
  }
  ~Impl() {
    host.on_status([](ServiceStatus&) {});
    host.on_tick(kNsPerSecond, [] {});
    graph.on_event([](const bus::BusEvent&) {});
  }

  void take(const NavState& state) {
    if (state.header.vehicle.view() != config.common.vehicle) return;
    outputs.take(state, host.clock().monotonic_ns());
    if (orders) orders->heard(state);
    const std::lock_guard lock(mutex);
    book.heard(state, host.clock().utc_ns());
  }
  void note(const ServiceStatus& status) {
    if (status.header.vehicle.view() != config.common.vehicle) return;
    const std::lock_guard lock(mutex);
    book.heard(status, host.clock().utc_ns());
  }
  void note(const Alarm& alarm) {
    if (alarm.header.vehicle.view() != config.common.vehicle) return;
    const std::lock_guard lock(mutex);
    book.heard(alarm);
  }

  void say_diagnostics() {
    ros2::DiagnosticArray message;
    {
      const std::lock_guard lock(mutex);
      message = book.message(config.common.vehicle, host.clock().utc_ns());
    }
    outputs.diagnostics(message);
  }

  void fill(ServiceStatus& status) {
    const OutputCounts said = outputs.counts();
    const auto counter = [&](const std::string& name, std::uint64_t value) {
      if (value > 0) status.counters.push_back({std::string_view(name), value});
    };
    counter("states", said.states);
    counter("messages", said.published);
    counter("not_published", said.not_published);
    counter("unusable", said.unusable);
    counter("back_in_time", said.back_in_time);
    counter("begun_anew", said.begun_anew);
    const bus::BusCounters bus = graph.counters();
    counter("graph_invalid", bus.invalid_sample);
    counter("graph_incompatible_qos", bus.incompatible_qos);
    counter("graph_malformed", bus.malformed_datagram);
    status.rates.push_back({"states", static_cast<double>(said.states - last_states)});
    last_states = said.states;
    if (orders) {
      counter("orders", orders->passed_on());
      counter("orders_refused", orders->refused());
    }
    std::string trouble;
    for (std::size_t i = 0; i < inputs.size(); ++i) fill(*inputs[i], i, status, trouble);
    if (!trouble.empty()) {
      status.state = ServiceState::degraded;
      status.text = trouble;
    } else if (!said.unusable_text.empty()) {
      status.text = "no pose is published: " + said.unusable_text;
    }
  }

  void fill(const Input& input, std::size_t index, ServiceStatus& status, std::string& trouble) {
    constexpr double kLeastSilence_s = 2.0;
    const InputCounts counts = input.counts();
    const std::string sensor = input.config().sensor.str();
    const auto name = [&](std::string_view what) { return sensor + "." + std::string(what); };
    if (counts.samples > 0) status.counters.push_back({std::string_view(name("samples")), counts.samples});
    for (std::size_t i = 0; i < counts.refused.size(); ++i) {
      if (counts.refused[i] == 0) continue;
      status.counters.push_back(
          {std::string_view(name(to_string(static_cast<ros2::Refusal>(i)))), counts.refused[i]});
    }
    if (last_samples.size() < inputs.size()) last_samples.resize(inputs.size());
    status.rates.push_back(
        {std::string_view(sensor), static_cast<double>(counts.samples - last_samples[index])});
    last_samples[index] = counts.samples;
    if (input.config().rate_hz <= 0.0) return;  // nothing regular that could be missed
    const double silent_s =
        to_seconds(host.clock().monotonic_ns() - (counts.last_ns != 0 ? counts.last_ns : started_ns));
    if (silent_s < std::max(kLeastSilence_s, 5.0 / input.config().rate_hz)) return;
    trouble += (trouble.empty() ? "" : "; ") + sensor + ": " +
               (input.matched_publishers() == 0 ? "nobody publishes " : "nothing usable on ") +
               config::ros_topic(config.ros.name_space, input.config().topic);
  }

  host::ServiceHost& host;
  const config::Ros2GatewayConfig config;
  const TimeNs started_ns;  // monotonic

  std::mutex mutex;  // of the book
  ros2::DiagnosticsBook book;

  // Of the thread of run().
  std::uint64_t last_states = 0;
  std::vector<std::uint64_t> last_samples;

  bus::Participant graph;
  bus::ros2::Node node;
  Outputs outputs;
  std::vector<std::unique_ptr<Input>> inputs;
  std::unique_ptr<Orders> orders;  // none where none are taken
  bus::Reader<NavState> states;    // these end first: they hand over to all of the above
  bus::Reader<ServiceStatus> services;
  bus::Reader<Alarm> alarms;
};

GatewayService::GatewayService(host::ServiceHost& host, const config::Ros2GatewayConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}
GatewayService::~GatewayService() = default;

}  // namespace fathom::ros2_gateway
