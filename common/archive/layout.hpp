#pragma once

#include <string_view>

#include "archive/visitor.hpp"

namespace fathom::archive {

/// A number made of the names and kinds of all fields, in their order: bytes of another layout are told from
/// those of this one, also where somebody forgot to count the version up.
class Layout : public Visitor<Layout> {
 public:
  static constexpr bool kReads = false;

  explicit Layout(std::uint32_t version) : version_(version) {}

  [[nodiscard]] std::uint64_t fingerprint() const { return hash_; }
  [[nodiscard]] std::uint32_t version() const { return version_; }
  [[nodiscard]] bool since(std::uint32_t version) const { return version_ >= version; }

  /// Of several that are alike one: how many there are is a matter of size.
  template <class T, class... Limit>
  void element(const char* name, std::size_t index, T& value, const Limit&... limit) {
    if (index == 0) Visitor<Layout>::element(name, index, value, limit...);
  }
  void flag(const char* name, bool /*value*/) { note(name, 'b'); }
  template <class T>
  void whole(const char* name, T /*value*/, Whole /*limit*/ = {}) {
    note(name, static_cast<char>('0' + sizeof(T)));
  }
  void number(const char* name, double /*value*/, Range /*limit*/) { note(name, 'd'); }
  template <class T>
  void choice(const char* name, T /*value*/, T /*last*/) {
    note(name, 'e');  // a further choice does not move anything
  }
  void name(const char* name, const Name& /*value*/) { note(name, 'n'); }
  template <class... T>
  void alternative(const std::variant<T...>& /*value*/) {
    (one_of<T>(), ...);
  }
  void open(const char* name, std::size_t index) { note(name, index == kAlone ? '{' : '['); }
  void close() { note("", '}'); }
  template <class T>
  void left_out(const T& /*value*/) {}

 private:
  template <class T>
  void one_of() {
    if (!since(kSince<T>)) return;
    const T value{};
    note("", '|');
    this->visit_fields(value);
  }
  // FNV-1a.
  void note(std::string_view name, char kind) {
    for (const char c : name) add(c);
    add(kind);
  }
  void add(char c) { hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001B3U; }

  std::uint32_t version_;
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

}  // namespace fathom::archive
