#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace fathom::sim {

/// Random numbers that repeat with every compiler and machine: xoshiro256** (Blackman and Vigna), seeded by
/// splitmix64. The distributions of the standard library may differ between implementations and are not used.
class Random {
 public:
  /// Generators of the same seed and different `stream` are independent: adding a sensor to a scenario leaves
  /// the noise of the others as it was.
  Random(std::uint64_t seed, std::string_view stream);

  [[nodiscard]] std::uint64_t next();
  /// In [0, 1).
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double low, double high);
  /// Zero mean, standard deviation one (Marsaglia's polar method).
  [[nodiscard]] double normal();
  [[nodiscard]] double normal(double sigma) { return sigma * normal(); }
  /// True with this probability. Draws a number in any case, so that later draws do not depend on it.
  [[nodiscard]] bool chance(double probability) { return uniform() < probability; }

 private:
  std::array<std::uint64_t, 4> state_{};
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// First-order Gauss-Markov process, stationary from the start. tau_s <= 0 makes it a constant drawn once.
class GaussMarkov {
 public:
  GaussMarkov() = default;
  GaussMarkov(double sigma, double tau_s, Random& random);
  /// Value `dt_s` later. Precondition: dt_s >= 0.
  double advance(double dt_s, Random& random);
  [[nodiscard]] double value() const { return value_; }

 private:
  double sigma_ = 0.0;
  double tau_s_ = 0.0;
  double value_ = 0.0;
};

}  // namespace fathom::sim
