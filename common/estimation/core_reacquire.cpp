// Nothing is locked out for ever: refusals that agree with each other are believed, and the estimate is given
// the room to follow (GATE-3).
#include <algorithm>
#include <cmath>

#include "estimation/core.hpp"

namespace fathom::estimation {
namespace {

constexpr int kRejectionsToBelieve = 3;
constexpr double kGravity_m_s2 = 9.81;
constexpr double kLeastUnheard_s = 1.0;

}  // namespace

bool measures(const Observation& observation, int row, int first_state) {
  const auto& h = observation.h[static_cast<std::size_t>(row)];
  const auto begin = h.begin() + first_state;
  return std::any_of(begin, begin + 3, [](double weight) { return weight != 0.0; });
}

unsigned Core::believed_rows(Sensor& sensor, const SensorConfig& config, const Observation& observation,
                             unsigned refused) {
  if (!observation.each_alone && config.gate_mode == GateMode::whole) {
    const bool believed =
        refused != 0 && believe(sensor.rejections[0], config, observation, 0, observation.rows);
    if (refused == 0) sensor.rejections[0] = {};
    return believed ? refused : 0U;
  }
  unsigned believed = 0;
  for (int row = 0; row < observation.rows; ++row) {
    Sensor::Rejections& past = sensor.rejections[static_cast<std::size_t>(row)];
    if ((refused & 1U << row) == 0) {
      past = {};
    } else if (believe(past, config, observation, row, row + 1)) {
      believed |= 1U << row;
    }
  }
  return believed;
}

bool Core::believe(Sensor::Rejections& past, const SensorConfig& config, const Observation& observation,
                   int first, int end) const {
  double size = 0.0;
  double change = 0.0;
  double noise = 0.0;
  for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
    const double z = observation.innovation[i];
    size += z * z;
    change += (z - past.innovation[i]) * (z - past.innovation[i]);
    noise += observation.sigma[i] * observation.sigma[i];
    past.innovation[i] = z;
  }
  const bool agrees = past.count > 0 && std::sqrt(change) < 0.5 * std::sqrt(size) + 4.0 * std::sqrt(noise);
  if (!agrees) {
    past.count = 1;
    past.since_ns = now_ns_;
    return false;
  }
  ++past.count;
  return config.reacquire_s > 0.0 && past.count >= kRejectionsToBelieve &&
         to_seconds(now_ns_ - past.since_ns) >= config.reacquire_s;
}

void Core::make_room(SourceKind source, const Sensor& sensor, const Observation& observation, unsigned rows,
                     double factor, std::array<double, kNavStates>& variance) const {
  const double unheard_s =
      std::max(sensor.used_ns == 0 ? kLeastUnheard_s : since(sensor.used_ns), kLeastUnheard_s);
  for (int row = 0; row < observation.rows; ++row) {
    if ((rows & 1U << row) == 0) continue;
    const auto r = static_cast<std::size_t>(row);
    const double squared = factor * observation.innovation[r] * observation.innovation[r];
    int first = 6;
    if (measures(observation, row, 0)) {
      first = 0;
    } else if (measures(observation, row, 3)) {
      first = 3;
    }
    // Of states that would explain the innovation: h z / |h|^2, whatever unit the row has.
    // A heading says nothing about tilt, however its row looks when the vehicle is pitched.
    const double* weights = observation.h[r].data() + first;
    const int least = source == SourceKind::heading ? 2 : 0;
    double weight = 0.0;
    for (int i = least; i < 3; ++i) weight += weights[i] * weights[i];
    if (weight == 0.0) continue;
    for (int i = least; i < 3; ++i)
      variance[static_cast<std::size_t>(first + i)] += squared * weights[i] * weights[i] / (weight * weight);
    // A velocity goes wrong by a level that is wrong: left as sure as it was, that would lead astray again.
    const bool over_ground = source == SourceKind::gps || source == SourceKind::dvl;
    if (first == 3 && over_ground && factor == 1.0) {
      const double tilt = observation.innovation[r] / (kGravity_m_s2 * unheard_s);
      variance[6] += tilt * tilt;
      variance[7] += tilt * tilt;
    }
  }
}

}  // namespace fathom::estimation
