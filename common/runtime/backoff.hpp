#pragma once

#include <algorithm>

namespace fathom::runtime {

/// Waiting times between attempts: doubled from `first_s` up to `most_s`, for ever.
class Backoff {
 public:
  Backoff(double first_s, double most_s) : first_s_(first_s), most_s_(most_s), next_s_(first_s) {}

  [[nodiscard]] double next_s() {
    const double wait_s = next_s_;
    next_s_ = std::min(most_s_, next_s_ * 2.0);
    return wait_s;
  }
  void reset() { next_s_ = first_s_; }

 private:
  double first_s_;
  double most_s_;
  double next_s_;
};

}  // namespace fathom::runtime
