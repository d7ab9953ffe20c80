#pragma once

#include <memory>

namespace fathom::cli {

/// What the same number of states costs without knowing any zero: Eigen matrices of fixed size, column-major
/// doubles, all of them filled.
class DenseFloor {
 public:
  virtual ~DenseFloor() = default;
  /// P <- Phi P Phi' + Q.
  virtual void predict() = 0;
  /// P <- (I - K H) P (I - K H)' + K R K', with K from S = H P H' + R.
  virtual void update() = 0;
  /// P as in the beginning.
  virtual void reset() = 0;
  [[nodiscard]] virtual int states() const = 0;
};

/// With `states` states, or with the next lower number that this executable has been compiled for (every
/// number from 40 to 64, and 15, 25, 26, 30, 35), and measurements of `rows` (1 to 6) components.
[[nodiscard]] std::unique_ptr<DenseFloor> dense_floor(int states, int rows);

}  // namespace fathom::cli
