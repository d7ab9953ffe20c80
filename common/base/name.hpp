#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <string>
#include <string_view>

namespace fathom {

/// Short identifier (vehicle, sensor, service) held in place: copying one never allocates, so samples stay
/// trivially copyable on the hot path. Longer text is cut at 31 bytes; configuration refuses it earlier.
class Name {
 public:
  static constexpr std::size_t kCapacity = 31;

  constexpr Name() = default;
  constexpr Name(std::string_view text) {  // NOLINT(google-explicit-constructor): a name reads as its text
    size_ = static_cast<unsigned char>(std::min(text.size(), kCapacity));
    for (std::size_t i = 0; i < size_; ++i) data_[i] = text[i];
  }
  constexpr Name(const char* text) : Name(std::string_view(text)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] constexpr std::string_view view() const { return {data_.data(), size_}; }
  [[nodiscard]] constexpr const char* c_str() const { return data_.data(); }
  [[nodiscard]] std::string str() const { return std::string(view()); }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }

  friend constexpr bool operator==(const Name& a, const Name& b) { return a.view() == b.view(); }
  friend constexpr auto operator<=>(const Name& a, const Name& b) { return a.view() <=> b.view(); }

 private:
  std::array<char, kCapacity + 1> data_{};
  unsigned char size_ = 0;
};

}  // namespace fathom
