#include "estimation/engine/order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "estimation/filter/sigma_range.hpp"

namespace fathom::estimation {
namespace {

constexpr double kMostLatitude_rad = 1.5707;  // at a pole longitude means nothing
constexpr double kMostLongitude_rad = 6.2832;
constexpr double kDeepest_m = 12'000.0;
constexpr double kHighest_m = 50'000.0;
constexpr double kLongestRest_s = 1e6;

std::string complaint(const char* what, double found, double least, double most) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%s is %g, expected %g to %g", what, found, least, most);
  return text.data();
}

/// False for NaN.
bool within(double value, double least, double most) {
  return value >= least && value <= most;
}

}  // namespace

std::string objection_to(const Command& order) {
  switch (order.kind) {
    case CommandKind::set_position:
      if (!within(order.latitude_rad, -kMostLatitude_rad, kMostLatitude_rad))
        return complaint("latitude_rad", order.latitude_rad, -kMostLatitude_rad, kMostLatitude_rad);
      if (!within(order.longitude_rad, -kMostLongitude_rad, kMostLongitude_rad))
        return complaint("longitude_rad", order.longitude_rad, -kMostLongitude_rad, kMostLongitude_rad);
      if (!std::isnan(order.depth_m) && !within(order.depth_m, -kHighest_m, kDeepest_m))
        return complaint("depth_m", order.depth_m, -kHighest_m, kDeepest_m);
      if (!sound_sigma(order.sigma_m)) return complaint("sigma_m", order.sigma_m, kLeastSigma, kMostSigma);
      return {};
    case CommandKind::mark_at_rest:
      if (!within(order.value_s, 0.0, kLongestRest_s))
        return complaint("value_s", order.value_s, 0.0, kLongestRest_s);
      return {};
    case CommandKind::enable_source:
    case CommandKind::disable_source:
    case CommandKind::realign:
      return {};
    case CommandKind::acknowledge_alarm:
      break;
  }
  return "it is no order to navigation";
}

std::string objection_to(const Command& order, const EngineConfig& config) {
  const bool target = order.kind == CommandKind::enable_source || order.kind == CommandKind::disable_source;
  const auto& sensors = config.sensors;
  if (target && std::none_of(sensors.begin(), sensors.end(),
                             [&](const SensorConfig& one) { return order.target == Name(one.sensor); }))
    return "it names no sensor of the configuration";
  if (std::string why = objection_to(order); !why.empty()) return why;
  return sound_stamp(order.header.stamp_ns) ? "" : "its stamp is no instant of this age";
}

std::uint64_t order_number(const Command& order) {
  // FNV-1a of the name.
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : order.header.sensor.view())
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash + order.header.sequence;
}

std::string too_far(const Command& command, TimeNs newest_ns, double horizon_s) {
  const double after_s = to_seconds(command.header.stamp_ns - newest_ns);
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "its stamp is %.3f s %s the newest inertial sample, expected no more than %g s",
                std::abs(after_s), after_s < 0.0 ? "before" : "after", horizon_s);
  return text.data();
}

OrderOutcome outcome_of(const Command& order, const Judgement& judgement, bool again) {
  OrderOutcome out;
  out.order = order;
  out.fate = judgement.kind == VerdictKind::used       ? OrderFate::done
             : judgement.kind == VerdictKind::rejected ? OrderFate::held
                                                       : OrderFate::not_done;
  out.again = again;
  if (judgement.dimensions == 0) return out;
  out.apart_m = std::hypot(judgement.innovation[0], judgement.innovation[1]);
  out.allowed_m = judgement.limit;
  return out;
}

}  // namespace fathom::estimation
