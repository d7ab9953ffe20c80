#pragma once

#include <cstdint>
#include <optional>

#include "base/device_time.hpp"
#include "base/time.hpp"

namespace fathom::runtime {

/// When bytes arrived, read once from both clocks of the host.
struct Arrival {
  TimeNs utc_ns = 0;
  TimeNs monotonic_ns = 0;
};

/// Where a sensor's instant of validity comes from.
enum class TimeMode : std::uint8_t {
  arrival = 0,       ///< arrival - latency - what the frame says about its age
  device_utc = 1,    ///< the device's own UTC, where it agrees with the vehicle's clock
  device_clock = 2,  ///< the device's free-running clock, its offset to the host tracked
};

struct TimeConfig {
  TimeMode mode = TimeMode::arrival;
  double latency_s = 0.0;          ///< validity to arrival when the frame does not tell
  double minimum_latency_s = 0.0;  ///< device_clock: validity to arrival of the quickest frame, at least
  double drift_ppm = 100.0;        ///< device_clock: how fast device and host clock may drift apart
  double jump_s = 0.5;             ///< device_clock: a shift of its offset beyond this is a step of its clock
  double window_s = 10.0;          ///< device_clock: delays last for less than this; a longer shift is a step
  double rollover_s = 0.0;   ///< device_clock: its counter starts again after this long; 0: it never does
  double max_age_s = 10.0;   ///< device_utc: older is not believed
  double tolerance_s = 0.1;  ///< a stamp may be this far after its arrival
};

/// One sample's instant of validity and how it was found.
struct Stamp {
  TimeNs utc_ns = 0;
  /// The frame did not say what the mode needs, or what it said cannot be: the stamp is from the arrival.
  bool from_arrival = false;
  /// Device UTC was unbelievable (too old, or after its own arrival).
  bool implausible = false;
  double implausible_by_s = 0.0;  ///< how far after its own arrival it would be
  /// Device UTC was wrong by whole GPS week roll-overs (1024 weeks) and was corrected.
  bool week_rollover = false;
  /// The device's clock was stepped or the device restarted; its offset was found anew.
  bool clock_step = false;
  /// Earlier than the stamp before.
  bool backwards = false;
};

/// Turns what frames of one instrument say about time, and when they arrived, into stamps in the vehicle's
/// UTC. Pure: time is an argument.
///
/// device_clock: every arrival gives offset = arrival - device clock = true offset + delay, where the delay
/// is never below the configured minimum. The smallest recent offset is therefore the best one; it is allowed
/// to grow by drift_ppm, so that it stays an upper bound when the device's clock is the slower one. Arrivals
/// are counted on the host's monotonic clock, so a step of the host's UTC moves stamps with it and does not
/// disturb the offset. A frame that says its age has at least that for its delay. A corrected offset is
/// blended in such that successive stamps keep at least half of the device's own interval.
class DeviceTimeTracker {
 public:
  explicit DeviceTimeTracker(const TimeConfig& config);

  [[nodiscard]] Stamp stamp(const DeviceTime& device, const Arrival& arrival);

  /// A frame of a new connection that arrived with others, before any of them is stamped. They gathered while
  /// nobody read: the youngest of them tells the offset best, and the first one is as old as its clock says.
  /// Without this they would all be stamped as the youngest.
  void foresee(const DeviceTime& device, const Arrival& arrival);

  /// The connection is new: the device may have been exchanged or restarted.
  void reset();

  /// Steps of the device's clock seen since start.
  [[nodiscard]] std::uint64_t clock_steps() const { return clock_steps_; }

 private:
  /// Age of the sample at arrival, where `least` is that of a frame without delay; nothing while a suspected
  /// step is not confirmed.
  [[nodiscard]] std::optional<DurationNs> track(TimeNs device_ns, DurationNs least, TimeNs arrival_ns,
                                                bool& stepped);
  void anchor(DurationNs offset, TimeNs unwrapped_ns, TimeNs arrival_ns);
  [[nodiscard]] std::optional<TimeNs> utc_of(const DeviceTime& device, const Arrival& arrival,
                                             Stamp& out) const;

  TimeConfig config_;
  std::uint64_t clock_steps_ = 0;
  std::optional<TimeNs> last_stamp_ns_;

  // device_clock: all in the host's monotonic time or the unwrapped device time.
  bool anchored_ = false;
  std::optional<DurationNs> foreseen_ns_;  ///< the smallest offset of the frames that arrived together
  TimeNs last_raw_ns_ = 0;
  DurationNs wrapped_ns_ = 0;  ///< added by roll-overs so far
  TimeNs last_device_ns_ = 0;  ///< unwrapped
  TimeNs last_arrival_ns_ = 0;
  DurationNs bound_ns_ = 0;    ///< smallest recent offset, allowed to drift
  DurationNs applied_ns_ = 0;  ///< the offset stamps use: follows bound_ns_ without reversing time
  // The smallest offset since window_start_ns_ replaces the bound when the window is full.
  int window_count_ = 0;
  TimeNs window_start_ns_ = 0;
  DurationNs window_min_ns_ = 0;
  // A run of samples that agree with each other but not with the bound.
  int suspects_ = 0;
  DurationNs suspect_offset_ns_ = 0;
};

}  // namespace fathom::runtime
