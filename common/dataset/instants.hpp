#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "samples/nav_state.hpp"

namespace fathom::dataset {

/// An instant that somebody wants the solution at.
struct Instant {
  TimeNs stamp_ns = 0;
  std::size_t line = 0;  ///< of the file, from 1
};

/// Reads a file with one instant a line, in seconds of the data set, each at or behind the one before. A
/// first line that is no number is a header. Blank lines are passed over. Throws DatasetError with file and
/// line.
[[nodiscard]] std::vector<Instant> read_instants(const std::filesystem::path& path, TimeNs epoch_ns);

/// The state between two that enclose `stamp_ns`, of which the earlier is `a`. Position and velocity go
/// straight, the attitude takes the shortest turn. Covariances and sigmas of angles are those of the nearer
/// one: nothing is made up between them. Modes, outages and counters are those of the earlier one, outages
/// grown by the time since.
[[nodiscard]] NavState between(const NavState& a, const NavState& b, TimeNs stamp_ns);

/// Takes navigation states in the order of time and gives one state for each instant.
class AtInstants {
 public:
  /// States further apart than `longest_gap_s` are not interpolated between.
  explicit AtInstants(std::vector<Instant> instants, double longest_gap_s = 1.0);

  /// Calls `consumer` with each instant's state that `state` makes known.
  template <class Consumer>
  void add(const NavState& state, Consumer&& consumer) {
    while (next_ < instants_.size() && last_ && last_->header.stamp_ns <= instants_[next_].stamp_ns &&
           instants_[next_].stamp_ns <= state.header.stamp_ns) {
      const Instant& at = instants_[next_++];
      if (state.header.stamp_ns - last_->header.stamp_ns > longest_gap_ns_ &&
          at.stamp_ns != last_->header.stamp_ns && at.stamp_ns != state.header.stamp_ns) {
        refused_.push_back(at);
      } else {
        consumer(between(*last_, state, at.stamp_ns));
      }
    }
    if (!last_)
      for (; next_ < instants_.size() && instants_[next_].stamp_ns < state.header.stamp_ns; ++next_)
        refused_.push_back(instants_[next_]);
    if (!last_) first_ns_ = state.header.stamp_ns;
    last_ = state;
  }
  /// Those that no two states enclosed, in their order; after the last state.
  [[nodiscard]] std::vector<Instant> refused() const;
  /// Of the states, where there were any.
  [[nodiscard]] std::optional<TimeNs> first_ns() const { return first_ns_; }
  [[nodiscard]] std::optional<TimeNs> last_ns() const;

 private:
  std::vector<Instant> instants_;
  std::vector<Instant> refused_;
  std::size_t next_ = 0;
  DurationNs longest_gap_ns_;
  std::optional<TimeNs> first_ns_;
  std::optional<NavState> last_;
};

}  // namespace fathom::dataset
