#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "unit/bus/sample_fields.hpp"

namespace fathom::test {

/// The values of a sample as text, doubles by their bits.
class Leaves {
 public:
  static std::string of(const auto& sample) {
    Leaves leaves;
    leaves.value(sample);
    std::sort(leaves.out_.begin(), leaves.out_.end());
    std::string line;
    for (const std::string& one : leaves.out_) line += " " + one;
    return line;
  }

 private:
  void value(double field) {
    out_.push_back(field != field ? "nan" : std::to_string(std::bit_cast<std::uint64_t>(field)));
  }
  void value(const Name& field) { out_.push_back("'" + field.str() + "'"); }
  void value(const std::string& field) { out_.push_back("'" + field + "'"); }
  template <class I>
  requires std::is_integral_v<I>
  void value(I field) { out_.push_back(std::to_string(field)); }
  template <class E>
  requires std::is_enum_v<E>
  void value(E field) { out_.push_back(std::to_string(static_cast<unsigned>(field))); }
  template <std::size_t N>
  void value(const std::array<char, N>& field) {
    out_.push_back("'" + std::string(field.data()) + "'");
  }
  template <class T, std::size_t N>
  void value(const std::array<T, N>& field) {
    for (const T& element : field) value(element);
  }
  template <class T>
  void value(const std::vector<T>& field) {
    value(field.size());
    for (const T& element : field) value(element);
  }
  template <class S>
  requires std::is_class_v<S>
  void value(const S& sample) {
    fields(sample, [this](const auto&... field) { (value(field), ...); });
  }

  std::vector<std::string> out_;
};

}  // namespace fathom::test
