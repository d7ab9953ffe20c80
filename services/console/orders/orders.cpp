#include "console/orders/orders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/json/strict_json.hpp"
#include "health/text.hpp"

namespace fathom::console {
namespace {

using nlohmann::json;
constexpr double kDegree = std::numbers::pi / 180.0;

/// What each kind of order takes besides "kind".
struct Form {
  CommandKind kind;
  std::vector<std::string_view> keys;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> kForms{
      {CommandKind::set_position, {"lat_deg", "lon_deg", "depth_m", "sigma_m", "confirmed"}},
      {CommandKind::realign, {}},
      {CommandKind::enable_source, {"target"}},
      {CommandKind::disable_source, {"target"}},
      {CommandKind::acknowledge_alarm, {"target"}},
  };
  return kForms;
}

const Form* form_of(const json& order) {
  if (!order.is_object() || !order.contains("kind") || !order["kind"].is_string()) return nullptr;
  const auto word = order["kind"].get<std::string>();
  const auto at = std::find_if(forms().begin(), forms().end(),
                               [&](const Form& form) { return to_string(form.kind) == word; });
  return at == forms().end() ? nullptr : &*at;
}

struct Bounds {
  const char* key;
  double low;
  double high;
};

/// Empty when all is well.
std::string fill_position(const json& order, Command& command) {
  static constexpr std::array<Bounds, 4> kBounds{
      {{"lat_deg", -90, 90}, {"lon_deg", -180, 180}, {"depth_m", -100, 11000}, {"sigma_m", 0.1, 100000}}};
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < kBounds.size(); ++i) {
    const auto& [key, low, high] = kBounds[i];
    const json value = order.value(key, json());
    if (!value.is_number() || value.get<double>() < low || value.get<double>() > high) {
      return health::sentence("%s: expected a number from %g to %g.", key, low, high);
    }
    values[i] = value.get<double>();
  }
  command.latitude_rad = values[0] * kDegree;
  command.longitude_rad = values[1] * kDegree;
  command.depth_m = values[2];
  command.sigma_m = values[3];
  const json confirmed = order.value("confirmed", json(false));
  if (!confirmed.is_boolean()) return "confirmed: expected true or false.";
  command.confirmed = confirmed.get<bool>();
  return {};
}

std::string fill_target(const json& order, Command& command) {
  const json value = order.value("target", json());
  if (!value.is_string()) return "target: expected the name of a sensor or an alarm.";
  const auto name = value.get<std::string>();
  const bool sound = std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (name.empty() || name.size() > Name::kCapacity || !sound) {
    return "target: expected 1 to 31 printable characters without blanks.";
  }
  command.target = std::string_view(name);
  return {};
}

}  // namespace

OrderJudgement judge_order(std::string_view body, const Identity& who, bool orders_enabled) {
  if (!orders_enabled) return {403, "Orders are switched off in this console's configuration.", {}};
  if (who.role == Role::nobody) return {401, "An order needs the token of an operator.", {}};
  if (who.role != Role::operator_)
    return {403, "The role " + std::string(to_string(who.role)) + " may not give orders.", {}};
  config::StrictJson parsed = config::parse_strict(body);
  if (parsed.fault) return {400, config::describe(*parsed.fault) + ".", {}};
  const json& order = parsed.value;
  const Form* form = form_of(order);
  if (form == nullptr) {
    return {400,
            "Expected JSON with a kind: set_position, realign, enable_source, disable_source or "
            "acknowledge_alarm.",
            {}};
  }
  for (const auto& [key, value] : order.items()) {
    if (key == "kind" || std::find(form->keys.begin(), form->keys.end(), key) != form->keys.end()) continue;
    return {400, "The order " + std::string(to_string(form->kind)) + " has a key that it does not know.", {}};
  }
  Command command;
  command.kind = form->kind;
  std::string fault;
  if (form->kind == CommandKind::set_position) {
    fault = fill_position(order, command);
  } else if (!form->keys.empty()) {
    fault = fill_target(order, command);
  }
  if (!fault.empty()) return {400, fault, {}};
  return {200, "Sent: " + describe(command) + ".", command};
}

std::string describe(const Command& command) {
  std::string out(to_string(command.kind));
  if (!command.target.empty()) out += " " + command.target.str();
  if (command.kind == CommandKind::set_position) {
    out +=
        health::sentence(" %.6f deg N %.6f deg E depth %.1f m sigma %.1f m", command.latitude_rad / kDegree,
                         command.longitude_rad / kDegree, command.depth_m, command.sigma_m);
    if (command.confirmed) out += ", confirmed";
  }
  return out;
}

}  // namespace fathom::console
