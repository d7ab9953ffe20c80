#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace fathom {

/// A value whose bytes are all there is to it: no destructor, no virtual functions. Pointers inside it are
/// the owner's to put right after a read. (Fixed-size matrices copy themselves member by member, so that the
/// language does not call them trivially copyable.)
template <class T>
concept Flat = std::is_trivially_destructible_v<T> && !std::is_polymorphic_v<T> && !std::is_pointer_v<T> &&
               !std::is_reference_v<T>;

/// Values as bytes, one behind the other, as this build holds them in memory: for the same build to read.
class ImageWriter {
 public:
  /// Appends to `out`, which keeps its capacity from one image to the next.
  explicit ImageWriter(std::vector<std::byte>& out) : out_(&out) {}

  template <Flat T>
  void put(const T& value) {
    const auto* begin = reinterpret_cast<const std::byte*>(&value);
    out_->insert(out_->end(), begin, begin + sizeof(T));
  }

 private:
  std::vector<std::byte>* out_;
};

/// The way back. Whoever reads has made sure that there are enough bytes.
class ImageReader {
 public:
  explicit ImageReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <Flat T>
  void get(T& value) {
    std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
  }
  void skip(std::size_t count) { bytes_ = bytes_.subspan(count); }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace fathom
