#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"

namespace fathom::explain {

/// What was found. In the order of causes: what stands earlier may bring about what stands later, and not
/// the other way round.
enum class Kind : std::uint8_t {
  clock_set,       ///< a host's clock was set; subject: host
  clock_jump,      ///< stamps of a sensor jumped against their arrival
  second_writer,   ///< two processes give one sensor's samples at once
  takeover,        ///< another fusion gives the navigation state
  restart,         ///< a service was started again
  stalled,         ///< a service gave no life sign, and was not started again
  imu_late,        ///< inertial samples arrive late
  imu_gap,         ///< inertial samples are missing
  not_aligned,     ///< alignment was not reached, or late
  wrong_heading,   ///< the compass, or navigation's heading, is off
  interference,    ///< a receiver says itself that it is jammed or deceived
  frozen,          ///< a value repeats while the vehicle moves
  jump,            ///< a source stands aside of navigation at once, and for long
  drag,            ///< a source walks away from navigation
  outliers,        ///< single values far off among good ones
  noisy,           ///< a source scatters more than is said of it
  biased,          ///< a bias of the inertial unit is larger than is said of it
  wrong_lever,     ///< innovations turn with the vehicle
  lost,            ///< a source that had been used gave nothing that could be used
  refused,         ///< many measurements not used for a reason of their own: late, twice, frame
  alignment_lost,  ///< navigation aligned itself anew
  state_gap,       ///< the navigation state was silent
  reset,           ///< the position stepped
  growth,          ///< the uncertainty grew
};
inline constexpr std::size_t kKinds = 24;
[[nodiscard]] std::string_view to_string(Kind kind);

enum class Weight : std::uint8_t {
  bad,      ///< navigation is, or was, not to be trusted, or was close to it
  caution,  ///< worth a look
  note,     ///< belongs to such a run; nobody need look
};
[[nodiscard]] std::string_view to_string(Weight weight);

struct Figure {
  std::string name;  ///< with its unit, e.g. "apart_m"
  double value = kUnknown;
};

/// Where it can be seen in the recording.
struct Evidence {
  std::string topic;
  std::uint64_t count = 0;  ///< messages; 0: not counted
  std::string what;
};

/// A source that navigation used while it refused another one.
struct Agreeing {
  std::string sensor;
  std::uint64_t used = 0;  ///< measurements
};

struct Finding {
  Kind kind = Kind::lost;
  Weight weight = Weight::caution;
  std::string subject{};  ///< sensor, service or host
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
  std::string word{};  ///< what the sentence needs besides, by kind; e.g. the reason of a loss
  std::string said{};  ///< of a silent instrument: what its bridge said of it
  std::vector<Figure> figures{};
  std::vector<Evidence> evidence{};
  std::vector<Agreeing> agreeing{};  ///< of two that contradict each other they tell which is wrong
  /// Index of the finding that brought it about, in the same list.
  std::optional<std::size_t> follows_from{};

  /// Unknown where it has none of that name.
  [[nodiscard]] double figure(std::string_view name) const;
};

using Findings = std::vector<Finding>;

/// Of two that may have brought about what began at an instant: whether `one` began nearer before it than
/// `other`, instants being those of whole seconds; or less long after it, where none began before it.
[[nodiscard]] bool began_nearer(const Finding& one, const Finding& other, TimeNs at_ns);

}  // namespace fathom::explain
