#pragma once

#include <map>
#include <string>

#include "config/json/error.hpp"
#include "config/registry.hpp"
#include "estimation/hydro/coefficients.hpp"

namespace fathom::config {

/// One coefficient with its unit, which is checked, and where it comes from, which is for people.
struct HydroEntry {
  double value = 0.0;
  std::string unit;
  std::string source;
  double sigma = 0.0;  ///< of the value, for people; 0: not told
};

/// deploy/config/hydro/*.json: a vehicle's coefficients. What is not listed is zero.
struct HydroFile {
  std::string vehicle;
  std::string source;
  std::map<std::string, HydroEntry> coefficients;
};

/// The coefficients of a file, validated: known names, the units of coefficient_table(), and a vehicle that
/// can be (HydroCoefficients::validate()). Throws ConfigError.
[[nodiscard]] estimation::hydro::HydroCoefficients load_hydro_coefficients(const std::string& file);

[[nodiscard]] ConfigKind hydro_kind();

}  // namespace fathom::config
