#include "bus/topics.hpp"

#include <vector>

#include "bus/detail/topic_ops.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/forecast.hpp"
#include "samples/kinds.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/status/intake.hpp"
#include "samples/status/replication.hpp"
#include "samples/status/route.hpp"
#include "samples/truth.hpp"
#include "samples/verdict.hpp"

namespace fathom::bus {
namespace {

template <class... Samples>
std::vector<const detail::TopicOps*> instruments_and() {
  std::vector<const detail::TopicOps*> topics;
  for_each_kind([&](auto kind) { topics.push_back(&detail::topic_ops<typename decltype(kind)::Sample>()); });
  (topics.push_back(&detail::topic_ops<Samples>()), ...);
  return topics;
}

}  // namespace

const std::vector<const detail::TopicOps*>& detail::all_topic_ops() {
  static const auto topics =
      instruments_and<NavState, NavDetail, Verdict, AlignmentStatus, Forecast, Alarm, MonitorStatus,
                      ServiceStatus, Command, ReplicaStatus, EngineStatePart, Route, Truth, IntakeRecord>();
  return topics;
}

std::span<const TopicInfo> all_topics() {
  static const std::vector<TopicInfo> topics = [] {
    std::vector<TopicInfo> out;
    for (const detail::TopicOps* ops : detail::all_topic_ops()) out.push_back({ops->topic, ops->type_name});
    return out;
  }();
  return topics;
}

}  // namespace fathom::bus
