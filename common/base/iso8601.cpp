#include "base/iso8601.hpp"

#include <cstdio>

namespace fathom {

std::optional<TimeNs> from_iso8601(const std::string& text) {
  CivilTime civil;
  double seconds = 0.0;
  int end = 0;
  const int read = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf%n", &civil.year, &civil.month,
                               &civil.day, &civil.hour, &civil.minute, &seconds, &end);
  if (read != 6 || text.substr(static_cast<std::size_t>(end)) != "Z" || !(seconds >= 0.0 && seconds < 61.0))
    return std::nullopt;
  civil.second = static_cast<int>(seconds);
  civil.nanosecond = from_seconds(seconds - civil.second);
  return from_civil(civil);
}

}  // namespace fathom
