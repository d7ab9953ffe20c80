#include "base/time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace fathom {
namespace {

constexpr std::int64_t kSecondsPerDay = 86'400;

// Proleptic Gregorian day number, days since 1970-01-01; years start in March so that the leap day ends a
// year.
constexpr std::int64_t days_from_civil(std::int64_t year, int month, int day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const std::int64_t day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146'097 + day_of_era - 719'468;
}

constexpr int days_in_month(int year, int month) {
  constexpr std::array<int, 12> kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return month == 2 && leap ? 29 : kDays[static_cast<std::size_t>(month - 1)];
}

}  // namespace

DurationNs from_seconds(double seconds) {
  if (std::isnan(seconds)) return 0;
  constexpr double kLimit = 9.2e9;
  if (seconds >= kLimit) return std::numeric_limits<DurationNs>::max();
  if (seconds <= -kLimit) return std::numeric_limits<DurationNs>::min();
  return std::llround(seconds * 1e9);
}

std::optional<TimeNs> from_civil(const CivilTime& civil) {
  if (civil.year < 1970 || civil.year > 2261 || civil.month < 1 || civil.month > 12) return std::nullopt;
  if (civil.day < 1 || civil.day > days_in_month(civil.year, civil.month)) return std::nullopt;
  if (civil.hour < 0 || civil.hour > 23 || civil.minute < 0 || civil.minute > 59) return std::nullopt;
  if (civil.second < 0 || civil.second > 60) return std::nullopt;
  if (civil.nanosecond <= -kNsPerSecond || civil.nanosecond >= kNsPerSecond) return std::nullopt;
  const int second_of_day = civil.hour * 3600 + civil.minute * 60 + civil.second;
  const std::int64_t seconds =
      days_from_civil(civil.year, civil.month, civil.day) * kSecondsPerDay + second_of_day;
  return seconds * kNsPerSecond + civil.nanosecond;
}

CivilTime to_civil(TimeNs utc) {
  std::int64_t seconds = utc / kNsPerSecond;
  std::int64_t nanosecond = utc % kNsPerSecond;
  if (nanosecond < 0) {
    nanosecond += kNsPerSecond;
    --seconds;
  }
  std::int64_t days = seconds / kSecondsPerDay;
  std::int64_t second_of_day = seconds % kSecondsPerDay;
  if (second_of_day < 0) {
    second_of_day += kSecondsPerDay;
    --days;
  }
  const std::int64_t z = days + 719'468;
  const std::int64_t era = (z >= 0 ? z : z - 146'096) / 146'097;
  const std::int64_t day_of_era = z - era * 146'097;
  const std::int64_t year_of_era =
      (day_of_era - day_of_era / 1460 + day_of_era / 36'524 - day_of_era / 146'096) / 365;
  const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t shifted_month = (5 * day_of_year + 2) / 153;
  CivilTime civil;
  civil.day = static_cast<int>(day_of_year - (153 * shifted_month + 2) / 5 + 1);
  civil.month = static_cast<int>(shifted_month < 10 ? shifted_month + 3 : shifted_month - 9);
  civil.year = static_cast<int>(year_of_era + era * 400 + (civil.month <= 2 ? 1 : 0));
  civil.hour = static_cast<int>(second_of_day / 3600);
  civil.minute = static_cast<int>(second_of_day % 3600 / 60);
  civil.second = static_cast<int>(second_of_day % 60);
  civil.nanosecond = nanosecond;
  return civil;
}

std::string to_iso8601(TimeNs utc, int decimals) {
  const CivilTime civil = to_civil(utc);
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02d", civil.year,
                                   civil.month, civil.day, civil.hour, civil.minute, civil.second);
  std::string out(text.data(), static_cast<std::size_t>(length));
  if (decimals > 0) {
    (void)std::snprintf(text.data(), text.size(), ".%09lld", static_cast<long long>(civil.nanosecond));
    out.append(text.data(), 1 + static_cast<std::size_t>(std::min(decimals, 9)));
  }
  return out + "Z";
}

}  // namespace fathom
