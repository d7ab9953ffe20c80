#include "console/orders/orders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/json/strict_json.hpp"
#include "health/text.hpp"

namespace fathom::console {
namespace {

using nlohmann::json;
constexpr double kDegree = std::numbers::pi / 180.0;

/// What each kind of order takes besides "kind"; a fix is no command.
struct Form {
  std::optional<CommandKind> kind;
  std::vector<std::string_view> keys;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> kForms{
      {CommandKind::set_position, {"lat_deg", "lon_deg", "depth_m", "sigma_m", "confirmed"}},
      {CommandKind::realign, {}},
      {CommandKind::enable_source, {"target"}},
      {CommandKind::disable_source, {"target"}},
      {CommandKind::acknowledge_alarm, {"target"}},
      {std::nullopt, {"lat_deg", "lon_deg", "depth_m", "sigma_m", "age_s", "from"}},
  };
  return kForms;
}

std::string word_of(const Form& form) {
  return form.kind ? std::string(to_string(*form.kind)) : "fix";
}

const Form* form_of(const json& order) {
  if (!order.is_object() || !order.contains("kind") || !order["kind"].is_string()) return nullptr;
  const auto word = order["kind"].get<std::string>();
  const auto at =
      std::find_if(forms().begin(), forms().end(), [&](const Form& form) { return word_of(form) == word; });
  return at == forms().end() ? nullptr : &*at;
}

struct Bounds {
  const char* key;
  double low;
  double high;
};

/// A number within its bounds; why not in `fault`. Unknown where it is left out and may be.
double number_of(const json& order, const Bounds& bounds, bool may_be_left_out, std::string& fault) {
  if (may_be_left_out && !order.contains(bounds.key)) return kUnknown;
  const json value = order.value(bounds.key, json());
  if (value.is_number() && value.get<double>() >= bounds.low && value.get<double>() <= bounds.high)
    return value.get<double>();
  if (fault.empty())
    fault = health::sentence("%s: expected a number from %g to %g.", bounds.key, bounds.low, bounds.high);
  return kUnknown;
}

/// Empty when all is well.
std::string fill_name(const json& order, const char* key, const char* what, Name& name) {
  const json value = order.value(key, json());
  if (!value.is_string()) return std::string(key) + ": expected " + what + ".";
  const auto text = value.get<std::string>();
  const bool sound = std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (text.empty() || text.size() > Name::kCapacity || !sound) {
    return std::string(key) + ": expected 1 to 31 printable characters without blanks.";
  }
  name = std::string_view(text);
  return {};
}

std::string fill_fix(const json& order, FixSample& fix, double& age_s) {
  std::string fault;
  fix.latitude_rad = number_of(order, {"lat_deg", -90, 90}, false, fault) * kDegree;
  fix.longitude_rad = number_of(order, {"lon_deg", -180, 180}, false, fault) * kDegree;
  fix.sigma_m = number_of(order, {"sigma_m", 0.01, 100000}, false, fault);
  fix.depth_m = number_of(order, {"depth_m", -50, 12000}, true, fault);
  const double age = number_of(order, {"age_s", 0, 7200}, true, fault);
  age_s = known(age) ? age : 0.0;
  fix.header.sensor = "operator";
  if (fault.empty() && order.contains("from"))
    fault = fill_name(order, "from", "the name of a source of positions", fix.header.sensor);
  return fault;
}

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
            "Expected JSON with a kind: set_position, realign, enable_source, disable_source, "
            "acknowledge_alarm or fix.",
            {}};
  }
  for (const auto& [key, value] : order.items()) {
    if (key == "kind" || std::find(form->keys.begin(), form->keys.end(), key) != form->keys.end()) continue;
    return {400, "The order " + word_of(*form) + " has a key that it does not know.", {}};
  }
  std::string fault;
  if (!form->kind) {
    OrderJudgement out;
    FixSample fix;
    fault = fill_fix(order, fix, out.age_s);
    if (!fault.empty()) return {400, fault, {}};
    out.status = 200;
    out.text = "Told: " + describe(fix, out.age_s) + ". What navigation says to it stands among the sensors.";
    out.fix = fix;
    return out;
  }
  Command command;
  command.kind = *form->kind;
  if (command.kind == CommandKind::set_position) {
    fault = fill_position(order, command);
  } else if (!form->keys.empty()) {
    fault = fill_name(order, "target", "the name of a sensor or an alarm", command.target);
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

std::string describe(const FixSample& fix, double age_s) {
  return health::sentence("fix of %s %.6f deg N %.6f deg E sigma %.1f m, %.0f s ago",
                          fix.header.sensor.str().c_str(), fix.latitude_rad / kDegree,
                          fix.longitude_rad / kDegree, fix.sigma_m, age_s);
}

}  // namespace fathom::console
