#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/init/recognizer.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::cli {

/// A port that was listened to, and what was heard.
struct Heard {
  runtime::ByteSourceConfig port;
  std::uint64_t bytes = 0;
  std::optional<Recognition> recognition;
  std::string trouble;  ///< why it is not open, at the end; empty: it is
};

/// An instrument as far as its bytes tell, and what a person has to say of it.
struct Proposal {
  nlohmann::ordered_json
      instrument;                  ///< element of "instruments"; position and mounting are a guess, or zero
  std::string what;                ///< for people: "gps on serial /dev/ttyUSB1, nmea0183, 5.0 Hz"
  std::vector<std::string> notes;  ///< what was guessed, and what cannot be told
  bool has_place = false;          ///< "position_m" means something
  bool has_mounting = false;       ///< "mounting_rpy_deg" means something
};

/// The instruments behind each port that was recognised. Where bridges of several kinds read one, it is
/// shared; of an autopilot's telemetry one bridge's are taken. Names are those of the kinds, numbered where
/// there are several.
[[nodiscard]] std::vector<Proposal> propose(const std::vector<Heard>& heard);

/// The rate that an instrument was set to, of the one that was counted: a round number where it is within 3
/// %, or within one and a half samples of so many, because they do not arrive evenly.
[[nodiscard]] double tidy_rate_hz(double rate_hz, std::uint64_t samples);

/// Which way round an inertial unit is, roll and pitch in steps of 90 degrees, when the vehicle is level and
/// at rest. Yaw cannot be told and is 0. Nothing where no axis is up.
[[nodiscard]] std::optional<std::array<double, 3>> upright_rpy_deg(const std::array<double, 3>& mean_force_S);

/// The unit of a pressure in air, of the depth that it gives when it is read as psi: the one in which it is
/// an atmosphere. Nothing where none fits.
[[nodiscard]] std::optional<std::string> unit_in_air(double depth_as_psi_m);

}  // namespace fathom::cli
