#pragma once

namespace fathom::codec {

/// The standard atmosphere and what a pitot tube makes of it.
///
/// Atmosphere: ICAO Doc 7488/3, equal to the U.S. Standard Atmosphere 1976 up to 20 km: 288.15 K and
/// 101325 Pa at sea level, 6.5 K/km up to 11 km, 216.65 K above. Airspeeds: isentropic compressible flow of
/// air with a ratio of specific heats of 1.4, subsonic (Gracey, Measurement of Aircraft Speed and Altitude,
/// NASA RP-1046, 1980, chapters 2 and 3). Indicated means calibrated here: errors of the place are not known.

/// Pressure, Pa, and temperature, K, of the standard atmosphere at a pressure altitude, m, up to 20 km.
[[nodiscard]] double standard_pressure_Pa(double altitude_m);
[[nodiscard]] double standard_temperature_K(double altitude_m);

/// Altitude, m, at which the standard atmosphere has this pressure.
[[nodiscard]] double pressure_altitude_m(double static_Pa);

/// Indicated airspeed, m/s, of an impact pressure (total less static), Pa, and back. Odd: suction, as a tube
/// at rest shows around zero, is a negative speed.
[[nodiscard]] double indicated_airspeed_m_s(double impact_Pa);
[[nodiscard]] double impact_pressure_Pa(double indicated_m_s);

/// Mach number of an impact pressure in air of a static pressure; odd as well.
[[nodiscard]] double mach_number(double impact_Pa, double static_Pa);

/// Temperature of the air, K, where a stopped thermometer reads `total_K`.
[[nodiscard]] double static_temperature_K(double total_K, double mach);

/// Speed of sound, m/s, in air of this temperature.
[[nodiscard]] double speed_of_sound_m_s(double static_K);

/// Impact pressure, Pa, at a true airspeed in air of this pressure and temperature.
[[nodiscard]] double impact_pressure_at_Pa(double true_m_s, double static_Pa, double static_K);

}  // namespace fathom::codec
