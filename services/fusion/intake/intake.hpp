#pragma once

#include <cstdint>

#include "base/name.hpp"
#include "base/time.hpp"
#include "fusion/intake/arrival.hpp"
#include "fusion/intake/arrival_log.hpp"
#include "fusion/intake/imu_source.hpp"
#include "fusion/intake/sample_gaps.hpp"

namespace fathom::fusion {

/// The way of every arrival to the engine: it says which ones navigation uses, keeps them in a log, and
/// counts what never came. Pure and not thread-safe.
class Intake {
 public:
  enum class Fate : std::uint8_t {
    taken,
    other_vehicle,
    other_imu,  ///< An inertial sample of another unit, or of another process that writes in its name.
  };
  struct Answer {
    Fate fate = Fate::taken;
    std::uint64_t missed = 0;  ///< samples of this stream that are missing before this one
  };
  struct Counts {
    std::uint64_t imu_samples = 0;    ///< taken
    std::uint64_t other_vehicle = 0;  ///< samples
    std::uint64_t imu_changes = 0;    ///< times that another process began to write the inertial samples
    std::uint64_t imu_rivals = 0;     ///< inertial samples of a second process in the unit's name, left out
  };

  /// `imu_patience_ns`: see ImuSource.
  Intake(Name vehicle, Name imu_unit, DurationNs imu_patience_ns)
      : vehicle_(vehicle), imu_(imu_unit, imu_patience_ns) {}

  [[nodiscard]] Answer take(const Arrival& arrival);
  void take(const Command& order) { log_.add(order); }

  [[nodiscard]] Counts counts() const;
  [[nodiscard]] const Name& imu_unit() const { return imu_.unit(); }

  /// See ArrivalLog::keep().
  void keep(bool on) { log_.keep(on); }
  [[nodiscard]] const ArrivalLog& log() const { return log_; }
  /// The last number of each stream, and where to go on from.
  [[nodiscard]] const SampleGaps::Table& last() const { return gaps_.last(); }
  void go_on_from(const SampleGaps::Table& last) { gaps_.go_on_from(last); }

 private:
  Name vehicle_;
  ImuSource imu_;
  ArrivalLog log_;
  SampleGaps gaps_;
  std::uint64_t imu_samples_ = 0;
  std::uint64_t other_vehicle_ = 0;
};

}  // namespace fathom::fusion
