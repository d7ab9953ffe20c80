#include "fusion/intake/intake.hpp"

namespace fathom::fusion {

Intake::Answer Intake::take(const Arrival& arrival) {
  const SampleHeader& header = arrival.header();
  if (header.vehicle != vehicle_) {
    ++other_vehicle_;
    return {Fate::other_vehicle};
  }
  if (arrival.source() == SourceKind::imu) {
    if (imu_.take(header.sensor, arrival.writer_guid, arrival.received_ns) != ImuSource::Answer::taken)
      return {Fate::other_imu};
    ++imu_samples_;
  }
  log_.add(arrival);
  // Several may tell positions in one name, each with numbers of its own.
  if (arrival.source() == SourceKind::fix) return {Fate::taken, 0};
  return {Fate::taken, gaps_.add(arrival.source(), header)};
}

Intake::Counts Intake::counts() const {
  return {imu_samples_, other_vehicle_, imu_.changes(), imu_.rivals()};
}

}  // namespace fathom::fusion
