#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <zlib.h>

namespace fathom::test {

/// A new folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fathom-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  void file(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
  }
  void zipped(const std::string& name, const std::string& content) const {
    gzFile out = gzopen((path_ / name).c_str(), "wb");
    gzwrite(out, content.data(), static_cast<unsigned>(content.size()));
    gzclose(out);
  }
  void cut(const std::string& name, std::uintmax_t bytes) const {
    std::filesystem::resize_file(path_ / name, std::filesystem::file_size(path_ / name) - bytes);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace fathom::test
