#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.hpp"
#include "record/bytes.hpp"

namespace fathom::record {

enum class Compression : std::uint8_t { none, lz4, zstd };

/// As it stands in a file: "", "lz4" or "zstd".
[[nodiscard]] std::string_view to_string(Compression compression);

/// Packs chunks. It keeps its working memory from one to the next.
class Compressor {
 public:
  explicit Compressor(Compression kind);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  [[nodiscard]] Compression kind() const { return kind_; }
  /// Replaces the content of `out`.
  void pack(View bytes, Bytes& out);

 private:
  struct Context;
  Compression kind_;
  std::unique_ptr<Context> context_;
};

/// Unpacks bytes that must give exactly `size` bytes. The caller has held `size` against its limit of memory.
[[nodiscard]] Result<Bytes> unpack(std::string_view compression, View bytes, std::size_t size);

}  // namespace fathom::record
