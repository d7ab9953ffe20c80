#include "logs/series.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "base/unknown.hpp"

namespace fathom::logs {
namespace {

constexpr std::int64_t kHour_us = 3'600'000'000;

bool apart(std::int64_t a_us, std::int64_t b_us) {
  return std::abs(a_us - b_us) > kHour_us;
}

}  // namespace

std::optional<std::size_t> Series::find(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::optional<std::size_t> Series::find_any(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    if (const auto found = find(name)) return found;
  }
  return std::nullopt;
}

double Series::at(std::size_t row, const std::optional<std::size_t>& column) const {
  return column ? at(row, *column) : kUnknown;
}

std::optional<std::array<std::size_t, 3>> Series::find_three(const std::array<std::string, 3>& names) const {
  std::array<std::size_t, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = find(names[i]);
    if (!column) return std::nullopt;
    out[i] = *column;
  }
  return out;
}

std::optional<std::array<std::size_t, 3>> Series::find_vector(const std::string& name) const {
  return find_three({name + "[0]", name + "[1]", name + "[2]"});
}

void Losses::add(std::optional<std::uint64_t> offset, std::uint64_t length, std::string what) {
  ++count;
  bytes += length;
  if (listed.size() < kMostListed) listed.push_back({offset, length, std::move(what)});
}

std::vector<const Series*> Log::of(std::string_view topic) const {
  std::vector<const Series*> out;
  for (const Series& one : series) {
    if (one.topic == topic && one.rows() > 0) out.push_back(&one);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Series* a, const Series* b) { return a->instance < b->instance; });
  return out;
}

std::size_t drop_stray_times(Series& series) {
  const std::vector<std::int64_t>& t = series.t_us;
  const std::size_t width = series.columns.size();
  std::vector<bool> stray(t.size(), false);
  std::size_t count = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    // The neighbours that count are those not yet found to be stray; at an end there are two on one side.
    std::size_t before = i;
    while (before > 0 && stray[before - 1]) --before;
    const bool first = before == 0;
    const bool last = i + 1 == t.size();
    if (t.size() < 3 || (first && i + 2 >= t.size()) || (last && before < 2)) continue;
    const std::int64_t a = first ? t[i + 1] : t[before - 1];
    const std::int64_t b = first ? t[i + 2] : last ? t[before - 2] : t[i + 1];
    stray[i] = apart(t[i], a) && apart(t[i], b) && !apart(a, b);
    count += stray[i] ? 1U : 0U;
  }
  if (count == 0) return 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < stray.size(); ++i) {
    if (stray[i]) continue;
    series.t_us[kept] = series.t_us[i];
    std::copy_n(series.values.begin() + static_cast<std::ptrdiff_t>(i * width), width,
                series.values.begin() + static_cast<std::ptrdiff_t>(kept * width));
    ++kept;
  }
  series.t_us.resize(kept);
  series.values.resize(kept * width);
  return count;
}

}  // namespace fathom::logs
