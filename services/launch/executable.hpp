#pragma once

#include <filesystem>
#include <string>

namespace fathom::launch {

/// Where the services lie: beside the program that asks.
[[nodiscard]] std::filesystem::path executables_folder();

/// The file name of a service's executable: "fathom-gps-bridge" of "gps_bridge".
[[nodiscard]] std::string executable_of(const std::string& service);

}  // namespace fathom::launch
