#pragma once

#include <span>

namespace fathom::bus {

/// A topic of the vehicle network, as others see it in discovery.
struct TopicInfo {
  const char* topic;  ///< e.g. "fathom/v1/nav_state"; also the name of its QoS profiles
  const char* type;   ///< e.g. "fathom::v1::NavState"
};

/// Every topic that Writer and Reader exist for.
[[nodiscard]] std::span<const TopicInfo> all_topics();

}  // namespace fathom::bus
