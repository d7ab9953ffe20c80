#pragma once

#include <nlohmann/json.hpp>

#include "estimation/hydro/coefficients.hpp"

namespace fathom::test {

/// The vehicle that the numerical vectors were made with, under their own names ("d" for an acceleration,
/// fins at the end).
inline estimation::hydro::HydroCoefficients vehicle_of_vectors(const nlohmann::json& params) {
  using estimation::hydro::coefficient_table;
  estimation::hydro::HydroCoefficients out;
  out.propulsor_rpm = 1500.0;
  for (const auto& entry : coefficient_table()) {
    std::string name = entry.name;
    if (name == "weight") name = "W";
    if (name == "buoyancy") name = "B";
    if (name == "gravity") name = "g";
    std::erase(name, '_');
    if (const auto dot = name.find("dot"); dot != std::string::npos) name.erase(dot + 1);
    if (params.contains(name)) out.*entry.member = params.at(name).get<double>();
  }
  // Published under one name only, the symmetric partner of Y_pdot.
  out.Y_pdot = params.at("Yp").get<double>();
  return out;
}

}  // namespace fathom::test
