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
#include "samples/status/replication.hpp"
#include "samples/status/route.hpp"
#include "samples/truth.hpp"
#include "samples/verdict.hpp"

namespace fathom::bus {
namespace {

template <class Sample>
TopicInfo info() {
  return {detail::topic_ops<Sample>().topic, detail::topic_ops<Sample>().type_name};
}

template <class... Samples>
std::vector<TopicInfo> instruments_and() {
  std::vector<TopicInfo> topics;
  for_each_kind([&](auto kind) { topics.push_back(info<typename decltype(kind)::Sample>()); });
  (topics.push_back(info<Samples>()), ...);
  return topics;
}

}  // namespace

std::span<const TopicInfo> all_topics() {
  static const std::vector<TopicInfo> topics =
      instruments_and<NavState, NavDetail, Verdict, AlignmentStatus, Forecast, Alarm, MonitorStatus,
                      ServiceStatus, Command, ReplicaStatus, EngineStatePart, Route, Truth>();
  return topics;
}

}  // namespace fathom::bus
