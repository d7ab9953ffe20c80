#pragma once

#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/median.hpp"
#include "base/unknown.hpp"

namespace fathom::cli {

/// One figure beside its floor from the same rounds. `ratio` is the median of the rounds' own ratios, which a
/// busy machine disturbs less than the ratio of two medians.
struct BenchRow {
  std::string name;
  std::string unit;
  double value = kUnknown;
  double floor = kUnknown;
  double ratio = kUnknown;
};

/// Microseconds that `work` takes.
template <class Work>
double time_us(const Work& work) {
  const SystemClock clock;
  const TimeNs begin_ns = clock.monotonic_ns();
  work();
  return 1e-3 * static_cast<double>(clock.monotonic_ns() - begin_ns);
}

/// Own work and floor in turn, each `repeats` times a round. `prepare` comes before each round, untimed.
template <class Prepare, class Own, class Floor>
BenchRow compare(const std::string& name, int rounds, int repeats, const Prepare& prepare, const Own& own,
                 const Floor& floor) {
  std::vector<double> values;
  std::vector<double> floors;
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    prepare();
    const auto batch = [repeats](const auto& work) {
      return time_us([&] {
               for (int i = 0; i < repeats; ++i) work();
             }) /
             repeats;
    };
    values.push_back(batch(own));
    floors.push_back(batch(floor));
    ratios.push_back(values.back() / floors.back());
  }
  return {name, "us", median(values), median(floors), median(ratios)};
}

}  // namespace fathom::cli
