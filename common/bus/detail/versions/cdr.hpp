#pragma once

// What differs between Fast CDR 1 and 2, and between the types that their generators write.

#include <cstddef>
#include <cstdint>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/config.h>
#if FASTCDR_VERSION_MAJOR >= 2
#include <fastcdr/CdrSizeCalculator.hpp>
#endif

namespace fathom::bus::detail {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

#if FASTCDR_VERSION_MAJOR < 2
inline constexpr auto kPlainCdr = Cdr::DDS_CDR;
inline std::size_t length_of(const Cdr& cdr) {
  return cdr.getSerializedDataLength();
}
inline Cdr::state position_of(Cdr& cdr) {
  return cdr.getState();
}
inline void go_back(Cdr& cdr, Cdr::state& position) {
  cdr.setState(position);
}
/// Throws what Fast CDR throws when bytes are missing.
template <class Wire>
bool decode_whole(Cdr& cdr, Wire& wire) {
  cdr >> wire;
  return true;
}
#else
inline constexpr auto kPlainCdr = eprosima::fastcdr::CdrVersion::XCDRv1;
inline std::size_t length_of(const Cdr& cdr) {
  return cdr.get_serialized_data_length();
}
inline Cdr::state position_of(Cdr& cdr) {
  return cdr.get_state();
}
inline void go_back(Cdr& cdr, Cdr::state& position) {
  cdr.set_state(position);
}
/// False when the bytes end between two fields, where Fast CDR 2 leaves the rest as it was; throws where they
/// end within one.
template <class Wire>
bool decode_whole(Cdr& cdr, Wire& wire) {
  constexpr std::size_t kEncapsulation = 4;
  cdr >> wire;
  eprosima::fastcdr::CdrSizeCalculator calculator(kPlainCdr);
  std::size_t alignment = 0;
  return length_of(cdr) == kEncapsulation + calculator.calculate_serialized_size(wire, alignment);
}
#endif

/// Largest encodings of a generated type, without encapsulation.
template <class Wire>
std::uint32_t max_encoding() {
  if constexpr (requires { Wire::getMaxCdrSerializedSize(); }) {
    return static_cast<std::uint32_t>(Wire::getMaxCdrSerializedSize());
  } else {
    return max_cdr_size(static_cast<const Wire*>(nullptr));  // written by idl/generate.sh
  }
}
template <class Wire>
std::uint32_t max_key_encoding() {
  if constexpr (requires { Wire::getKeyMaxCdrSerializedSize(); }) {
    return static_cast<std::uint32_t>(Wire::getKeyMaxCdrSerializedSize());
  } else {
    return max_key_cdr_size(static_cast<const Wire*>(nullptr));
  }
}

template <class Wire>
void encode_key(const Wire& wire, Cdr& cdr) {
  if constexpr (requires { wire.serializeKey(cdr); }) {
    wire.serializeKey(cdr);
  } else {
    serialize_key(cdr, wire);  // found beside Cdr
  }
}

}  // namespace fathom::bus::detail
