#include "bus/topics.hpp"

#include <array>

#include "bus/detail/topic_ops.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/forecast.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/health.hpp"
#include "samples/imu.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/replication.hpp"
#include "samples/route.hpp"
#include "samples/truth.hpp"
#include "samples/usbl.hpp"
#include "samples/verdict.hpp"

namespace fathom::bus {
namespace {

template <class... Samples>
std::array<TopicInfo, sizeof...(Samples)> infos() {
  return {TopicInfo{detail::topic_ops<Samples>().topic, detail::topic_ops<Samples>().type_name}...};
}

}  // namespace

std::span<const TopicInfo> all_topics() {
  static const auto topics =
      infos<ImuSample, DvlSample, GpsSample, DepthSample, HeadingSample, UsblSample, AirspeedSample,
            PropulsionSample, FinsSample, NavState, NavDetail, Verdict, AlignmentStatus, Forecast, Alarm,
            MonitorStatus, ServiceStatus, Command, ReplicaStatus, EngineStatePart, Route, Truth>();
  return topics;
}

}  // namespace fathom::bus
