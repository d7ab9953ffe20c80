#pragma once

#include <vector>

#include <Eigen/Core>

namespace fathom::study {

/// A quantity over time: a start, smooth steps and swings. Three times differentiable, so that rates and
/// accelerations follow from it without jumps.
class Profile {
 public:
  explicit Profile(double start = 0.0) : start_(start) {}
  /// Adds `by` between `at_s` and `at_s + over_s`.
  Profile& step(double at_s, double over_s, double by);
  /// Swings from the beginning on.
  Profile& swing(double amplitude, double period_s, double phase_rad);

  struct Value {
    double value;
    double rate;
  };
  [[nodiscard]] Value at(double t_s) const;

 private:
  struct Step {
    double at_s = 0.0;
    double over_s = 0.0;
    double by = 0.0;
    double done = 0.0;   ///< sum of this step and all before it
    double end_s = 0.0;  ///< when they are over
  };
  struct Swing {
    double amplitude;
    double rate_rad_s;
    double phase_rad;
  };
  double start_;
  std::vector<Step> steps_;
  std::vector<Swing> swings_;
};

/// A vehicle's attitude and velocity over ground.
struct Movement {
  Eigen::Matrix3d axes_NB;
  Eigen::Vector3d velocity_N_m_s;
};

/// How a vehicle moves: attitude and velocity over ground as functions of time alone.
struct Manoeuvres {
  Profile heading_rad;
  Profile pitch_rad;
  Profile bank_rad;                        ///< on top of the coordinated bank
  Profile speed_m_s;                       ///< through the medium
  bool coordinated = false;                ///< banks as its turn asks for
  double angle_of_attack_rad = 0.0;        ///< of the flow below the body's forward axis
  double crab_rad = 0.0;                   ///< of the flow to the right of it
  double sway_per_turn_m = 0.0;            ///< sideways velocity by turn rate
  Profile slip_m_s;                        ///< of wheels that roll: to the right
  Profile bounce_m_s;                      ///< likewise, down
  Eigen::Vector2d medium_N_m_s{0.0, 0.0};  ///< current or wind
  Profile medium_share{1.0};               ///< how much of it acts
  Profile heave_m_s;                       ///< vertical velocity of the water that carries it

  [[nodiscard]] Movement at(double t_s) const;
};

}  // namespace fathom::study
