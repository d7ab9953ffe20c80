#include "commission/fit/rest.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::commission {
namespace {

using Eigen::Vector3d;

constexpr double kBlock_s = 1.0;
constexpr double kStill_m_s = 0.3;        // above the noise of an ordinary receiver's velocity
constexpr double kSteady_of_mean = 0.02;  // of |f| between blocks: two per cent of g is a tilt of a degree
constexpr double kQuietTimes = 3.0;       // scatter inside a block against the quietest tenth

struct Block {
  double from_s, to_s;
  Vector3d rate, force;
  double rate_scatter, force_scatter;
};

bool moving(const VectorSeries& velocity, double from_s, double to_s) {
  auto i = static_cast<std::size_t>(std::lower_bound(velocity.t_s.begin(), velocity.t_s.end(), from_s) -
                                    velocity.t_s.begin());
  for (; i < velocity.size() && velocity.t_s[i] <= to_s; ++i)
    if (velocity.v[i].norm() > kStill_m_s) return true;
  return false;
}

// Whether anything says that the vehicle does not move.
bool speaks(const VectorSeries& velocity, double from_s, double to_s) {
  const auto i = std::lower_bound(velocity.t_s.begin(), velocity.t_s.end(), from_s - 1.0);
  return i != velocity.t_s.end() && *i <= to_s + 1.0;
}

std::vector<Block> blocks_of(const ImuSeries& imu) {
  std::vector<Block> out;
  std::size_t i = 0;
  while (i < imu.size()) {
    std::size_t end = i;
    Vector3d rate = Vector3d::Zero();
    Vector3d force = Vector3d::Zero();
    double rate2 = 0.0;
    double force2 = 0.0;
    while (end < imu.size() && imu.t_s[end] < imu.t_s[i] + kBlock_s) {
      rate += imu.rate[end];
      force += imu.force[end];
      rate2 += imu.rate[end].squaredNorm();
      force2 += imu.force[end].squaredNorm();
      ++end;
    }
    const auto n = static_cast<double>(end - i);
    rate /= n;
    force /= n;
    out.push_back({imu.t_s[i], imu.t_s[end - 1], rate, force,
                   std::sqrt(std::max(0.0, rate2 / n - rate.squaredNorm())),
                   std::sqrt(std::max(0.0, force2 / n - force.squaredNorm()))});
    i = end;
  }
  return out;
}

}  // namespace

std::vector<Span> rest_spans(const Series& series, double least_s) {
  const std::vector<Block> blocks = blocks_of(series.imu);
  std::vector<Span> spans;
  if (blocks.size() < 5) return spans;
  std::vector<double> rate_scatter;
  std::vector<double> force_scatter;
  for (const Block& block : blocks) {
    rate_scatter.push_back(block.rate_scatter);
    force_scatter.push_back(block.force_scatter);
  }
  const auto quiet = [](std::vector<double> scatter) {
    const auto tenth = scatter.begin() + static_cast<std::ptrdiff_t>(scatter.size() / 50);
    std::nth_element(scatter.begin(), tenth, scatter.end());
    return *tenth;
  };
  const double rate_limit = kQuietTimes * quiet(rate_scatter);
  const double force_limit = kQuietTimes * quiet(force_scatter);
  const bool has_velocity = series.gps_velocity.size() + series.dvl.size() > 0;
  std::size_t first = 0;
  bool open = false;
  const auto close = [&](std::size_t end) {
    if (open && blocks[end - 1].to_s - blocks[first].from_s >= least_s)
      spans.push_back({blocks[first].from_s, blocks[end - 1].to_s});
    open = false;
  };
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Block& block = blocks[i];
    const bool heard =
        speaks(series.gps_velocity, block.from_s, block.to_s) || speaks(series.dvl, block.from_s, block.to_s);
    bool still = has_velocity && heard && block.rate_scatter <= rate_limit &&
                 block.force_scatter <= force_limit &&
                 !moving(series.gps_velocity, block.from_s, block.to_s) &&
                 !moving(series.dvl, block.from_s, block.to_s);
    if (still && open) {
      const Block& begun = blocks[first];
      still = (block.force - begun.force).norm() < kSteady_of_mean * begun.force.norm() &&
              block.from_s - blocks[i - 1].to_s < 0.5;
    }
    if (!still) close(i);
    if (still && !open) {
      first = i;
      open = true;
    }
  }
  close(blocks.size());
  std::stable_sort(spans.begin(), spans.end(),
                   [](const Span& a, const Span& b) { return a.to_s - a.from_s > b.to_s - b.from_s; });
  return spans;
}

}  // namespace fathom::commission
