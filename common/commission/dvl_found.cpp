#include "commission/dvl_found.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "commission/fit/reject.hpp"
#include "commission/fit/signed_axes.hpp"
#include "geo/so3.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFirst_s = 16.0;          // length of the windows at first
constexpr std::size_t kMost = 250;         // windows
constexpr std::size_t kLeastWindows = 12;  // for a scatter between them that means something
constexpr double kPerDvlWindow = 6.0;      // independent figures that a window counts for
constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
// A mounting is told from the next of a box, a quarter of a turn away, where so many sigmas are half of that.
constexpr double kBoxSigmas = 4.0;

// Of several lengths of window the one whose figures of the mounting are the surest.
DvlFigures fit_best(const Series& series, const Assumed& assumed, const ImuReading& reading,
                    const DvlFigures& first) {
  DvlFigures best = first;
  for (const double length_s : {8.0, 12.0, 16.0, 24.0, 36.0}) {
    const std::vector<Span> windows = windows_of(series, series.dvl, length_s, 6, kMost);
    if (windows.size() < kLeastWindows) continue;
    const DvlFigures now =
        fit_dvl(series, windows, reading, first.similarity, assumed.dvl.lever_B_m, first.latency_s);
    if (now.done && now.similarity.turn_sigma_rad.minCoeff() > 0.0 &&
        now.similarity.turn_sigma_rad.norm() < best.similarity.turn_sigma_rad.norm())
      best = now;
  }
  return best;
}

// Log likelihood ratio of `best` over `other`.
double ratio(const DvlFigures& other, const DvlFigures& best) {
  return kPerDvlWindow * static_cast<double>(best.windows) * std::log(other.residual_m_s / best.residual_m_s);
}

Vector3d way_of(const VectorSeries& dvl) {
  Matrix3d sum = Matrix3d::Zero();
  for (const Vector3d& v : dvl.v) sum += v * v.transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(sum).eigenvectors().col(2);
}

Matrix3d turn_about(const Vector3d& axis, double angle_rad) {
  return geo::to_matrix(geo::exp(Vector3d(angle_rad * axis)));
}

// One of the 24 mountings of a box is the nearest of both.
bool next_to(const Matrix3d& C, const Matrix3d& other) {
  return nearest_signed_axes(other.transpose() * C).isIdentity(1e-9);
}

// Turned about those axes as near to what is configured as it can be.
Matrix3d as_configured_about(const std::vector<Vector3d>& axes, const Matrix3d& found,
                             const Matrix3d& configured) {
  constexpr int kPasses =
      10;  // each brings it nearer, the first as near as it can be where there is one axis
  Matrix3d C = found;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const Vector3d& axis : axes) {
      const Matrix3d apart = configured.transpose() * C;
      const double sine = (apart * geo::skew(axis)).trace();
      const double cosine = apart.trace() - axis.dot(apart * axis);
      C = C * turn_about(axis, std::atan2(sine, cosine));
    }
  }
  return C;
}

// Turns that the log does not tell.
std::vector<Vector3d> untold_turns(const DvlFound& found) {
  std::vector<Vector3d> out;
  if (found.about_the_way != DvlFound::AboutTheWay::told) out.push_back(found.way_D);
  for (int axis = 0; axis < 3; ++axis)
    if (!(found.fit.similarity.turn_sigma_rad[axis] < kToldTurn_rad)) out.emplace_back(Vector3d::Unit(axis));
  return out;
}

// Takes up a mounting that explains the log as well.
void take_rival(const DvlFigures& rival, double turn_rad, DvlFound& found) {
  for (int axis = 0; axis < 3; ++axis) {
    // What is across the way is the same in both.
    if (std::abs(found.way_D[axis]) > 0.5)
      found.turn_apart_rad[axis] =
          std::max(found.turn_apart_rad[axis], std::abs(turn_rad * found.way_D[axis]));
  }
  found.lever_apart_m = found.lever_apart_m.cwiseMax((rival.lever_B_m - found.fit.lever_B_m).cwiseAbs());
  found.latency_apart_s = std::max(found.latency_apart_s, std::abs(rival.latency_s - found.fit.latency_s));
}

}  // namespace

DvlFound find_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading, double latency_s) {
  DvlFound out;
  const std::vector<Span> windows = windows_of(series, series.dvl, kFirst_s, 6, kMost);
  const DvlFit linear = windows.size() >= 3 ? fit_dvl_linear(series, windows, reading, latency_s) : DvlFit{};
  if (!linear.done) return out;
  out.way_D = way_of(series.dvl);
  const auto fit_from = [&](const Similarity& guess) {
    return fit_dvl(series, windows, reading, guess, assumed.dvl.lever_B_m, latency_s);
  };
  // Where the vehicle does not slip, all that is sideways is lever x rate: half a turn about the way with the
  // lever on the other side reads the same.
  Similarity guess = fit_similarity(linear, false);
  DvlFigures best = fit_from(guess);
  const auto take_better = [&](const DvlFigures& now) {
    if (now.done && (!best.done || now.residual_m_s < best.residual_m_s)) best = now;
  };
  guess.C = guess.C * turn_about(out.way_D, 2.0 * kQuarter_rad);
  take_better(fit_from(guess));
  guess.C = assumed.dvl.C_BD;
  const DvlFigures configured = fit_from(guess);
  take_better(configured);
  const DvlFigures other = fit_from(fit_similarity(linear, true));
  const double against = best.done && other.done ? ratio(other, best) : 0.0;
  out.mirrored = other.done && (!best.done || against < -kReject);
  out.mirror_told = std::abs(against) > kReject;
  out.fit = out.mirrored ? other : best;
  if (!out.fit.done) return out;
  if (!out.mirrored) {
    const bool kept = configured.done && configured.settled && ratio(configured, best) <= kReject &&
                      next_to(configured.similarity.C, assumed.dvl.C_BD);
    if (kept) out.fit = configured;
    for (const double turn_rad : {2.0 * kQuarter_rad, kQuarter_rad, -kQuarter_rad}) {
      guess = out.fit.similarity;
      guess.C = guess.C * turn_about(out.way_D, turn_rad);
      const DvlFigures rival =
          fit_dvl(series, windows, reading, guess, assumed.dvl.lever_B_m, latency_s, out.way_D);
      if (!rival.done || ratio(rival, best) > kReject) continue;
      take_rival(rival, turn_rad, out);
      using AboutTheWay = DvlFound::AboutTheWay;
      out.about_the_way =
          std::abs(turn_rad) > kQuarter_rad ? AboutTheWay::but_for_half_a_turn : AboutTheWay::untold;
    }
  }
  out.fit = fit_best(series, assumed, reading, out.fit);
  return out;
}

Vector3d turn_sigma_rad(const DvlFound& found) {
  const Vector3d& sigma = found.fit.similarity.turn_sigma_rad;
  return (sigma.array().square() + found.turn_apart_rad.array().square()).sqrt();
}

std::optional<Matrix3d> mounting_found(const DvlFound& found, const Matrix3d& configured_C_BD) {
  const Matrix3d& C_BD = found.fit.similarity.C;
  const Matrix3d near = as_configured_about(untold_turns(found), C_BD, configured_C_BD);
  if (next_to(near, configured_C_BD)) return near;
  if ((kBoxSigmas * turn_sigma_rad(found).array() < 0.5 * kQuarter_rad).all()) return C_BD;
  return std::nullopt;
}

}  // namespace fathom::commission
