#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace fathom::logs {

/// A file to be read from any place, of which one window lies in memory.
class FileWindow {
 public:
  /// Throws LogError where the file cannot be read.
  explicit FileWindow(const std::filesystem::path& path);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// The bytes from `offset` on, `length` of them or what the file has. Valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> at(std::uint64_t offset, std::size_t length);

 private:
  std::string name_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;
  std::vector<std::uint8_t> window_;
};

}  // namespace fathom::logs
