#include "ros2/input/door.hpp"

#include <cmath>

#include "base/unknown.hpp"

namespace fathom::ros2 {

std::string_view to_string(Refusal refusal) {
  constexpr std::array<std::string_view, kRefusals> kWords{"frame",   "stamp", "repeated",
                                                           "missing", "value", "covariance"};
  return kWords[static_cast<std::size_t>(refusal)];
}

std::optional<TimeNs> stamp_of(const Time& time) {
  if (time.nanosec >= kNsPerSecond) return std::nullopt;
  return time.sec * kNsPerSecond + time.nanosec;
}

std::optional<double> sigma_of(double variance) {
  if (variance == 0.0 || variance == -1.0) return kUnknown;
  if (!std::isfinite(variance) || variance < 0.0) return std::nullopt;
  return std::sqrt(variance);
}

Entry<SampleHeader> Door::enter(const Header& header, TimeNs now_ns) {
  if (!options_.frame_id.empty() && header.frame_id != options_.frame_id) {
    return {Refusal::frame, "frame_id is '" + header.frame_id + "', expected '" + options_.frame_id + "'"};
  }
  SampleHeader out;
  out.vehicle = options_.vehicle;
  out.sensor = options_.sensor;
  out.received_ns = now_ns;
  out.stamp_ns = now_ns;
  if (!options_.stamp_on_arrival) {
    const auto stamp = stamp_of(header.stamp);
    if (!stamp) {
      return {Refusal::stamp,
              "stamp.nanosec is " + std::to_string(header.stamp.nanosec) + ", expected below 1000000000"};
    }
    const DurationNs age_ns = now_ns - *stamp;
    if (age_ns > options_.oldest_ns || age_ns < -options_.ahead_ns) {
      return {Refusal::stamp, "the stamp is " + std::to_string(to_seconds(age_ns)) +
                                  " s before the arrival, expected from " +
                                  std::to_string(-to_seconds(options_.ahead_ns)) + " to " +
                                  std::to_string(to_seconds(options_.oldest_ns)) + " s"};
    }
    out.stamp_ns = *stamp;
  }
  if (sequence_ > 0 && out.stamp_ns <= last_ns_) {
    return {Refusal::repeated, "the stamp is " + std::to_string(to_seconds(last_ns_ - out.stamp_ns)) +
                                   " s before that of the last one, expected a later one"};
  }
  return out;
}

void Door::published(SampleHeader& header) {
  header.sequence = ++sequence_;
  last_ns_ = header.stamp_ns;
}

}  // namespace fathom::ros2
