#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include <Eigen/Core>

#include "base/name.hpp"
#include "base/time.hpp"

/// State that leaves the process. Every struct names its fields once, in a function template
///
///   template <class Archive, class Self> static void fields(Archive& archive, Self& self) {
///     archive("speed_m_s", self.speed_m_s_, within(0.0, 100.0));
///     archive("phase", self.phase_, Phase::last);
///   }
///
/// (or in a free function `fields(archive, self)` beside a struct of another room). The same function writes
/// (writer.hpp), reads and checks (reader.hpp), and describes what is written (layout.hpp).
namespace fathom::archive {

/// The version since which a state can hold a T as one of several alternatives. What was written before then
/// knows nothing of it, and stays readable.
template <class T>
inline constexpr std::uint32_t kSince = 1;

/// What a number may be. Everything that is read is held against it; a writer does not look.
struct Range {
  double least = 0.0;
  double most = 0.0;
  bool or_unknown = false;  ///< NaN as well
  bool any = false;         ///< whatever bits: judged where it is used, as if it had just been measured
};
[[nodiscard]] constexpr Range within(double least, double most) {
  return {least, most, false, false};
}
[[nodiscard]] constexpr Range finite() {
  return within(std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max());
}
[[nodiscard]] constexpr Range at_least_zero() {
  return within(0.0, std::numeric_limits<double>::max());
}
[[nodiscard]] constexpr Range or_unknown(Range range) {
  range.or_unknown = true;
  return range;
}
[[nodiscard]] constexpr Range any_number() {
  return {0.0, 0.0, true, true};
}

/// What an integer may be.
struct Whole {
  std::int64_t least = 0;
  std::int64_t most = 0;
};
/// Of things that are counted one by one: adding to it for years does not overflow an int.
inline constexpr Whole kCount{0, 1'000'000'000};
/// Instants of the years 1824 to 2116: two of them can be subtracted.
inline constexpr Whole kInstant{-(std::int64_t{1} << 62), std::int64_t{1} << 62};
inline constexpr Whole kAnyWhole{std::numeric_limits<std::int64_t>::min(),
                                 std::numeric_limits<std::int64_t>::max()};

template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;
template <class T>
inline constexpr bool is_variant = false;
template <class... T>
inline constexpr bool is_variant<std::variant<T...>> = true;

/// Takes a value apart into flags, whole numbers, numbers, choices and names, which the archive itself
/// treats. Elements of arrays and matrices get the limit of the whole.
template <class Derived>
class Visitor {
 public:
  template <class T, class... Limit>
  void operator()(const char* name, T& value, const Limit&... limit) {
    using V = std::remove_const_t<T>;
    if constexpr (std::is_same_v<V, bool>) {
      self().flag(name, value);
    } else if constexpr (std::is_enum_v<V>) {
      self().choice(name, value, limit...);
    } else if constexpr (std::is_integral_v<V>) {
      self().whole(name, value, limit...);
    } else if constexpr (std::is_floating_point_v<V>) {
      self().number(name, value, limit...);
    } else if constexpr (std::is_same_v<V, Name>) {
      self().name(name, value);
    } else if constexpr (is_array<V>) {
      for (std::size_t i = 0; i < value.size(); ++i) self().element(name, i, value[i], limit...);
    } else if constexpr (is_variant<V>) {
      self().open(name, kAlone);
      self().alternative(value);
      self().close();
    } else if constexpr (std::is_base_of_v<Eigen::DenseBase<V>, V>) {
      for (Eigen::Index i = 0; i < value.size(); ++i)
        self().element(name, static_cast<std::size_t>(i), value.data()[i], limit...);
    } else {
      self().open(name, kAlone);
      visit_fields(value);
      self().close();
    }
  }
  /// One of several that have a name together.
  template <class T, class... Limit>
  void element(const char* name, std::size_t index, T& value, const Limit&... limit) {
    self().open(name, index);
    (*this)("", value, limit...);
    self().close();
  }

 protected:
  static constexpr std::size_t kAlone = std::numeric_limits<std::size_t>::max();
  template <class T>
  void visit_fields(T& value) {
    if constexpr (requires { std::remove_const_t<T>::fields(self(), value); }) {
      std::remove_const_t<T>::fields(self(), value);
    } else {
      fields(self(), value);
    }
  }

 private:
  [[nodiscard]] Derived& self() { return static_cast<Derived&>(*this); }
};

}  // namespace fathom::archive
