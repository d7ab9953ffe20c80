#pragma once

#include <array>
#include <optional>

#include "estimation/filter/gate.hpp"
#include "estimation/navigator/navigator.hpp"

namespace fathom::estimation {

/// A position that somebody tells moves the estimate between two of its own corrections: further than this,
/// whoever steers by it is told of a step.
inline constexpr double kNoticed_m = 1.0;

struct Navigator::Trial {
  const Measurement& measurement;
  const SensorConfig& config;
  const SensorConfig* rules;  ///< of the gate: the sensor's, or the vehicle model's
  const GateLimits* limits;
  Instrument& instrument;
  Remembered* then = nullptr;  ///< of one that comes late
  TimeNs instant_ns = 0;       ///< of which it speaks
  Judgement judgement{};
  ModelAiding::Drive drive = ModelAiding::Drive::nothing;
  ModelAiding::Trial model{};
  bool modelled = false;  ///< the vehicle model speaks for the shaft speed
  AidingPolicy policy{};
  bool with_position = false;
  bool fix = false;                   ///< it is refused or believed by how it agrees with the motion
  Observation whole{};                ///< every row
  std::optional<Observation> kept{};  ///< the rows that act, with the noise they act with; from the gate on
  InnovationStatistics statistics{};
  GateResult gated{};
  bool stepped = false;  ///< the position steps with it
  std::array<double, kMaxStates> x{};

  /// Ends the way.
  bool end(VerdictKind kind) {
    judgement.kind = kind;
    return false;
  }
  /// What the verdict says of all rows, whichever of them act.
  void describe() {
    judgement.dimensions = static_cast<std::uint32_t>(whole.rows);
    for (std::size_t i = 0; i < static_cast<std::size_t>(whole.rows); ++i) {
      judgement.innovation[i] = whole.innovation[i];
      judgement.innovation_sigma[i] = gated.innovation_sigma[i];
    }
    judgement.test_ratio = gated.test_ratio;
    judgement.limit = gated.limit;
  }
};

}  // namespace fathom::estimation
