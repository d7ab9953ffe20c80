#pragma once

// How messages of ROS 2 travel: XCDR version 1, field by field as fields() shows them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <fastcdr/exceptions/Exception.h>

#include "bus/detail/versions/cdr.hpp"
#include "ros2/messages/geometry.hpp"

namespace fathom::bus::ros2 {

/// Walks over a message and writes it.
struct Encoder {
  detail::Cdr& cdr;

  template <class T>
  void operator()(const char* /*name*/, const T& value) {
    put(value);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      cdr << value;
    } else if constexpr (std::is_same_v<T, fathom::ros2::Octet>) {
      cdr << value.value;
    } else {
      T::fields(*this, value);
    }
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& values) {
    for (const T& value : values) put(value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    cdr << static_cast<std::uint32_t>(values.size());
    for (const T& value : values) put(value);
  }
};

/// Walks over a message and reads it. Throws what Fast CDR throws when bytes are missing.
struct Decoder {
  /// Elements of one list. They are read one by one, so that a length alone claims no memory.
  static constexpr std::uint32_t kMostElements = 65'536;

  detail::Cdr& cdr;
  bool valid = true;

  template <class T>
  void operator()(const char* /*name*/, T& value) {
    if (valid) get(value);
  }

 private:
  template <class T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      cdr >> byte;
      valid = byte <= 1;
      value = byte == 1;
    } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      cdr >> value;
    } else if constexpr (std::is_same_v<T, fathom::ros2::Octet>) {
      cdr >> value.value;
    } else {
      T::fields(*this, value);
    }
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& values) {
    for (T& value : values) {
      if (valid) get(value);
    }
  }
  template <class T>
  void get(std::vector<T>& values) {
    std::uint32_t length = 0;
    cdr >> length;
    valid = length <= kMostElements;
    values.clear();
    while (valid && values.size() < length) get(values.emplace_back());
  }
};

/// Bytes with encapsulation header; 0 where they do not fit.
template <class M>
std::size_t encode(const M& message, std::span<char> into) {
  detail::FastBuffer fast(into.data(), into.size());
  detail::Cdr cdr(fast, detail::Cdr::DEFAULT_ENDIAN, detail::kPlainCdr);
  try {
    cdr.serialize_encapsulation();
    Encoder encoder{cdr};
    M::fields(encoder, message);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return 0;
  }
  return detail::length_of(cdr);
}

/// False where the bytes are no message of this type. They may go on: a later version of an interface may
/// have more fields.
template <class M>
bool decode(std::span<char> bytes, M& message) {
  detail::FastBuffer fast(bytes.data(), bytes.size());
  detail::Cdr cdr(fast, detail::Cdr::DEFAULT_ENDIAN, detail::kPlainCdr);
  try {
    cdr.read_encapsulation();
    Decoder decoder{cdr};
    M::fields(decoder, message);
    return decoder.valid;
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return false;
  }
}

}  // namespace fathom::bus::ros2
