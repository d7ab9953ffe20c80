#pragma once

#include <cstdint>
#include <string>

#include "base/clock.hpp"

namespace fathom::cli {

/// A progress bar on standard error when that is a terminal; silent otherwise. Redraws at most ten times a
/// second, however often it is told.
class Progress {
 public:
  /// `total` in any unit; nothing is drawn when it is 0.
  Progress(std::string label, std::uint64_t total);
  /// Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint64_t done);

 private:
  std::string label_;
  std::uint64_t total_;
  bool terminal_;
  bool drawn_ = false;
  SystemClock clock_;
  TimeNs started_ns_;
  TimeNs last_draw_ns_;
};

}  // namespace fathom::cli
