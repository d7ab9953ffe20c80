#include "config/vehicle/folder.hpp"

#include <filesystem>

#include "config/json/layers.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::config {
namespace {

namespace fs = std::filesystem;

/// What cannot be looked at is there: reading it says why it cannot be read.
bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::symlink_status(file, error).type() != fs::file_type::not_found;
}

}  // namespace

LoadRequest from_folder(LoadRequest request, const std::string& folder, std::string_view service) {
  const fs::path vehicle = fs::path(folder) / "vehicle.json";
  const fs::path own = fs::path(folder) / (std::string(service) + ".json");
  const bool of_vehicle = is_there(vehicle);
  if (is_there(own)) request.file = own.string();
  if (!of_vehicle && request.file.empty())
    throw ConfigError(folder, "has neither vehicle.json nor " + own.filename().string() +
                                  ", expected one of them: the vehicle's file or the service's own");
  return of_vehicle ? with_vehicle(std::move(request), vehicle.string(), service) : request;
}

std::string files_of(const LoadRequest& request) {
  if (!request.base) return request.file;
  return request.base->file() + (request.file.empty() ? "" : ", over it " + request.file);
}

}  // namespace fathom::config
