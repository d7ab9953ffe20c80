#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/device_time.hpp"
#include "codec/satellite/nmea_gps.hpp"
#include "samples/gps.hpp"

namespace fathom::codec {

/// Joins the sentences of one epoch into one sample.
///
/// Sentences belong together that carry the same time; VTG carries none and belongs to the epoch it follows.
/// An epoch is over when a sentence of the next one arrives. It is delivered earlier, with its last sentence,
/// once it has everything that any of the last epochs had: a receiver's cycle is learned from the first two.
/// Nothing is ever delivered twice, and nothing depends on how the bytes arrived.
///
/// Two sentences of one time whose positions lie apart further than rounding and the receiver's own sigma
/// allow are not one fix: the later one is refused.
///
/// The date comes from RMC or ZDA and is carried over midnight; before one was seen only the time of day is
/// given. Without a valid fix the sample has `fix` none and unknown position and velocity, so that a receiver
/// without sky is still seen alive.
class GpsEpochs {
 public:
  using Deliver = std::function<void(const GpsSample& sample, const DeviceTime& time, std::uint64_t offset,
                                     std::uint64_t length)>;

  /// False when the report contradicts what the epoch has already; it then changes nothing.
  [[nodiscard]] bool add(const GpsReport& report, std::uint64_t offset, std::uint64_t length,
                         const Deliver& deliver);
  /// The stream has ended: what is open is delivered.
  void finish(const Deliver& deliver);

 private:
  struct Epoch {
    std::array<std::optional<GpsReport>, kGpsSentences> part;
    std::optional<DurationNs> time_of_day;
    std::optional<TimeNs> midnight;
    std::uint64_t offset = 0;
    std::uint64_t end = 0;
    bool delivered = false;

    [[nodiscard]] bool has(GpsSentence type) const {
      return part[static_cast<std::size_t>(type)].has_value();
    }
    [[nodiscard]] const GpsReport* find(GpsSentence type) const;
    [[nodiscard]] std::uint8_t mask() const;
  };
  struct Waiting {
    GpsReport report;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };

  void date_epoch(const GpsReport& report);
  [[nodiscard]] bool belongs(const GpsReport& report) const;
  [[nodiscard]] bool contradicts(const GpsReport& report) const;
  void join(const GpsReport& report, std::uint64_t offset, std::uint64_t length);
  void open_next(const GpsReport& report, std::uint64_t offset, std::uint64_t length, const Deliver& deliver);
  void close(const Deliver& deliver);
  void deliver_open(const Deliver& deliver);
  [[nodiscard]] bool cycle_complete() const;
  [[nodiscard]] DeviceTime time_of(const Epoch& epoch);

  static constexpr std::size_t kHistory = 16;

  std::optional<Epoch> epoch_;
  std::optional<Waiting> waiting_vtg_;  ///< no epoch to follow yet
  std::optional<Waiting> waiting_gst_;  ///< of a time whose epoch has not begun
  std::array<std::uint8_t, kHistory> cycles_{};
  std::size_t closed_ = 0;
  /// The last date known and the time of day it was known at.
  std::optional<TimeNs> midnight_;
  DurationNs dated_at_ = 0;
};

}  // namespace fathom::codec
