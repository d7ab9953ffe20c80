#pragma once

#include "estimation/hydro/coefficients.hpp"
#include "sim/random.hpp"

namespace fathom::study::hydro {

using estimation::hydro::HydroCoefficients;

/// REMUS 100, the values of deploy/config/hydro/remus100.json.
[[nodiscard]] HydroCoefficients remus100();
/// The air-dropped vehicle, the values of deploy/config/hydro/air_drop.json.
[[nodiscard]] HydroCoefficients air_dropped();

/// Every hydrodynamic coefficient times a factor of its own, uniform within 1 +- `share`; what is weighed and
/// measured ashore stays. Drawn again until the outcome is a vehicle.
[[nodiscard]] HydroCoefficients perturbed(const HydroCoefficients& nominal, double share,
                                          sim::Random& random);

}  // namespace fathom::study::hydro
