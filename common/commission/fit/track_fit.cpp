#include "commission/fit/track_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/median.hpp"
#include "commission/fit/latency.hpp"
#include "commission/fit/window_fit.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTrackGap_s = 0.5;  // of the track
constexpr double kHalf_s = 0.1;      // to both sides of an instant, for what changes there
constexpr double kPiece_s = 30.0;    // of a window
constexpr double kFar = 4.0;         // sigmas: readings further off count nowhere
constexpr int kIterations = 4;

struct TrackRow {
  double residual = 0.0;
  VectorXd by;
};

/// The rows of a series in windows; `row_of(t, value)` gives nothing where the track has none.
template <class RowOf>
std::optional<WindowFit::Solution> solve(const ScalarSeries& series, int common, bool own_offset,
                                         const RowOf& row_of) {
  std::vector<std::pair<double, TrackRow>> rows;
  for (std::size_t i = 0; i < series.size(); ++i)
    if (auto row = row_of(series.t_s[i], series.v[i])) rows.emplace_back(series.t_s[i], std::move(*row));
  if (rows.size() < 100) return std::nullopt;
  const auto next_window = [&](std::size_t from) {
    std::size_t to = from;
    while (to < rows.size() && rows[to].first < rows[from].first + kPiece_s) ++to;
    return to;
  };
  // What is left over in the middle, an offset of the window taken out where it has one of its own.
  std::vector<double> off(rows.size());
  std::vector<double> sizes;
  for (std::size_t from = 0; from < rows.size();) {
    const std::size_t to = next_window(from);
    std::vector<double> some;
    for (std::size_t i = from; i < to; ++i) some.push_back(rows[i].second.residual);
    const double middle = own_offset ? median(some) : 0.0;
    for (std::size_t i = from; i < to; ++i) {
      off[i] = std::abs(rows[i].second.residual - middle);
      sizes.push_back(off[i]);
    }
    from = to;
  }
  const double limit = kFar * std::max(1e-6, median(sizes) / 0.6745);
  WindowFit fit(common);
  std::size_t windows = 0;
  for (std::size_t from = 0; from < rows.size();) {
    const std::size_t to = next_window(from);
    std::vector<std::size_t> good;
    for (std::size_t i = from; i < to; ++i)
      if (off[i] < limit) good.push_back(i);
    from = to;
    if (good.size() < 8) continue;
    const auto n = static_cast<Eigen::Index>(good.size());
    MatrixXd J(n, common);
    VectorXd r(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      J.row(k) = rows[good[static_cast<std::size_t>(k)]].second.by.transpose();
      r[k] = rows[good[static_cast<std::size_t>(k)]].second.residual;
    }
    fit.add(J, own_offset ? MatrixXd(MatrixXd::Ones(n, 1)) : MatrixXd(MatrixXd::Zero(n, 1)), r);
    ++windows;
  }
  if (windows < 6) return std::nullopt;
  const WindowFit::Solution solution = fit.solve();
  if (!solution.step.allFinite()) return std::nullopt;
  return solution;
}

double sigma_of(const WindowFit::Solution& solution, int i) {
  return kModelMargin * std::sqrt(std::max(0.0, solution.covariance(i, i)));
}

}  // namespace

std::optional<CompassFit> fit_compass(const ScalarSeries& heading, const VectorSeries& rpy_rad,
                                      double latency_s) {
  constexpr int kCommon = 6;
  std::array<double, kCommon> x{0.0, 0.0, 0.0, 0.0, 0.0, latency_s};
  // Near enough to begin with that no difference wraps.
  std::vector<double> first;
  for (std::size_t i = 0; i < heading.size(); ++i)
    if (const auto rpy = at(rpy_rad, heading.t_s[i] - latency_s, kTrackGap_s))
      first.push_back(geo::wrap_pi(heading.v[i] - rpy->z()));
  if (first.size() < 100) return std::nullopt;
  double sine = 0.0;
  double cosine = 0.0;
  for (const double one : first) {
    sine += std::sin(one);
    cosine += std::cos(one);
  }
  x[0] = std::atan2(sine, cosine);
  CompassFit out;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const auto solution =
        solve(heading, kCommon, false, [&](double t, double value) -> std::optional<TrackRow> {
          const double when = t - x[5];
          const auto rpy = at(rpy_rad, when, kTrackGap_s);
          const auto before = at(rpy_rad, when - kHalf_s, kTrackGap_s);
          const auto behind = at(rpy_rad, when + kHalf_s, kTrackGap_s);
          if (!rpy || !before || !behind) return std::nullopt;
          const double yaw = rpy->z();
          VectorXd by(kCommon);
          by << 1.0, std::sin(yaw), std::cos(yaw), std::sin(2.0 * yaw), std::cos(2.0 * yaw),
              -(behind->z() - before->z()) / (2.0 * kHalf_s);
          double expected = yaw;
          for (int i = 0; i < 5; ++i) expected += x[static_cast<std::size_t>(i)] * by[i];
          TrackRow row;
          row.residual = geo::wrap_pi(value - expected);
          row.by = -by;
          return row;
        });
    if (!solution) return std::nullopt;
    for (int i = 0; i < kCommon; ++i) x[static_cast<std::size_t>(i)] += solution->step[i];
    for (int i = 0; i < 5; ++i)
      out.deviation_rad[static_cast<std::size_t>(i)] = {x[static_cast<std::size_t>(i)],
                                                        sigma_of(*solution, i)};
    out.latency_s = {x[5], std::max(kLeastLatency_s, sigma_of(*solution, 5))};
  }
  return out;
}

std::optional<DepthFit> fit_depth(const ScalarSeries& depth, const ScalarSeries& sunk_m, double scale,
                                  double latency_s) {
  DepthFit out;
  out.scale.value = scale;
  out.latency_s.value = latency_s;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const auto solution = solve(depth, 2, true, [&](double t, double value) -> std::optional<TrackRow> {
      const double when = t - out.latency_s.value;
      const auto sunk = at(sunk_m, when, kTrackGap_s);
      const auto before = at(sunk_m, when - kHalf_s, kTrackGap_s);
      const auto behind = at(sunk_m, when + kHalf_s, kTrackGap_s);
      if (!sunk || !before || !behind) return std::nullopt;
      TrackRow row;
      row.residual = value - out.scale.value * *sunk;
      row.by = VectorXd(2);
      row.by << -*sunk, out.scale.value * (*behind - *before) / (2.0 * kHalf_s);
      return row;
    });
    if (!solution) return std::nullopt;
    out.scale = {out.scale.value + solution->step[0], sigma_of(*solution, 0)};
    out.latency_s = {out.latency_s.value + solution->step[1],
                     std::max(kLeastLatency_s, sigma_of(*solution, 1))};
  }
  return out;
}

}  // namespace fathom::commission
