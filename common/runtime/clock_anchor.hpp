#pragma once

#include <string>

#include "base/clock.hpp"

namespace fathom::runtime {

/// The distance of UTC from the monotonic clock, shared through a file by the services of one host: while one
/// of them lives, each that starts joins it, so that all agree on UTC even when the host's clock was set in
/// between. Held by advisory locks (flock): a file that nobody holds, of an earlier boot say, is written
/// anew.
class ClockAnchor {
 public:
  /// `file` empty, or not usable (see trouble()): UTC as `host` has it now, shared with nobody.
  ClockAnchor(const std::string& file, const Clock& host);
  ~ClockAnchor();
  ClockAnchor(const ClockAnchor&) = delete;
  ClockAnchor& operator=(const ClockAnchor&) = delete;
  ClockAnchor(ClockAnchor&&) = delete;
  ClockAnchor& operator=(ClockAnchor&&) = delete;

  [[nodiscard]] DurationNs utc_minus_monotonic_ns() const { return offset_ns_; }
  /// Why the file is not used; empty when it is, or none was asked for.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void join(const std::string& file);

  int descriptor_ = -1;
  DurationNs offset_ns_;
  std::string trouble_;
};

}  // namespace fathom::runtime
