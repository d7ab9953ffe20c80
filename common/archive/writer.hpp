#pragma once

#include <bit>
#include <span>
#include <vector>

#include "archive/visitor.hpp"

namespace fathom::archive {

/// Values as bytes one behind the other: little-endian, of fixed width, doubles as their bits.
class Writer : public Visitor<Writer> {
 public:
  static constexpr bool kReads = false;

  /// Appends to `out`, which keeps its capacity from one use to the next.
  Writer(std::vector<std::byte>& out, std::uint32_t version) : out_(&out), version_(version) {}

  [[nodiscard]] std::uint32_t version() const { return version_; }
  /// Fields that came with a version stand in `if (archive.since(2))`.
  [[nodiscard]] bool since(std::uint32_t version) const { return version_ >= version; }

  void flag(const char* /*name*/, bool value) { put(static_cast<std::uint8_t>(value)); }
  template <class T>
  void whole(const char* /*name*/, T value, Whole /*limit*/ = {}) {
    put(static_cast<std::make_unsigned_t<T>>(value));
  }
  void number(const char* /*name*/, double value, Range /*limit*/) {
    put(std::bit_cast<std::uint64_t>(value));
  }
  template <class T>
  void choice(const char* /*name*/, T value, T /*last*/) {
    static_assert(sizeof(T) == 1);
    put(static_cast<std::uint8_t>(value));
  }
  void name(const char* /*name*/, const Name& value) {
    put(static_cast<std::uint8_t>(value.view().size()));
    const auto bytes = std::as_bytes(std::span(value.view()));
    out_->insert(out_->end(), bytes.begin(), bytes.end());
  }
  template <class... T>
  void alternative(const std::variant<T...>& value) {
    put(static_cast<std::uint8_t>(value.index()));
    std::visit([this](const auto& one) { this->visit_fields(one); }, value);
  }
  void open(const char* /*name*/, std::size_t /*index*/) {}
  void close() {}
  /// What is not part of the state: made from the configuration, or another's.
  template <class T>
  void left_out(const T& /*value*/) {}

 private:
  template <class T>
  void put(T value) {
    const std::size_t at = out_->size();
    out_->resize(at + sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i)
      (*out_)[at + i] = static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU);
  }

  std::vector<std::byte>* out_;
  std::uint32_t version_;
};

}  // namespace fathom::archive
