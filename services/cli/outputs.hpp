#pragma once

#include <string>
#include <vector>

namespace fathom::cli {

/// A path of the command line.
struct NamedPath {
  std::string name;       ///< what names it: "--out", "the input"
  std::string path;       ///< empty where nobody gave it
  bool data_set = false;  ///< the folder of one: all files that belong there are meant
};

/// Throws Failure where an output is the same file as an input or as another output, by whatever name or
/// link. Devices, pipes and the process' own streams take any number of outputs. Call it before anything is
/// written.
void refuse_same_files(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs);

}  // namespace fathom::cli
