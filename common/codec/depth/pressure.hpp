#pragma once

namespace fathom::codec {

/// Depth of sea water of 0 degC and 35 practical salinity below the surface, metres, positive down, from the
/// pressure above that of the atmosphere. Fofonoff and Millard, Algorithms for computation of fundamental
/// properties of seawater, UNESCO Technical Papers in Marine Science 44, 1983: 9712.653 m at 10000 dbar and
/// 30 degrees. The sign of the latitude does not matter. Above the surface the value is negative.
[[nodiscard]] double depth_from_pressure(double gauge_Pa, double latitude_rad);

/// Its inverse, to better than a micrometre of depth down to 12 km.
[[nodiscard]] double pressure_from_depth(double depth_m, double latitude_rad);

}  // namespace fathom::codec
