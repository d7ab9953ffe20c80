#include "estimation/alignment/velocity_track.hpp"

#include <algorithm>

namespace fathom::estimation {
namespace {

constexpr double kSpacing_s = 0.5;
/// Sums of intervals are not exact.
constexpr double kRounding_s = 1e-3;
/// Increments over a longer time have no velocity that holds them.
constexpr double kLongestUnmeasured_s = 3.0;

}  // namespace

bool VelocityTrack::add(const std::optional<NewVelocity>& measured, TimeNs now_ns, double dt_s,
                        const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2) {
  // (ALN-24)
  double rest_s = dt_s;
  bool marked = false;
  if (measured) {
    const double after_s = std::clamp(to_seconds(now_ns - measured->stamp_ns), 0.0, dt_s);
    const double since_s = now_.duration_s + dt_s - after_s;
    if (count_ > 0 && since_s > kLongestUnmeasured_s) count_ = 0;
    if (count_ == 0 || since_s >= kSpacing_s - kRounding_s) {
      if (count_ > 0) now_.add(dt_s - after_s, rate_B_rad_s, force_B_m_s2);
      mark(*measured, rate_B_rad_s);
      rest_s = after_s;
      marked = true;
    }
  }
  if (count_ > 0) now_.add(rest_s, rate_B_rad_s, force_B_m_s2);
  return marked;
}

void VelocityTrack::mark(const NewVelocity& measured, const Eigen::Vector3d& rate_B_rad_s) {
  if (count_ == 0) now_ = InertialSpan();
  if (count_ == kMarks) {
    std::copy(marks_.begin() + 1, marks_.end(), marks_.begin());
    --count_;
  }
  marks_[count_++] = {measured.v_N_m_s, measured.sigma_m_s, rate_B_rad_s, now_};
  now_ = InertialSpan();
}

}  // namespace fathom::estimation
