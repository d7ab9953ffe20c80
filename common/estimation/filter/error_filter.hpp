#pragma once

#include <algorithm>
#include <array>

#include "estimation/filter/carry.hpp"
#include "estimation/filter/nav_transition.hpp"
#include "estimation/filter/observation.hpp"
#include "estimation/filter/state_drift.hpp"

namespace fathom::estimation {

/// Of a row of S to the next one.
inline constexpr std::size_t kStatisticsStride = Observation::kMaxRows;

/// Covariance of an innovation and what follows from it.
struct InnovationStatistics {
  int rows = 0;
  /// S = H P H' + R, row-major with stride kMaxRows.
  std::array<double, Observation::kMaxRows * Observation::kMaxRows> s{};
  std::array<double, Observation::kMaxRows * kMaxStates> ph{};  ///< row i: (P H')' of component i
  std::array<double, Observation::kMaxRows> noise{};            ///< R, the variances that are in S
  double squared_distance = 0.0;                                ///< innovation' S^-1 innovation
};

/// innovation' S^-1 innovation of these statistics; infinite where S is not positive.
[[nodiscard]] double squared_distance(const Observation& observation, const InnovationStatistics& statistics);

/// Noise that enters during one step, per second.
struct ProcessNoise {
  Eigen::Matrix3d velocity = Eigen::Matrix3d::Zero();  ///< m^2/s^3
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Zero();  ///< rad^2/s
  const StateDrift* drift = nullptr;                   ///< of the states from index 9 on; must outlive this
};

class FilterTape;

/// Error-state covariance with the structure of an inertial navigator: only the nine navigation rows move,
/// driven by the groups of the inertial unit; the rest keep still or decay one by one. The last states may be
/// considered (KF-6): no measurement finds their value. Fixed size, nothing allocated; a copy costs what is
/// in use. The matrix is exactly symmetric at all times.
class ErrorFilter {
 public:
  explicit ErrorFilter(int states = 0)
      : n_(states), estimated_(states), held_{states, states, states, states} {}
  explicit ErrorFilter(const StateIndex& index)
      : n_(index.size()), estimated_(index.estimated()), held_(index.held()) {}
  ErrorFilter(const ErrorFilter& other)
      : n_(other.n_), estimated_(other.estimated_), held_(other.held_), tape_(other.tape_) {
    copy(other);
  }
  ErrorFilter& operator=(const ErrorFilter& other) {
    n_ = other.n_;
    estimated_ = other.estimated_;
    held_ = other.held_;
    tape_ = other.tape_;
    if (this != &other) copy(other);
    return *this;
  }

  [[nodiscard]] int size() const { return n_; }
  /// The first ones, which measurements find; the others are considered.
  [[nodiscard]] int estimated() const { return estimated_; }
  [[nodiscard]] double operator()(int row, int column) const { return p_[at(row, column)]; }
  /// Three rows and columns from these on.
  [[nodiscard]] Eigen::Matrix3d block3(int row, int column) const {
    Eigen::Matrix3d p;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) p(i, j) = (*this)(row + i, column + j);
    return p;
  }
  void set(int row, int column, double value) {
    p_[at(row, column)] = value;
    p_[at(column, row)] = value;
  }
  /// Everything to zero but `sigma` squared on the diagonal.
  void reset(const std::array<double, kMaxStates>& sigma);
  /// Forgets what is known about one state.
  void forget(int state, double sigma);
  /// Adds variance to one state: something unknown happened to it now.
  void widen(int state, double variance) { p_[at(state, state)] += variance; }
  /// Adds variance to the navigation states: they have drifted further than P knew, before now.
  void widen_drifted(const std::array<double, kNavStates>& variance);
  /// The error was `mean` times `column` all the time, with `variance` about that, without P knowing: the
  /// estimate has to be moved by that. P gets what is uncertain about it, and of what is considered and
  /// cannot be moved the whole of it.
  void shift(const std::array<double, kMaxStates>& column, double mean, double variance);
  /// P <- T P T', T the identity but for the states that are written anew (KF-5).
  void carry(const Carry& carry);

  /// Tells `tape`, which must outlive the filter's work, all that follows; nullptr for silence. Copies of the
  /// filter tell the same tape.
  void record_to(FilterTape* tape) { tape_ = tape; }
  [[nodiscard]] FilterTape* tape() const { return tape_; }

  /// P <- Phi P Phi' + Q (KF-1).
  void propagate(const NavTransition& transition, const ProcessNoise& noise);

  /// (KF-2). With `noise_scale` R is multiplied by it.
  void statistics(const Observation& observation, double noise_scale, InnovationStatistics& out) const;

  /// P <- P - K S K' and the estimated error x = K innovation (KF-3), positive also where the measurement
  /// knows a billion times more than P. What is considered gets none of it, and keeps its own covariance
  /// (KF-6). False, with nothing changed, when S is not positive.
  bool update(const Observation& observation, const InnovationStatistics& statistics,
              std::array<double, kMaxStates>& x);

  /// For archives: see fields/filter.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * kRowStride + column);
  }
  /// How little rounding may leave of P - K S K' beside R: the Joseph form is due (KF-3).
  [[nodiscard]] bool dwarfs(const Observation& observation, const InnovationStatistics& statistics) const;
  /// What rounding has made of P - K S K' becomes (I - K H) of it (KF-3); `gain` holds K by rows of
  /// kMaxStates.
  void settle_rounding(const Observation& observation, const InnovationStatistics& statistics,
                       const double* gain);
  /// Columns that the loops run over: an even number, so that two always go together. The odd one is zero.
  [[nodiscard]] int width() const { return (n_ + 1) & ~1; }
  void copy(const ErrorFilter& other);

  int n_;
  int estimated_;
  HeldStates held_;
  FilterTape* tape_ = nullptr;
  alignas(64) std::array<double, static_cast<std::size_t>(kMaxStates) * kRowStride> p_{};
};

/// Hears what a filter does, in its order: what a smoother goes back along. Variance added by widen() is
/// process noise, which the way back does not ask for.
class FilterTape {
 public:
  /// The arguments of ErrorFilter::propagate().
  virtual void propagated(const NavTransition& transition, const ProcessNoise& noise) = 0;
  /// A measurement has been taken in; `statistics` are those of before.
  virtual void updated(const Observation& observation, const InnovationStatistics& statistics) = 0;
  virtual void forgot(int state) = 0;
  /// ErrorFilter::widen_drifted() has been done with `variance`.
  virtual void drifted(const ErrorFilter& widened, const std::array<double, kNavStates>& variance) = 0;
  /// The arguments of ErrorFilter::shift(), which has not been done yet to `filter`.
  virtual void shifted(const ErrorFilter& filter, const std::array<double, kMaxStates>& column, double mean,
                       double variance) = 0;
  /// ErrorFilter::carry() has been done.
  virtual void carried(const Carry& carry) = 0;
  virtual void restarted() = 0;

 protected:
  ~FilterTape() = default;
};

/// Moves the estimate by the estimated error and so makes the error zero (KF-4): navigation errors are
/// estimate minus truth, all others truth minus estimate; the quaternion is multiplied, not added to.
void remove_error(const std::array<double, kMaxStates>& x, int states, FilterState& state);

}  // namespace fathom::estimation
