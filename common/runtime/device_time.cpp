#include "runtime/device_time.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::runtime {
namespace {

constexpr DurationNs kDay = 86'400 * kNsPerSecond;
constexpr DurationNs kGpsRollover = 1024 * 7 * kDay;
constexpr int kConfirmations = 3;
constexpr int kFewestInWindow = 20;

/// How long ago the sample was valid when the quickest frame that says so of itself arrives.
DurationNs least_age(const DeviceTime& device, const TimeConfig& config) {
  return std::max(from_seconds(config.minimum_latency_s), device.age_ns.value_or(0));
}

}  // namespace

DeviceTimeTracker::DeviceTimeTracker(const TimeConfig& config) : config_(config) {}

void DeviceTimeTracker::reset() {
  anchored_ = false;
  foreseen_ns_.reset();
  suspects_ = 0;
}

void DeviceTimeTracker::foresee(const DeviceTime& device, const Arrival& arrival) {
  const auto clock = device.clock_ns ? device.clock_ns : device.utc_ns;
  if (config_.mode != TimeMode::device_clock || anchored_ || !clock) return;
  const DurationNs beyond = least_age(device, config_) - from_seconds(config_.minimum_latency_s);
  const DurationNs offset = arrival.monotonic_ns - beyond - (*clock + wrapped_ns_);
  // Frames do not gather for longer than delays last: such a one was damaged, or the counter began anew.
  if (foreseen_ns_ && std::abs(offset - *foreseen_ns_) > from_seconds(config_.window_s)) return;
  foreseen_ns_ = std::min(foreseen_ns_.value_or(offset), offset);
}

Stamp DeviceTimeTracker::stamp(const DeviceTime& device, const Arrival& arrival) {
  Stamp out;
  out.utc_ns =
      arrival.utc_ns - from_seconds(config_.latency_s) - std::max<DurationNs>(0, device.age_ns.value_or(0));
  if (config_.mode == TimeMode::device_utc) {
    const auto utc = utc_of(device, arrival, out);
    out.from_arrival = !utc.has_value();
    if (utc) out.utc_ns = *utc;
  } else if (config_.mode == TimeMode::device_clock) {
    const auto clock = device.clock_ns ? device.clock_ns : device.utc_ns;
    const DurationNs least = least_age(device, config_);
    const auto age = clock ? track(*clock, least, arrival.monotonic_ns, out.clock_step) : std::nullopt;
    out.from_arrival = !age.has_value();
    if (age) {
      out.utc_ns = arrival.utc_ns - *age;
    } else if (clock) {
      out.utc_ns = arrival.utc_ns - least;
    }
  }
  out.backwards = last_stamp_ns_ && out.utc_ns < *last_stamp_ns_;
  last_stamp_ns_ = out.utc_ns;
  return out;
}

std::optional<TimeNs> DeviceTimeTracker::utc_of(const DeviceTime& device, const Arrival& arrival,
                                                Stamp& out) const {
  const DurationNs tolerance = from_seconds(config_.tolerance_s);
  const DurationNs oldest = from_seconds(config_.max_age_s);
  const auto believable = [&](TimeNs utc) {
    return utc <= arrival.utc_ns + tolerance && utc >= arrival.utc_ns - oldest;
  };
  if (device.utc_ns) {
    TimeNs utc = *device.utc_ns;
    if (believable(utc)) return utc;
    // A receiver whose week counter overflowed is wrong by a multiple of 1024 weeks and else right.
    const auto turns =
        std::llround(static_cast<double>(arrival.utc_ns - utc) / static_cast<double>(kGpsRollover));
    utc += turns * kGpsRollover;
    if (turns != 0 && believable(utc)) {
      out.week_rollover = true;
      return utc;
    }
    out.implausible = true;
    out.implausible_by_s = to_seconds(*device.utc_ns - arrival.utc_ns);
    return std::nullopt;
  }
  if (device.time_of_day_ns) {
    // The date that brings it closest to the arrival: around midnight that is not always the arrival's own.
    const TimeNs midnight = arrival.utc_ns - ((arrival.utc_ns % kDay) + kDay) % kDay;
    TimeNs utc = midnight + *device.time_of_day_ns;
    if (utc - arrival.utc_ns > kDay / 2) utc -= kDay;
    if (arrival.utc_ns - utc > kDay / 2) utc += kDay;
    if (believable(utc)) return utc;
    out.implausible = true;
    out.implausible_by_s = to_seconds(utc - arrival.utc_ns);
  }
  return std::nullopt;
}

