#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "base/name.hpp"
#include "codec/air/air_report.hpp"
#include "codec/codec.hpp"
#include "samples/heading.hpp"

namespace fathom::codec {

/// A beacon that answers, and where it is.
struct BeaconPlace {
  Name address;
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double depth_m = 0.0;
};

/// What turns travel times into ranges to places, and relative fixes of beacons into places of the vehicle.
struct BeaconOptions {
  static constexpr std::size_t kMost = 16;
  std::array<BeaconPlace, kMost> list;
  std::size_t count = 0;
  double sound_speed_m_s = 1'500.0;

  /// The one of this address; null where nobody has said where it is.
  [[nodiscard]] const BeaconPlace* find(std::string_view address) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (list[i].address.view() == address) return &list[i];
    }
    return nullptr;
  }
};

/// Who carries the transceiver of an acoustic positioning system.
enum class UsblCarrier : std::uint8_t {
  station,  ///< a ship, buoy or quay: fixes are of the vehicle
  vehicle,  ///< fixes are of a beacon
};

struct UsblOptions {
  UsblCarrier carrier = UsblCarrier::station;
  double sigma_floor_m = 0.0;
};

/// What the datagrams of a STIM300 do not say of themselves.
struct Stim300Options {
  double accel_range_g = 10.0;  ///< 5, 10, 30 or 80: the accelerometers' type
  double increments_hz = 0.0;  ///< incremental angle and velocity at this rate; 0: angular rate, acceleration
};

/// How a KVH unit gives its temperature: in degrees or in hundredths of them.
enum class KvhTemperature : std::uint8_t { celsius, celsius_100, fahrenheit, fahrenheit_100 };

/// What the messages of a KVH unit do not say of themselves.
struct KvhOptions {
  double increments_hz = 0.0;  ///< delta angles at this rate; 0: rates of rotation
  bool degrees = false;        ///< of rotation, not radians
  KvhTemperature temperature = KvhTemperature::celsius;
};

/// What a codec needs to be told because the bytes do not say it. Each protocol reads the fields it knows.
struct CodecOptions {
  bool require_checksum = true;         ///< NMEA 0183, ASCII air data
  double latitude_rad = 0.0;            ///< pressure to depth
  double atmosphere_Pa = 101'325.0;     ///< pressure to depth
  double pressure_unit_Pa = 6'894.757;  ///< of one unit of a Paroscientific value (psi)
  bool value_is_depth = false;          ///< the value is metres of depth already
  /// ASCII depth or altitude line: text before the number, the number's factor to metres (or to pascal) and
  /// its offset.
  std::string_view ascii_prefix;
  double ascii_scale = 1.0;
  double ascii_offset = 0.0;
  /// Rotation of the recorded instrument axes about down onto the vehicle, for DVLs in instrument axes.
  double dvl_heading_alignment_rad = 0.0;
  /// Attitude sentences: the north of those that do not say it; unset: that of their makers.
  std::optional<North> untold_north{};
  /// Ping protocol: below it the range is unknown, 0 to 100.
  double least_confidence_percent = 50.0;
  int mavlink_system = 0;  ///< of the autopilot that counts; 0: of the first that is heard
  AirDataOptions air_data;
  BeaconOptions beacons;
  UsblOptions usbl;
  Stim300Options stim300;
  KvhOptions kvh;
};

/// What a protocol's frames say of time beside their arrival. It decides how a bridge stamps its samples
/// where nobody configures it.
enum class DeviceClock : std::uint8_t {
  none,     ///< nothing, or a time of day: by the arrival
  counter,  ///< a clock that nobody sets: its offset to the host is tracked
  utc,      ///< UTC that the device knows: taken as it is
};

/// What the samples of a protocol are, whatever device sends them.
struct Traits {
  /// An inertial unit whose own axes are not forward, right, down: the codec has turned them already.
  bool turns_axes = false;
  /// Its satellite fixes carry the receiver's UTC, whatever clock its other frames have.
  bool fixes_have_utc = false;
  /// Its frames say how old their samples are when they are sent, whatever the device waits for.
  bool tells_age = false;
  /// Its headings are those of two satellite antennas.
  bool heading_by_antennas = false;
};

/// One protocol that this build decodes.
struct Protocol {
  std::string_view name;                      ///< e.g. "pd0"
  std::span<const std::string_view> aliases;  ///< e.g. "teledyne_pd0"
  std::string_view description;
  std::unique_ptr<Codec> (*make)(const CodecOptions& options);
  DeviceClock clock;
  /// What has to be said to the device before it tells anything, by a client on connecting by TCP or on a
  /// serial line; empty for most.
  std::string_view greeting{};
  Traits traits{};
};

/// Every protocol, in the order of the documentation. README.md says what a new one takes.
[[nodiscard]] std::span<const Protocol> protocols();

/// By name or alias; case and '-' versus '_' do not matter. Null when there is none.
[[nodiscard]] const Protocol* find_protocol(std::string_view name);

}  // namespace fathom::codec
