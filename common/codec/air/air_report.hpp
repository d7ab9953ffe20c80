#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/name.hpp"
#include "base/unknown.hpp"
#include "codec/codec.hpp"
#include "samples/airspeed.hpp"

namespace fathom::codec {

/// What an air-data instrument can tell.
enum class AirQuantity : std::uint8_t {
  indicated_airspeed = 0,
  true_airspeed = 1,
  impact_pressure = 2,  ///< total less static; the differential pressure of a pitot tube
  total_pressure = 3,
  static_pressure = 4,
  pressure_altitude = 5,
  static_temperature = 6,  ///< of the air itself
  total_temperature = 7,   ///< of air that a probe has stopped
  ignored = 8,             ///< a column that means nothing here
};
inline constexpr std::size_t kAirQuantities = 8;

enum class AirUnit : std::uint8_t {
  m_s,
  km_h,
  kn,
  mph,
  Pa,
  hPa,
  kPa,
  bar,
  psi,
  inHg,
  mmHg,
  m,
  ft,
  degC,
  degF,
  K,
  none
};

/// Whether the unit measures such a quantity.
[[nodiscard]] bool fits(AirQuantity quantity, AirUnit unit);

/// The value in m/s, Pa, m or K.
[[nodiscard]] double to_si(double value, AirUnit unit);
/// Its inverse.
[[nodiscard]] double from_si(double value, AirUnit unit);

/// Which airspeed a sample has to have.
enum class AirspeedWanted : std::uint8_t {
  true_airspeed,  ///< sent, or computed from the air's pressure and temperature; else the report is
                  ///< incomplete
  indicated,      ///< an indicated one will do; the estimator then takes the standard atmosphere's density
};

struct AirColumn {
  AirQuantity quantity = AirQuantity::ignored;
  AirUnit unit = AirUnit::none;
};

/// What the air-data codecs have to be told.
struct AirDataOptions {
  static constexpr std::size_t kMaxColumns = 16;

  AirspeedWanted wanted = AirspeedWanted::true_airspeed;
  Name prefix;            ///< ASCII line: text before the first column
  char separator = ',';   ///< ASCII line: between columns; a blank stands for any number of blanks
  std::size_t count = 3;  ///< ASCII line: columns
  std::array<AirColumn, kMaxColumns> columns{AirColumn{AirQuantity::indicated_airspeed, AirUnit::kn},
                                             AirColumn{AirQuantity::pressure_altitude, AirUnit::ft},
                                             AirColumn{AirQuantity::static_temperature, AirUnit::degC}};
  /// NMEA XDR: the transducer's name of each quantity, by AirQuantity.
  std::array<Name, kAirQuantities> transducer{"IAS", "TAS", "QC", "PT", "PS", "ALT", "OAT", "TAT"};
};

/// The quantities of one report in m/s, Pa, m and K; unknown where it says nothing.
class AirReport {
 public:
  AirReport() { value_.fill(kUnknown); }

  /// `out_of_range` for what no air holds.
  [[nodiscard]] std::optional<RejectReason> set(AirQuantity quantity, double si);
  [[nodiscard]] double operator[](AirQuantity quantity) const {
    return value_[static_cast<std::size_t>(quantity)];
  }
  [[nodiscard]] bool has(AirQuantity quantity) const { return known((*this)[quantity]); }
  /// Something that tells of speed.
  [[nodiscard]] bool has_speed() const;

 private:
  friend class AirMemory;
  std::array<double, kAirQuantities> value_{};
};

/// Indicated and true airspeed and the height by the barometer. `incomplete` where the wanted airspeed cannot
/// be had for want of static pressure or temperature, `out_of_range` at Mach 1 and beyond.
[[nodiscard]] std::optional<RejectReason> resolve(const AirReport& report, AirspeedWanted wanted,
                                                  AirspeedSample& sample);

/// Whether a report of these quantities can give the wanted airspeed.
[[nodiscard]] bool suffices(const AirReport& report, AirspeedWanted wanted);

/// Completes reports of speed with the pressure and temperature heard before, which instruments send in
/// sentences of their own and less often. Where several quantities tell of speed it follows the best one:
/// true airspeed, impact pressure, total pressure, indicated airspeed. What was not heard during kPatience
/// reports of speed is forgotten.
class AirMemory {
 public:
  static constexpr int kPatience = 50;

  /// Whether `report` is to give a sample; it is completed then.
  [[nodiscard]] bool complete(AirReport& report);

 private:
  AirReport last_;
  std::array<int, kAirQuantities> age_{};  ///< of last_, in reports of speed
  int followed_ = 0;                       ///< how good the quantity is that is followed; 0: none yet
  int unheard_ = 0;                        ///< reports of speed since it was heard
};

}  // namespace fathom::codec
