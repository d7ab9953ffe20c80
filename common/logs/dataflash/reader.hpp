#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "logs/series.hpp"

/// ArduPilot's DataFlash logs (.bin), after what they say of themselves.
namespace fathom::logs::dataflash {

inline constexpr const char* kFormatName = "ArduPilot DataFlash";

/// True where an FMT message stands among the first bytes.
[[nodiscard]] bool looks_like(const std::filesystem::path& path);

/// Reads a whole file. `wanted` names the messages that are kept. IMU2, IMU3, ... of early logs are instances
/// 1, 2 of IMU. Numbers are multiplied out to the unit of the log; times are never: TimeUS stays in
/// microseconds. Damage is passed over to the next message that another one follows. Throws LogError.
[[nodiscard]] Log read(const std::filesystem::path& path, const std::set<std::string>& wanted);

}  // namespace fathom::logs::dataflash
