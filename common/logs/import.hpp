#pragma once

#include <filesystem>
#include <string>

#include "logs/convert/vehicle.hpp"
#include "logs/series.hpp"

namespace fathom::logs {

/// Tells by its first bytes which log it is, and reads it. Throws LogError.
[[nodiscard]] Log read(const std::filesystem::path& path);

/// With the conversion for the log's format. Throws LogError.
[[nodiscard]] Vehicle convert(const Log& log, const ConvertOptions& options = {});

struct WriteOptions {
  bool gzip = false;  ///< of the data set's own files
};

/// The data set in `directory`; beside it the tables (mag.csv, baro.csv), in `sources/` every message of the
/// wanted topics with the names and values of the log, the autopilot's parameters and what it said, and
/// import.json about all of it. What an earlier import left there is removed. Throws dataset::DatasetError.
void write(const std::filesystem::path& directory, const std::string& source, const Log& log,
           const Vehicle& vehicle, const WriteOptions& options = {});

/// import.json.
[[nodiscard]] std::string to_json(const std::string& source, const Log& log, const Vehicle& vehicle);

}  // namespace fathom::logs
