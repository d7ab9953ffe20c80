#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/time.hpp"
#include "dataset/dataset.hpp"
#include "logs/convert/vehicle.hpp"
#include "logs/series.hpp"
#include "samples/kinds.hpp"

/// What the conversions of all logs share.
namespace fathom::logs {

/// Stamps of samples: `zero_ns` is the autopilot's start.
struct Clock {
  TimeNs zero_ns = dataset::kDefaultEpochNs;
  [[nodiscard]] TimeNs at(std::int64_t t_us) const { return zero_ns + t_us * 1000; }
  /// Valid at `valid_us`, logged at `logged_us`. A validity that is 0, later than the log or 10 s older is
  /// none.
  [[nodiscard]] SampleHeader header(std::int64_t valid_us, std::int64_t logged_us) const;
};

/// Microseconds of a log as a whole number; 0, which is no time, for what cannot be one.
[[nodiscard]] inline std::int64_t whole_us(double t_us) {
  return t_us > 0.0 && t_us < 9e15 ? static_cast<std::int64_t>(t_us) : 0;
}

/// One way to make a file of the data set.
struct Candidate {
  std::string label;               ///< "vehicle_imu:0"
  const Series* series = nullptr;  ///< whose rows come out
  std::function<void()> make;
};

/// Picks one and makes it: that which was chosen; else with `finest` that of the highest rate (of those that
/// differ by less than a fifth the first); else the first. Notes it in the vehicle.
void make_best(const std::string& file, const std::vector<Candidate>& candidates, bool finest,
               const ConvertOptions& options, Vehicle& vehicle);

/// Sorts by arrival and numbers; a note where that moved something.
template <class Sample>
void settle(std::vector<Sample>& samples, const std::string& file, Vehicle& vehicle) {
  const auto earlier = [](const Sample& a, const Sample& b) {
    return a.header.received_ns < b.header.received_ns;
  };
  if (!std::is_sorted(samples.begin(), samples.end(), earlier)) {
    std::stable_sort(samples.begin(), samples.end(), earlier);
    vehicle.notes.push_back(file +
                            ": the rows of the log were not in the order of time and have been sorted");
  }
  std::uint64_t sequence = 0;
  for (Sample& sample : samples) sample.header.sequence = sequence++;
}
void settle(Table& table);

/// Rows of `gyro` with the specific force of `accel`, interpolated to their instants. Times are columns of
/// microseconds, or where nullopt those of the log.
struct Triad {
  const Series* series = nullptr;
  std::array<std::size_t, 3> xyz{};
  std::optional<std::size_t> sample_us;
  double microseconds_per_unit = 1.0;  ///< of sample_us
  [[nodiscard]] std::int64_t time_us(std::size_t row) const;
};
[[nodiscard]] std::vector<ImuSample> joined(const Triad& gyro, const Triad& accel, const Clock& clock);

/// Height of the standard atmosphere over that of 101325 Pa, m.
[[nodiscard]] double standard_altitude_m(double pressure_Pa);

/// Gives each barometric altitude to the first row of `airspeed` at or behind it, within `longest_s`. With no
/// rows there, each makes one of its own.
void attach_baro(const Table& baro, std::size_t altitude_column, std::vector<AirspeedSample>& airspeed,
                 double longest_s = 1.0);

}  // namespace fathom::logs
