#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/time.hpp"
#include "ros2/messages/geometry.hpp"
#include "samples/header.hpp"

/// What comes from ROS 2 becomes a sample here, or is refused with a reason.
namespace fathom::ros2 {

enum class Refusal : std::uint8_t {
  frame,       ///< frame_id is not the one that is configured
  stamp,       ///< none, too old, from the future, or no time at all
  repeated,    ///< not later than the last one
  missing,     ///< what the sample is worth nothing without
  value,       ///< not finite, or beyond what it can mean
  covariance,  ///< negative and not -1, or not finite
};
inline constexpr std::size_t kRefusals = 6;
[[nodiscard]] std::string_view to_string(Refusal refusal);

/// A sample, or why there is none: one English sentence that names what was wrong and what was expected.
template <class Sample>
struct Entry {
  Entry(Sample in) : sample(std::move(in)) {}  // NOLINT(google-explicit-constructor)
  Entry(Refusal reason, std::string sentence) : why(reason), text(std::move(sentence)) {}

  std::optional<Sample> sample;
  Refusal why = Refusal::value;
  std::string text;
};

struct DoorOptions {
  Name vehicle;
  Name sensor;
  std::string frame_id;                      ///< that messages have to name; empty: any
  DurationNs oldest_ns = 10 * kNsPerSecond;  ///< at arrival
  DurationNs ahead_ns = kNsPerSecond / 2;    ///< of our clock
  bool stamp_on_arrival = false;             ///< the sender's clock is not ours: its stamps are not used
};

/// The checks that every message has to pass: frame and time.
class Door {
 public:
  explicit Door(DoorOptions options) : options_(std::move(options)) {}

  /// The header of the sample that is made of this message, without its number.
  [[nodiscard]] Entry<SampleHeader> enter(const Header& header, TimeNs now_ns);
  /// Gives the header its number. Call it once the rest of the message is good.
  void published(SampleHeader& header);

 private:
  DoorOptions options_;
  TimeNs last_ns_ = 0;
  std::uint64_t sequence_ = 0;
};

/// ns since the Unix epoch; nothing where nanosec is beyond a second.
[[nodiscard]] std::optional<TimeNs> stamp_of(const Time& time);

/// A variance in a covariance of ROS 2: NaN where it is 0 or -1, which say that it is not known. Nothing
/// where it is another negative number or not finite.
[[nodiscard]] std::optional<double> sigma_of(double variance);

}  // namespace fathom::ros2
