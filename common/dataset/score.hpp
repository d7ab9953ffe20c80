#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "samples/nav_state.hpp"
#include "samples/truth.hpp"

/// How far a navigation state is from the truth. Shared by `fathom solve` and the demonstration's report.
namespace fathom::dataset {

/// The true trajectory, to be asked at any instant. Rows must come in the order of their stamps; a row that
/// does not is ignored.
class TruthTrack {
 public:
  /// Two rows further apart than `longest_gap_s` are not interpolated between.
  explicit TruthTrack(double longest_gap_s = 2.5);
  explicit TruthTrack(const std::vector<Truth>& rows, double longest_gap_s = 2.5);

  void add(const Truth& row);

  /// Linear in position and velocity, the shortest turn (slerp) in attitude. Nothing before the first row,
  /// after the last and inside a gap. header.stamp_ns of the answer is `stamp_ns`; gps_available that of the
  /// row before.
  [[nodiscard]] std::optional<Truth> at(TimeNs stamp_ns) const;

  [[nodiscard]] const std::vector<Truth>& rows() const { return rows_; }
  /// Horizontal path length between two instants, m; gaps count with their chord.
  [[nodiscard]] double distance_m(TimeNs from_ns, TimeNs to_ns) const;

 private:
  std::vector<Truth> rows_;
  std::vector<double> path_m_;  // horizontal path length up to each row
  DurationNs longest_gap_ns_;
};

/// Estimate minus truth.
struct NavError {
  TimeNs stamp_ns = 0;
  std::array<double, 3> position_N_m{kUnknown, kUnknown, kUnknown};  ///< north, east, down
  double horizontal_m = kUnknown;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_rad{kUnknown, kUnknown, kUnknown};  ///< differences of Euler angles, (-pi, pi]
  double nees_horizontal = kUnknown;  ///< e' P^-1 e of north and east, 2 degrees of freedom
  double nees_position = kUnknown;    ///< of the position, 3 degrees of freedom
  double nees_velocity = kUnknown;    ///< of the velocity, 3 degrees of freedom
};

/// North, east, down from `b` to `a` in metres: lat/lon differences times the WGS-84 radii at the mean
/// latitude and height; better than 1e-6 of the distance up to a few kilometres.
[[nodiscard]] std::array<double, 3> ned_difference_m(double a_latitude_rad, double a_longitude_rad,
                                                     double a_altitude_m, double b_latitude_rad,
                                                     double b_longitude_rad, double b_altitude_m);

/// Unknown parts of either side stay unknown in the error.
[[nodiscard]] NavError error_of(const NavState& state, const Truth& truth);

/// Root mean square, 95th percentile of the absolute value, largest and last value of one kind of error.
struct ErrorFigures {
  std::size_t count = 0;
  double rms = kUnknown;
  double p95 = kUnknown;
  double max = kUnknown;
  double end = kUnknown;
};

/// Mean normalised estimation error squared. `band_95` is where 95 % of single values of a consistent filter
/// lie (chi-square of `dof`); `inside` the share that did. The errors of one run are correlated in time, so
/// no narrower band for their mean can be stated honestly.
struct Nees {
  int dof = 0;
  std::size_t count = 0;
  double mean = kUnknown;
  std::array<double, 2> band_95{kUnknown, kUnknown};
  double inside = kUnknown;
};

struct Score {
  std::size_t count = 0;
  TimeNs first_ns = 0;
  TimeNs last_ns = 0;
  ErrorFigures horizontal_m;
  ErrorFigures distance_3d_m;
  std::array<ErrorFigures, 3> position_N_m;
  std::array<ErrorFigures, 3> velocity_N_m_s;
  std::array<ErrorFigures, 3> rpy_rad;
  Nees nees_horizontal;
  Nees nees_position;
  Nees nees_velocity;
};

/// Collects errors and turns them into figures at the end.
class Scorer {
 public:
  /// Room for so many errors, for the sake of speed.
  void reserve(std::size_t count) { errors_.reserve(count); }
  void add(const NavError& error);
  [[nodiscard]] const std::vector<NavError>& errors() const { return errors_; }
  [[nodiscard]] Score score() const;

 private:
  std::vector<NavError> errors_;
};

}  // namespace fathom::dataset
