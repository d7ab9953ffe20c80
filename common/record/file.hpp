#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "record/bytes.hpp"

namespace fathom::record {

/// Where a file is written to. Every append is whole or leaves nothing behind.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Appends all bytes. Returns why it failed, or nothing. After a failure what was appended before still
  /// stands, and another append may succeed.
  [[nodiscard]] virtual std::string append(View bytes) = 0;
  /// What was appended survives a loss of power when this returns nothing. Else why not.
  [[nodiscard]] virtual std::string sync() = 0;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Somebody has removed it: what is appended goes on working, and nobody will find it.
  [[nodiscard]] virtual bool is_removed() const { return false; }
  /// What `path` names is this file: no other one, no disk mounted over it.
  [[nodiscard]] virtual bool is_at(const std::filesystem::path& /*path*/) const { return true; }
};

/// What a file is read from.
class Source {
 public:
  virtual ~Source() = default;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills all of `into`. Returns why it failed, or nothing. Precondition: the bytes lie inside size().
  [[nodiscard]] virtual std::string read(std::uint64_t offset, std::span<std::uint8_t> into) = 0;
};

/// A file of its own name, which must not be there yet, or one that is continued at its end.
class FileSink final : public Sink {
 public:
  [[nodiscard]] static Result<std::unique_ptr<FileSink>> create(const std::filesystem::path& path);
  /// Cuts the file to `size` bytes and goes on behind them. An error while another process writes it.
  [[nodiscard]] static Result<std::unique_ptr<FileSink>> go_on(const std::filesystem::path& path,
                                                               std::uint64_t size);
  ~FileSink() override;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  [[nodiscard]] std::string append(View bytes) override;
  [[nodiscard]] std::string sync() override;
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] bool is_removed() const override;
  [[nodiscard]] bool is_at(const std::filesystem::path& path) const override;

 private:
  FileSink(int descriptor, std::uint64_t size) : descriptor_(descriptor), size_(size) {}

  int descriptor_;
  std::uint64_t size_;
  bool torn_ = false;  ///< bytes of a failed append are behind `size_`
};

class FileSource final : public Source {
 public:
  [[nodiscard]] static Result<std::unique_ptr<FileSource>> open(const std::filesystem::path& path);
  ~FileSource() override;
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] std::string read(std::uint64_t offset, std::span<std::uint8_t> into) override;

 private:
  FileSource(int descriptor, std::uint64_t size) : descriptor_(descriptor), size_(size) {}

  int descriptor_;
  std::uint64_t size_;
};

class MemorySink final : public Sink {
 public:
  /// `bytes` outlives this.
  explicit MemorySink(Bytes& bytes) : bytes_(bytes) {}
  [[nodiscard]] std::string append(View bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return {};
  }
  [[nodiscard]] std::string sync() override { return {}; }
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }

 private:
  Bytes& bytes_;
};

class MemorySource final : public Source {
 public:
  /// The bytes outlive this.
  explicit MemorySource(View bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] std::string read(std::uint64_t offset, std::span<std::uint8_t> into) override;

 private:
  View bytes_;
};

}  // namespace fathom::record
