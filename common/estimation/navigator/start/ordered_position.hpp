#pragma once

#include "estimation/navigator/estimate.hpp"
#include "estimation/navigator/measurement.hpp"

namespace fathom::estimation {

/// Positions that a person orders: kept for a start, or held until they are confirmed.
struct OrderedPosition {
  // For a start, of the point that is published.
  bool is_set = false;
  TimeNs set_ns = 0;
  geo::Geodetic position;  ///< without altitude
  double depth_m = kUnknown;
  double sigma_m = 0.0;
  TimeNs held_ns = 0;           ///< of one that waits for its confirmation; 0: none
  geo::Geodetic held_position;  ///< without altitude

  /// What an order would do: the position wanted, and of the point of the IMU the step to it.
  struct Step {
    geo::Geodetic wanted;
    Eigen::Vector3d step_N_m = Eigen::Vector3d::Zero();
    int axes = 2;  ///< 3 with a depth
    Judgement judgement;
  };
  /// Before navigation: the position is kept for the start.
  void keep(const Estimate& estimate, const Command& command);
  /// While it navigates: `used` when the order may act, `rejected` when it is held.
  [[nodiscard]] Step propose(const Setup& setup, const Estimate& estimate, const Command& command);

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.set_ns);
    visit(self.held_ns);
  }

 private:
  /// The same position was held, and this order confirms it.
  [[nodiscard]] bool is_confirmed(const Estimate& estimate, const Command& command,
                                  const geo::Geodetic& ordered) const;
};

}  // namespace fathom::estimation
