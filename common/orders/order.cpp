#include "orders/order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "config/json/strict_json.hpp"
#include "health/text.hpp"
#include "samples/position/limits.hpp"

namespace fathom::orders {
namespace {

using nlohmann::json;

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
  fix.latitude_rad = number_of(order, {"lat_deg", -90, 90}, false, fault) * kRadPerDeg;
  fix.longitude_rad = number_of(order, {"lon_deg", -180, 180}, false, fault) * kRadPerDeg;
  fix.sigma_m =
      number_of(order, {"sigma_m", kToldPosition.least_sigma_m, kToldPosition.most_sigma_m}, false, fault);
  fix.depth_m =
      number_of(order, {"depth_m", kToldPosition.least_depth_m, kToldPosition.most_depth_m}, true, fault);
  const double age = number_of(order, {"age_s", 0, to_seconds(kOldestTold_ns)}, true, fault);
  age_s = known(age) ? age : 0.0;
  fix.header.sensor = "operator";
  if (fault.empty() && order.contains("from"))
    fault = fill_name(order, "from", "the name of a source of positions", fix.header.sensor);
  return fault;
}

std::string fill_position(const json& order, Command& command) {
  static constexpr std::array<Bounds, 4> kBounds{
      {{"lat_deg", -90, 90},
       {"lon_deg", -180, 180},
       {"depth_m", kOrderedPosition.least_depth_m, kOrderedPosition.most_depth_m},
       {"sigma_m", kOrderedPosition.least_sigma_m, kOrderedPosition.most_sigma_m}}};
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < kBounds.size(); ++i) {
    const auto& [key, low, high] = kBounds[i];
    const json value = order.value(key, json());
    if (!value.is_number() || value.get<double>() < low || value.get<double>() > high) {
      return health::sentence("%s: expected a number from %g to %g.", key, low, high);
    }
    values[i] = value.get<double>();
  }
  command.latitude_rad = values[0] * kRadPerDeg;
  command.longitude_rad = values[1] * kRadPerDeg;
  command.depth_m = values[2];
  command.sigma_m = values[3];
  const json confirmed = order.value("confirmed", json(false));
  if (!confirmed.is_boolean()) return "confirmed: expected true or false.";
  command.confirmed = confirmed.get<bool>();
  return {};
}

}  // namespace

Result<Order> order_of(std::string_view text) {
  config::StrictJson parsed = config::parse_strict(text);
  if (parsed.fault) return Error{config::describe(*parsed.fault) + "."};
  const json& order = parsed.value;
  const Form* form = form_of(order);
  if (form == nullptr) {
    return Error{
        "Expected JSON with a kind: set_position, realign, enable_source, disable_source, "
        "acknowledge_alarm or fix."};
  }
  for (const auto& [key, value] : order.items()) {
    if (key == "kind" || std::find(form->keys.begin(), form->keys.end(), key) != form->keys.end()) continue;
    std::string keys;
    for (const auto& one : form->keys) keys += ", " + std::string(one);
    return Error{"The order " + word_of(*form) + " does not know the key " +
                 json(key.substr(0, 31)).dump(-1, ' ', true, json::error_handler_t::replace) +
                 ", expected kind" + keys + "."};
  }
  std::string fault;
  if (!form->kind) {
    ToldFix told;
    fault = fill_fix(order, told.fix, told.age_s);
    if (!fault.empty()) return Error{fault};
    return Order(told);
  }
  Command command;
  command.kind = *form->kind;
  if (command.kind == CommandKind::set_position) {
    fault = fill_position(order, command);
  } else if (!form->keys.empty()) {
    fault = fill_name(order, "target", "the name of a sensor or an alarm", command.target);
  }
  if (!fault.empty()) return Error{fault};
  return Order(command);
}

std::string describe(const Command& command) {
  std::string out(to_string(command.kind));
  if (!command.target.empty()) out += " " + command.target.str();
  if (command.kind == CommandKind::set_position) {
    out += health::sentence(" %.6f deg N %.6f deg E depth %.1f m sigma %.1f m",
                            command.latitude_rad / kRadPerDeg, command.longitude_rad / kRadPerDeg,
                            command.depth_m, command.sigma_m);
    if (command.confirmed) out += ", confirmed";
  }
  return out;
}

std::string describe(const ToldFix& told) {
  const FixSample& fix = told.fix;
  return health::sentence("fix of %s %.6f deg N %.6f deg E sigma %.1f m, %.0f s ago",
                          fix.header.sensor.str().c_str(), fix.latitude_rad / kRadPerDeg,
                          fix.longitude_rad / kRadPerDeg, fix.sigma_m, told.age_s);
}

std::string describe(const Order& order) {
  return std::visit([](const auto& one) { return describe(one); }, order);
}

FixSample sample_of(const ToldFix& told, const SampleHeader& header, TimeNs now_ns) {
  FixSample out = told.fix;
  out.header = header;
  out.header.sensor = told.fix.header.sensor;
  out.header.received_ns = now_ns;
  out.header.stamp_ns = now_ns - from_seconds(told.age_s);
  out.header.sequence = static_cast<std::uint64_t>(now_ns);
  return out;
}

bool waits_for_confirmation(const Command& order, const std::optional<health::Departure>& departure) {
  return departure && departure->far() && !order.confirmed;
}

std::string waiting_text(const Command& order, const std::optional<health::Departure>& departure) {
  if (waits_for_confirmation(order, departure)) {
    return health::sentence(
        "This position lies %.0f m from where navigation is, and %.0f m are expected at most. It is held "
        "for 60 s, until it is confirmed.",
        departure->apart_m, departure->allowed_m);
  }
  if (order.kind != CommandKind::set_position || order.confirmed || departure) return {};
  return "Where navigation is has not been heard here. If navigation has a position far from this one, it "
         "holds the order for 60 s, until it is confirmed.";
}

}  // namespace fathom::orders
