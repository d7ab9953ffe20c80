#include <algorithm>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

/// It takes some measurements until noise is told from chance; meanwhile it looks like outliers.
constexpr DurationNs kFoundWithin_ns = 60 * kNsPerSecond;

}  // namespace

void watch_noise(const History& history, Findings& out) {
  for (const NoiseRow& row : history.noise()) {
    const auto at_that_time = [&](const Finding& one) {
      return one.kind == Kind::outliers && one.subject == row.sensor && one.begin_ns <= row.log_ns &&
             one.end_ns >= row.begin_ns - kFoundWithin_ns;
    };
    // With the noise it really has none lies outside any more; what goes on doing so is no noise.
    const auto goes_on = [&](const Finding& one) {
      return at_that_time(one) && one.end_ns > row.begin_ns + kFoundWithin_ns;
    };
    if (std::any_of(out.begin(), out.end(), goes_on)) continue;
    TimeNs begin_ns = row.begin_ns;
    for (const Finding& one : out)
      if (at_that_time(one))
        begin_ns = std::min(begin_ns, std::max(one.begin_ns, row.begin_ns - kFoundWithin_ns));
    std::erase_if(out, at_that_time);
    out.push_back({.kind = Kind::noisy,
                   .weight = Weight::caution,
                   .subject = row.sensor,
                   .begin_ns = begin_ns,
                   .end_ns = row.log_ns,
                   .figures = {{"factor", row.most}, {"for_s", to_seconds(row.log_ns - begin_ns)}},
                   .evidence = {{"fathom/v1/alignment", 0,
                                 std::string(kNoiseFactorPrefix) + row.sensor + ": factor of its sigmas"}}});
  }
}

}  // namespace fathom::explain
