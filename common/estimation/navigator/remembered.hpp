#pragma once

#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

/// The instant of a measurement that is judged long after it, as the engine remembers it.
class Remembered {
 public:
  [[nodiscard]] virtual TimeNs instant_ns() const = 0;
  /// What the filter held then.
  [[nodiscard]] virtual const FilterState& state() const = 0;
  /// Puts the innovation of rows against that state right by all that has been measured since, and makes its
  /// statistics: `ph` is its covariance with the present error. False where that is not remembered.
  [[nodiscard]] virtual bool look_back(Observation& whole, InnovationStatistics& statistics) = 0;
  /// These rows act now.
  virtual void acts(const Observation& kept) = 0;

 protected:
  ~Remembered() = default;
};

}  // namespace fathom::estimation
