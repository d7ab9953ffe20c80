#include <new>
#include <stdexcept>

#include <fastcdr/exceptions/Exception.h>

#include "bus/detail/topic_ops.hpp"
#include "bus/detail/versions/cdr.hpp"

namespace fathom::bus::detail {
namespace {

constexpr std::uint32_t kEncapsulation = 4;

}  // namespace

std::size_t encode_into(const TopicOps& ops, const void* sample, std::span<char> into) {
  FastBuffer fast(into.data(), into.size());
  Cdr cdr(fast, Cdr::DEFAULT_ENDIAN, kPlainCdr);
  try {
    cdr.serialize_encapsulation();
    ops.encode(sample, cdr);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return 0;
  }
  return length_of(cdr);
}

bool decode_from(const TopicOps& ops, std::span<char> bytes, void* sample) {
  FastBuffer fast(bytes.data(), bytes.size());
  Cdr cdr(fast, Cdr::DEFAULT_ENDIAN, kPlainCdr);
  try {
    cdr.read_encapsulation();
    return ops.decode(cdr, sample);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return false;
  } catch (const std::bad_alloc&) {  // a list that claims to be longer than memory
    return false;
  } catch (const std::length_error&) {
    return false;
  }
}

std::vector<std::uint8_t> encode(const TopicOps& ops, const void* sample) {
  std::vector<std::uint8_t> bytes(ops.max_size + kEncapsulation);
  bytes.resize(encode_into(ops, sample, {reinterpret_cast<char*>(bytes.data()), bytes.size()}));
  return bytes;
}

bool decode(const TopicOps& ops, std::span<const std::uint8_t> bytes, void* sample) {
  // Fast CDR reads through a non-const pointer and does not write.
  auto* data = const_cast<std::uint8_t*>(bytes.data());
  return decode_from(ops, {reinterpret_cast<char*>(data), bytes.size()}, sample);
}

}  // namespace fathom::bus::detail
