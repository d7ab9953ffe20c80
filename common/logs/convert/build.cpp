#include "logs/convert/build.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/median.hpp"
#include "base/units.hpp"

namespace fathom::logs {
namespace {

constexpr std::int64_t kStale_us = 10'000'000;
constexpr double kAlike = 1.2;

double median_step_us(const Series& series) {
  std::vector<double> steps;
  steps.reserve(series.rows());
  for (std::size_t i = 1; i < series.t_us.size(); ++i)
    steps.push_back(static_cast<double>(series.t_us[i] - series.t_us[i - 1]));
  return median(std::move(steps));
}

const Candidate& pick(const std::vector<Candidate>& candidates, bool finest) {
  if (!finest) return candidates.front();
  std::vector<double> steps;
  for (const Candidate& one : candidates) {
    const double step_us = median_step_us(*one.series);
    steps.push_back(known(step_us) ? step_us : 1e12);
  }
  const double best = *std::min_element(steps.begin(), steps.end());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (steps[i] <= best * kAlike) return candidates[i];
  }
  return candidates.front();
}

}  // namespace

SampleHeader Clock::header(std::int64_t valid_us, std::int64_t logged_us) const {
  const bool sound = valid_us > 0 && valid_us <= logged_us && logged_us - valid_us < kStale_us;
  SampleHeader header;
  header.stamp_ns = at(sound ? valid_us : logged_us);
  header.received_ns = at(logged_us);
  return header;
}

void make_best(const std::string& file, const std::vector<Candidate>& candidates, bool finest,
               const ConvertOptions& options, Vehicle& vehicle) {
  std::string have;
  for (const Candidate& one : candidates) have += (have.empty() ? "" : ", ") + one.label;
  const Candidate* chosen = nullptr;
  if (const auto asked = options.choice.find(file); asked != options.choice.end()) {
    for (const Candidate& one : candidates) {
      if (one.label == asked->second || one.label == asked->second + ":0") chosen = &one;
    }
    if (chosen == nullptr) {
      throw LogError(file + ": the log has no " + asked->second + ", expected " +
                     (have.empty() ? "none: it has nothing for this file" : "one of " + have));
    }
  } else if (!candidates.empty()) {
    chosen = &pick(candidates, finest);
  }
  if (chosen == nullptr) return;
  chosen->make();
  vehicle.sources[file] = chosen->label;
  for (const Candidate& one : candidates) {
    if (&one != chosen) vehicle.others[file].push_back(one.label);
  }
}

void settle(Table& table) {
  if (std::is_sorted(table.stamps_ns.begin(), table.stamps_ns.end())) return;
  std::vector<std::size_t> order(table.stamps_ns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return table.stamps_ns[a] < table.stamps_ns[b]; });
  Table sorted{table.name, table.columns, {}, {}};
  for (const std::size_t row : order) {
    sorted.stamps_ns.push_back(table.stamps_ns[row]);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      sorted.values.push_back(table.values[row * table.columns.size() + i]);
  }
  table = std::move(sorted);
}

std::int64_t Triad::time_us(std::size_t row) const {
  const double sample = series->at(row, sample_us) * microseconds_per_unit;
  const std::int64_t logged = series->t_us[row];
  const bool sound = sample > 0.0 && sample <= static_cast<double>(logged) &&
                     static_cast<double>(logged) - sample < static_cast<double>(kStale_us);
  return sound ? static_cast<std::int64_t>(sample) : logged;
}

std::vector<ImuSample> joined(const Triad& gyro, const Triad& accel, const Clock& clock) {
  constexpr std::int64_t kLongestGap_us = 200'000;
  std::vector<ImuSample> out;
  std::size_t next = 0;
  for (std::size_t row = 0; row < gyro.series->rows(); ++row) {
    const std::int64_t t_us = gyro.time_us(row);
    ImuSample& sample = out.emplace_back();
    sample.header = clock.header(t_us, gyro.series->t_us[row]);
    for (std::size_t i = 0; i < 3; ++i) sample.angular_rate_B_rad_s[i] = gyro.series->at(row, gyro.xyz[i]);
    while (next < accel.series->rows() && accel.time_us(next) < t_us) ++next;
    if (next >= accel.series->rows()) continue;
    const std::int64_t after_us = accel.time_us(next);
    if (after_us == t_us) {
      for (std::size_t i = 0; i < 3; ++i)
        sample.specific_force_B_m_s2[i] = accel.series->at(next, accel.xyz[i]);
      continue;
    }
    if (next == 0) continue;
    const std::int64_t before_us = accel.time_us(next - 1);
    if (after_us - before_us > kLongestGap_us || after_us <= before_us) continue;
    const double part = static_cast<double>(t_us - before_us) / static_cast<double>(after_us - before_us);
    for (std::size_t i = 0; i < 3; ++i) {
      sample.specific_force_B_m_s2[i] = (1.0 - part) * accel.series->at(next - 1, accel.xyz[i]) +
                                        part * accel.series->at(next, accel.xyz[i]);
    }
  }
  return out;
}

double standard_altitude_m(double pressure_Pa) {
  if (!(pressure_Pa > 0.0)) return kUnknown;
  // International Standard Atmosphere below 11 km: 288.15 K, 6.5 K/km.
  return 288.15 / 0.0065 *
         (1.0 - std::pow(pressure_Pa / 101325.0, 287.05287 * 0.0065 / kStandardGravity_m_s2));
}

void attach_baro(const Table& baro, std::size_t altitude_column, std::vector<AirspeedSample>& airspeed,
                 double longest_s) {
  const auto altitude_m = [&](std::size_t row) {
    return baro.values[row * baro.columns.size() + altitude_column];
  };
  const std::size_t rows = baro.stamps_ns.size();
  if (airspeed.empty()) {
    for (std::size_t row = 0; row < rows; ++row) {
      AirspeedSample& sample = airspeed.emplace_back();
      sample.header.stamp_ns = sample.header.received_ns = baro.stamps_ns[row];
      sample.baro_altitude_m = altitude_m(row);
    }
    return;
  }
  std::size_t next = 0;
  for (AirspeedSample& sample : airspeed) {
    const std::size_t first = next;
    while (next < rows && baro.stamps_ns[next] <= sample.header.stamp_ns) ++next;
    // A value is given away once: a repeated one would count as a measurement.
    if (next == first) continue;
    if (sample.header.stamp_ns - baro.stamps_ns[next - 1] > from_seconds(longest_s)) continue;
    sample.baro_altitude_m = altitude_m(next - 1);
  }
}

}  // namespace fathom::logs
