#pragma once

#include <bit>
#include <span>
#include <string>
#include <string_view>

#include "archive/visitor.hpp"

namespace fathom::archive {

/// The way back from a Writer's bytes, which may be anybody's: each value is held against what it may be
/// before it is taken. The first that is not ends the reading: nothing is read behind it, and complaint()
/// names the field, what it is and what was expected. What was read until then is not to be used.
class Reader : public Visitor<Reader> {
 public:
  static constexpr bool kReads = true;

  explicit Reader(std::span<const std::byte> bytes, std::uint32_t version = 1)
      : bytes_(bytes), version_(version) {}

  [[nodiscard]] bool good() const { return complaint_.empty(); }
  /// E.g. "core.sensors[3].count is -5, 0 to 1000000000 was expected".
  [[nodiscard]] const std::string& complaint() const { return complaint_; }
  [[nodiscard]] std::span<const std::byte> rest() const { return bytes_; }
  void set_version(std::uint32_t version) { version_ = version; }
  [[nodiscard]] std::uint32_t version() const { return version_; }
  [[nodiscard]] bool since(std::uint32_t version) const { return version_ >= version; }

  /// A condition between values that have been read one by one.
  void expect(bool holds, const char* name, std::string_view expected) {
    if (!holds && good()) refuse(name, "", expected);
  }
  /// Bytes behind the last value are somebody else's.
  void expect_end();

  void flag(const char* name, bool& value);
  template <class T>
  void whole(const char* name, T& value, Whole limit) {
    const auto found = static_cast<T>(take<std::make_unsigned_t<T>>(name));
    if (!good()) return;
    if constexpr (std::is_same_v<T, std::uint64_t>) {
      value = found;  // any count
    } else {
      if (outside(name, static_cast<std::int64_t>(found), limit)) return;
      value = found;
    }
  }
  /// A count or sequence number.
  void whole(const char* name, std::uint64_t& value) { whole(name, value, kAnyWhole); }
  void number(const char* name, double& value, Range limit);
  template <class T>
  void choice(const char* name, T& value, T last) {
    const auto found = take<std::uint8_t>(name);
    if (!good() || outside(name, found, {0, static_cast<std::int64_t>(last)})) return;
    value = static_cast<T>(found);
  }
  void name(const char* name, Name& value);
  template <class... T>
  void alternative(std::variant<T...>& value) {
    const auto found = take<std::uint8_t>("kind");
    if (!good() || outside("kind", found, {0, static_cast<std::int64_t>(sizeof...(T)) - 1})) return;
    emplace(value, found, std::index_sequence_for<T...>());
    std::visit([this](auto& one) { this->visit_fields(one); }, value);
  }
  void open(const char* name, std::size_t index) {
    if (depth_ < path_.size()) path_[depth_] = {name, index};
    ++depth_;
  }
  void close() { --depth_; }
  template <class T>
  void left_out(const T& /*value*/) {}

 private:
  struct Level {
    const char* name = "";
    std::size_t index = 0;
  };

  template <class... T, std::size_t... I>
  static void emplace(std::variant<T...>& value, std::size_t index, std::index_sequence<I...> /*all*/) {
    (void)((I == index && (value.template emplace<I>(), true)) || ...);
  }
  /// The next number; 0, with a complaint, when there is none.
  template <class T>
  T take(const char* name) {
    if (!good()) return 0;
    if (bytes_.size() < sizeof(T)) {
      refuse(name, "cut off", "more bytes");
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::to_integer<std::uint64_t>(bytes_[i]) << (8 * i);
    bytes_ = bytes_.subspan(sizeof(T));
    return static_cast<T>(value);
  }
  [[nodiscard]] bool outside(const char* name, std::int64_t value, Whole limit);
  void refuse(const char* name, std::string_view found, std::string_view expected);

  std::span<const std::byte> bytes_;
  std::uint32_t version_;
  std::string complaint_;
  std::array<Level, 16> path_{};
  std::size_t depth_ = 0;
};

}  // namespace fathom::archive
