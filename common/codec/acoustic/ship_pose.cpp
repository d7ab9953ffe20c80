#include "codec/acoustic/ship_pose.hpp"

#include <cstdlib>

#include "codec/heading/nmea_heading.hpp"
#include "codec/satellite/nmea_gps.hpp"

namespace fathom::codec {
namespace {

constexpr DurationNs kDay = 86'400 * kNsPerSecond;

/// Between two times of day, midnight or not.
DurationNs apart(DurationNs a, DurationNs b) {
  const DurationNs gap = std::abs(a - b);
  return gap > kDay / 2 ? kDay - gap : gap;
}

}  // namespace

void ShipPose::note(const Sentence& sentence) {
  if (gps_sentence(sentence) == GpsSentence::gga) {
    GpsReport report;
    const bool good = !parse_gps(GpsSentence::gga, sentence, report) && report.fix != GpsFix::none &&
                      known(report.latitude_rad) && known(report.longitude_rad);
    position_time_ = good ? report.time_of_day : std::nullopt;
    latitude_rad_ = report.latitude_rad;
    longitude_rad_ = report.longitude_rad;
    return;
  }
  if (sentence.type != "HDT" && sentence.type != "THS") return;
  HeadingSample heading;
  if (!is_heading(sentence) || parse_heading(sentence, heading)) return;
  heading_rad_ = heading.heading_rad;
  heading_left_ = known(heading_rad_) ? kFixes : 0;
}

void ShipPose::give(UsblSample& sample, std::optional<DurationNs> time_of_day) {
  if (sample.frame == UsblFrame::geodetic) return;
  if (position_time_ && time_of_day && apart(*position_time_, *time_of_day) <= kFreshest) {
    sample.station_latitude_rad = latitude_rad_;
    sample.station_longitude_rad = longitude_rad_;
  }
  if (heading_left_ == 0) return;
  --heading_left_;
  if (sample.frame == UsblFrame::vessel_frd) sample.station_rpy_rad = {0.0, 0.0, heading_rad_};
}

}  // namespace fathom::codec
