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

std::vector<std::string_view> parts_of(std::string_view word) {
  std::vector<std::string_view> out;
  while (!word.empty()) {
    const std::size_t end = std::min(word.find_first_of("_-. "), word.size());
    if (end > 0) out.push_back(word.substr(0, end));
    word.remove_prefix(std::min(end + 1, word.size()));
  }
  return out;
}

// The only word that has every part of `given` among its own; none where there are several.
std::optional<std::string> only_fuller(std::string_view given, std::span<const std::string> words) {
  constexpr std::size_t kFewest = 3;  // letters: "m" alone says nothing
  const std::vector<std::string_view> asked = parts_of(given);
  if (given.size() < kFewest || asked.empty()) return std::nullopt;
  std::optional<std::string> found;
  for (const std::string& word : words) {
    if (word.size() > kLongest) continue;
    const std::vector<std::string_view> own = parts_of(word);
    const bool all = std::all_of(asked.begin(), asked.end(), [&](std::string_view part) {
      return std::find(own.begin(), own.end(), part) != own.end();
    });
    if (!all) continue;
    if (found) return std::nullopt;
    found = word;
  }
  return found;
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
  if (!best || fewest > 1) {
    if (auto fuller = only_fuller(given, words)) return fuller;
  }
  return best;
}

}  // namespace fathom
