#include "base/nearest.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fathom {
namespace {

constexpr std::size_t kLongest = 200;  // what is longer was not mistyped

// Optimal string alignment: each letter changed, left out, added, or swapped with its neighbour counts one.
std::size_t steps_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({change, last[j] + 1, now[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> nearest(std::string_view given, std::span<const std::string> words) {
  if (given.empty() || given.size() > kLongest) return std::nullopt;
  std::optional<std::string> best;
  std::size_t fewest = 0;
  for (const std::string& word : words) {
    if (word.size() > kLongest) continue;
    const std::size_t steps = steps_between(given, word);
    const std::size_t most = std::max<std::size_t>(1, std::max(given.size(), word.size()) / 3);
    if (steps > most || (best && steps >= fewest)) continue;
    best = word;
    fewest = steps;
  }
  return best;
}

}  // namespace fathom
