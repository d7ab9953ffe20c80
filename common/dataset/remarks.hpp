#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/dataset.hpp"

namespace fathom::dataset {

/// What a person should know of a data set that was read, a sentence each, most harmful first: files whose
/// ends were lost, times that are no seconds, streams that have no time in common with the inertial samples,
/// sigmas of zero, and tables in the folder that are no file of a data set. Nothing of it is a fault of a
/// single row.
[[nodiscard]] std::vector<std::string> remarks(const std::filesystem::path& directory, const Dataset& data,
                                               const ReadOptions& options = {});

}  // namespace fathom::dataset
