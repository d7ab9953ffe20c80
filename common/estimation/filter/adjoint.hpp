#pragma once

#include <span>

#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

/// Error transition of one step, x' = Phi x (KF-1): the nine navigation rows are [a b 0], all other states
/// keep the share `keep` of themselves.
struct Transition {
  Matrix9 a = Matrix9::Identity();
  ImuColumns b;
  std::array<double, kMaxStates> keep{};  ///< from index 9 on
};
/// Of what ErrorFilter::propagate() does with the same arguments.
[[nodiscard]] Transition transition(const NavTransition& step, const ProcessNoise& noise);

/// What an update leaves behind for the way back.
struct UpdateRecord {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, Observation::kMaxRows,
                             kMaxStates>;
  using Square =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Observation::kMaxRows, Observation::kMaxRows>;

  UpdateRecord() = default;
  UpdateRecord(const Observation& observation, const InnovationStatistics& statistics, int states);

  Rows h;                                                                                     ///< m x n
  Rows gain;                                                                                  ///< K', m x n
  Square weight;                                                                              ///< S^-1
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Observation::kMaxRows, 1> weighted_innovation;  ///< S^-1 z
};

/// Room that was made for navigation states which had drifted, for the way back.
struct DriftRecord {
  DriftRecord() = default;
  /// `widened`: with the room already in it.
  DriftRecord(const ErrorFilter& widened, const std::array<double, kNavStates>& variance);

  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kNavStates, kNavStates>;
  std::array<int, kNavStates> states{};  ///< that got room; as many as the matrices have rows
  Block known;                           ///< P^-1 of them before
  Block stretch;                         ///< known times the room
};

/// An error that was there all the time and has been found, for the way back.
struct ShiftRecord {
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;

  ShiftRecord() = default;
  /// `filter`: before it.
  ShiftRecord(const ErrorFilter& filter, const std::array<double, kMaxStates>& column, double mean,
              double variance);

  Vector column;
  Vector known;  ///< P^-1 column, of what is estimated
  double mean = 0.0;
  double variance = 0.0;
};

/// What all later measurements say about the present error, as the gradient `lambda` and the curvature
/// `Lambda` of their likelihood: the smoothed error is -P lambda, its covariance P - P Lambda P (SMOOTH-1).
/// Goes backwards in time. Equal to a Rauch-Tung-Striebel smoother, without inverting a covariance.
class Adjoint {
 public:
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;

  /// Nothing is known of the future.
  explicit Adjoint(int states);
  Adjoint(const Vector& lambda, const Matrix& curvature) : lambda_(lambda), curvature_(curvature) {}

  /// From after to before what the filter did.
  void back_through(const Transition& step);      // (SMOOTH-2)
  void back_through(const UpdateRecord& update);  // (SMOOTH-3)
  void back_through(const DriftRecord& drift);    // (SMOOTH-5)
  void back_through(const ShiftRecord& shift);    // (SMOOTH-6)
  void back_through(const Carry& carry);          // (KF-5): as a step without noise
  void back_through_forgotten(int state);         // (SMOOTH-4)
  /// Before a new start of the filter: the future knows nothing of what was before it.
  void cut();

  /// -P lambda: the error that the filter with covariance `p` would be told by all later measurements.
  void smoothed_error(const ErrorFilter& p, std::array<double, kMaxStates>& x) const;
  /// Replaces what `states` share among themselves in `p` by what P - P Lambda P says of it.
  void smooth_covariance(std::span<const int> states, ErrorFilter& p) const;

 private:
  [[nodiscard]] int size() const { return static_cast<int>(lambda_.size()); }

  Vector lambda_;
  Matrix curvature_;
};

}  // namespace fathom::estimation
