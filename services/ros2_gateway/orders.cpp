#include "ros2_gateway/orders.hpp"

#include <optional>
#include <variant>

#include <nlohmann/json.hpp>

#include "config/doors/ros2_gateway_config.hpp"
#include "orders/order.hpp"

namespace fathom::ros2_gateway {
namespace {

constexpr const char* kNotTaken = "The vehicle network did not take it.";

}  // namespace

Orders::Orders(host::ServiceHost& host, bus::ros2::Node& node, const std::string& topic)
    : host_(host),
      commands_(host.participant()),
      fixes_(host.participant()),
      answers_(node, config::ros_answer_topic(topic), bus::ros2::Quality::reliable),
      subscription_(node, topic, bus::ros2::Quality::reliable,
                    [this](const ros2::String& message, const bus::SampleInfo&) { take(message.data); }) {}

void Orders::heard(const NavState& state) {
  const std::lock_guard lock(mutex_);
  state_ = state;
}

void Orders::take(const std::string& text) {
  auto order = orders::order_of(text);
  bool accepted = false;
  bool confirm = false;
  std::string said;
  if (!order) {
    said = order.error().message;
  } else if (const auto* told = std::get_if<orders::ToldFix>(&order.value())) {
    accepted = fixes_.write(orders::sample_of(*told, host_.header(), host_.clock().utc_ns()));
    said = accepted ? "Told: " + describe(*told) + ". Navigation has yet to judge it." : kNotTaken;
  } else {
    auto& command = std::get<Command>(order.value());
    command.header = host_.header();
    command.header.sensor = "ros2";
    command.header.sequence = ++sequence_;
    std::optional<health::Departure> departure;
    {
      const std::lock_guard lock(mutex_);
      departure = health::departure(command, state_);
    }
    accepted = commands_.write(command);
    confirm = accepted && orders::waits_for_confirmation(command, departure);
    const std::string waiting = orders::waiting_text(command, departure);
    said = !accepted ? kNotTaken
           : confirm ? waiting
                     : "Sent: " + orders::describe(command) + "." + (waiting.empty() ? "" : " " + waiting);
  }
  ++(accepted ? passed_on_ : refused_);
  if (accepted) {
    host_.log().info("passed on an order of ROS 2: " + describe(order.value()));
  } else {
    host_.log().warning("refused an order of ROS 2: " + said);
  }
  answers_.publish({nlohmann::json({{"accepted", accepted}, {"confirm", confirm}, {"text", said}})
                        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)});
}

}  // namespace fathom::ros2_gateway
