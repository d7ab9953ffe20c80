#include "bus/detail/qos/qos_summary.hpp"

#include <array>
#include <cstdio>

namespace fathom::bus::detail {

bool conflict(Policy policy, const QosSummary& offered, const QosSummary& requested) {
  switch (policy) {
    case Policy::reliability:
      return offered.reliability < requested.reliability;
    case Policy::durability:
      return offered.durability < requested.durability;
    case Policy::deadline:
      return offered.deadline_ns > requested.deadline_ns;
    case Policy::ownership:
      return offered.ownership != requested.ownership;
    case Policy::liveliness:
      return offered.liveliness < requested.liveliness || offered.lease_ns > requested.lease_ns;
    case Policy::other:
      break;
  }
  return false;
}

std::string to_string(Policy policy) {
  switch (policy) {
    case Policy::reliability:
      return "reliability";
    case Policy::durability:
      return "durability";
    case Policy::deadline:
      return "deadline";
    case Policy::ownership:
      return "ownership";
    case Policy::liveliness:
      return "liveliness";
    case Policy::other:
      break;
  }
  return "another policy";
}

std::string duration_text(DurationNs duration) {
  if (duration == kForever) return "none";
  std::array<char, 32> text{};
  const double seconds = to_seconds(duration);
  if (seconds < 1.0) {
    std::snprintf(text.data(), text.size(), "%.6g ms", seconds * 1e3);
  } else {
    std::snprintf(text.data(), text.size(), "%.6g s", seconds);
  }
  return text.data();
}

std::string value_text(Policy policy, const QosSummary& qos) {
  constexpr std::array<const char*, 4> kDurability{"volatile", "transient local", "transient", "persistent"};
  constexpr std::array<const char*, 3> kLiveliness{"automatic", "manual by participant", "manual by topic"};
  switch (policy) {
    case Policy::reliability:
      return qos.reliability == 0 ? "best effort" : "reliable";
    case Policy::durability:
      return kDurability.at(static_cast<std::size_t>(qos.durability));
    case Policy::deadline:
      return duration_text(qos.deadline_ns);
    case Policy::ownership:
      return qos.ownership == 0 ? "shared" : "exclusive";
    case Policy::liveliness:
      return std::string(kLiveliness.at(static_cast<std::size_t>(qos.liveliness))) + " with lease " +
             duration_text(qos.lease_ns);
    case Policy::other:
      break;
  }
  return {};
}

}  // namespace fathom::bus::detail
