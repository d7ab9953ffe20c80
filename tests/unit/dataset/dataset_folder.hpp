#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <zlib.h>

#include "support/temporary_folder.hpp"

namespace fathom::test {

/// A folder of data set files, plain and compressed.
class DatasetFolder : public TemporaryFolder {
 public:
  void file(const std::string& name, const std::string& content) const {
    std::ofstream(path() / name, std::ios::binary) << content;
  }
  void zipped(const std::string& name, const std::string& content) const {
    gzFile out = gzopen((path() / name).c_str(), "wb");
    gzwrite(out, content.data(), static_cast<unsigned>(content.size()));
    gzclose(out);
  }
  void cut(const std::string& name, std::uintmax_t bytes) const {
    std::filesystem::resize_file(path() / name, std::filesystem::file_size(path() / name) - bytes);
  }
};

}  // namespace fathom::test