void DeviceTimeTracker::anchor(DurationNs offset, TimeNs unwrapped_ns, TimeNs arrival_ns) {
  anchored_ = true;
  bound_ns_ = offset;
  applied_ns_ = offset;
  window_start_ns_ = arrival_ns;
  window_min_ns_ = offset;
  window_count_ = 1;
  suspects_ = 0;
  last_device_ns_ = unwrapped_ns;
  last_arrival_ns_ = arrival_ns;
}

std::optional<DurationNs> DeviceTimeTracker::track(TimeNs device_ns, DurationNs least, TimeNs arrival_ns,
                                                   bool& stepped) {
  const DurationNs rollover = from_seconds(config_.rollover_s);
  if (anchored_ && rollover > 0) {
    if (device_ns - last_raw_ns_ < -rollover / 2) wrapped_ns_ += rollover;
    if (device_ns - last_raw_ns_ > rollover / 2) wrapped_ns_ -= rollover;  // one late frame of before
  }
  last_raw_ns_ = device_ns;
  const TimeNs now_device = device_ns + wrapped_ns_;
  const DurationNs minimum = from_seconds(config_.minimum_latency_s);
  const DurationNs offset = arrival_ns - (least - minimum) - now_device;
  if (!anchored_) {
    anchor(std::min(offset, foreseen_ns_.value_or(offset)), now_device, arrival_ns);
    return least + (offset - applied_ns_);
  }

  const DurationNs jump = from_seconds(config_.jump_s);
  const DurationNs passed = std::max<DurationNs>(0, arrival_ns - last_arrival_ns_);
  const auto drift = static_cast<DurationNs>(static_cast<double>(passed) * config_.drift_ppm * 1e-6);

  // Sooner than the quickest frame by more than any drift, or a clock that runs backwards by more than that:
  // a step, or one damaged time. Three in a row that agree decide.
  const bool ahead = offset < bound_ns_ + drift - jump;
  const bool behind = now_device < last_device_ns_ - jump;
  if (ahead || behind) {
    const bool agrees = suspects_ > 0 && std::abs(offset - suspect_offset_ns_) <= jump;
    suspects_ = agrees ? suspects_ + 1 : 1;
    suspect_offset_ns_ = agrees ? std::min(suspect_offset_ns_, offset) : offset;
    if (suspects_ < kConfirmations) return std::nullopt;
    anchor(suspect_offset_ns_, now_device, arrival_ns);
    stepped = true;
    ++clock_steps_;
    return minimum + (arrival_ns - (now_device + applied_ns_));
  }
  suspects_ = 0;

  bound_ns_ = std::min(bound_ns_ + drift, offset);
  window_min_ns_ = std::min(window_min_ns_ + drift, offset);
  if (++window_count_ >= kFewestInWindow && arrival_ns - window_start_ns_ > from_seconds(config_.window_s)) {
    // Not one frame in a whole window came near the bound: no delay lasts that long, the clock was set back.
    if (window_min_ns_ - bound_ns_ > jump) {
      stepped = true;
      ++clock_steps_;
    }
    bound_ns_ = window_min_ns_;
    window_start_ns_ = arrival_ns;
    window_min_ns_ = offset;
    window_count_ = 1;
  }

  const DurationNs interval = std::max<DurationNs>(0, now_device - last_device_ns_);
  applied_ns_ = bound_ns_ >= applied_ns_ ? bound_ns_ : std::max(bound_ns_, applied_ns_ - interval / 2);
  last_device_ns_ = std::max(last_device_ns_, now_device);
  last_arrival_ns_ = arrival_ns;
  return minimum + std::max<DurationNs>(0, arrival_ns - (now_device + applied_ns_));
}

}  // namespace fathom::runtime
