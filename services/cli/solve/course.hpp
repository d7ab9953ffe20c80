#pragma once

#include <cstddef>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "config/fusion/fusion_config.hpp"
#include "samples/gps.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/truth.hpp"

namespace fathom::cli {

/// Errors of the heading, each beside the sigma that it was told with.
class HeadingErrors {
 public:
  /// `sigma_rad` of the heading alone, `whole_sigma_rad` with what it is compared with.
  void add(double error_rad, double sigma_rad, double whole_sigma_rad);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double mean_rad() const;
  [[nodiscard]] double rms_rad() const;
  /// Largest error in sigmas, and how many lie beyond three: of the heading alone and of both.
  [[nodiscard]] double worst_own() const { return worst_own_; }
  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] std::size_t beyond_own() const { return beyond_own_; }
  [[nodiscard]] std::size_t beyond() const { return beyond_; }

 private:
  std::size_t count_ = 0;
  std::size_t beyond_own_ = 0;
  std::size_t beyond_ = 0;
  double sum_rad_ = 0.0;
  double sum2_rad2_ = 0.0;
  double worst_own_ = kUnknown;
  double worst_ = kUnknown;
};

/// When the heading was found, and how far it is from what says where the vehicle points (SOLVE-1).
struct HeadingFigures {
  double aligned_after_s = kUnknown;  ///< since the first position; unknown where it never was
  HeadingErrors course;               ///< from the course made good, while moving straight
  HeadingErrors course_aligned;       ///< of these, while aligned
  bool through_medium = false;        ///< the wind or current that the filter found was taken off first
  HeadingErrors reference;            ///< from the heading of the reference, every state
};

/// Compares the heading of a state with that of the reference.
void add_heading(const NavState& state, const Truth& reference, HeadingErrors& out);

/// Sees each navigation state, in the order of time, and compares its heading.
class HeadingWatch {
 public:
  /// `gps` are the fixes of the recording, in the order of their stamps.
  HeadingWatch(const config::FusionConfig& config, const std::vector<GpsSample>& gps);

  /// A fix that this state has just passed is to be compared: `add` needs the detail.
  [[nodiscard]] bool wants_detail(const NavState& state) const;
  void add(const NavState& state, const NavDetail& detail);
  [[nodiscard]] const HeadingFigures& figures() const { return figures_; }

 private:
  struct Course {
    TimeNs stamp_ns = 0;
    double north_m_s = 0.0;
    double east_m_s = 0.0;
    double sigma_m_s = 0.0;
  };
  void compare(const NavState& state, const NavDetail& detail, const Course& course);

  std::vector<Course> straight_;
  std::size_t next_ = 0;
  double latency_s_ = 0.0;
  double gust_rad_ = 0.0;  ///< sideslip beyond its state
  bool found_position_ = false;
  TimeNs first_position_ns_ = 0;
  HeadingFigures figures_;
};

}  // namespace fathom::cli
