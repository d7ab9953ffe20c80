#pragma once

#include <optional>
#include <string>

#include "base/time.hpp"
#include "samples/dvl.hpp"

namespace fathom::sim::encode {

/// When a Water Linked report was valid and when it leaves, on the instrument's own clock.
struct WaterLinkedTimes {
  TimeNs valid_ns = 0;  ///< sent as microseconds since the Unix epoch
  TimeNs sent_ns = 0;
  double since_last_ms = kUnknown;  ///< interval since the previous report
};

/// One json_v3.1 report with CR LF, type `velocity` or `velocity_water` by the sample's mode. A velocity with
/// an unknown component is sent as not valid, an unknown altitude as -1. Beams that the sample does not know
/// are sent as not valid. sigma_m_s becomes covariance and figure of merit.
[[nodiscard]] std::string waterlinked(const DvlSample& sample, const WaterLinkedTimes& times);

}  // namespace fathom::sim::encode
