#include "bus/detail/sample_type.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <new>
#include <stdexcept>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>
#include <fastrtps/utils/md5.h>

#include "bus/detail/endpoint.hpp"

namespace fathom::bus::detail {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

constexpr std::uint32_t kEncapsulation = 4;

/// Bytes written; 0 when they do not fit.
std::size_t encode_into(const TopicOps& ops, const void* sample, char* buffer, std::size_t capacity) {
  FastBuffer fast(buffer, capacity);
  Cdr cdr(fast, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  try {
    cdr.serialize_encapsulation();
    ops.encode(sample, cdr);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return 0;
  }
  return cdr.getSerializedDataLength();
}

bool decode_from(const TopicOps& ops, char* bytes, std::size_t size, void* sample) {
  FastBuffer fast(bytes, size);
  Cdr cdr(fast, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
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

}  // namespace

SampleType::SampleType(const TopicOps& ops) : ops_(ops) {
  setName(ops.type_name);
  m_typeSize = ops.max_size + kEncapsulation;
  m_isGetKeyDefined = true;
  // Type objects in discovery keep Cyclone DDS from matching, and the IDL files tell the same.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool SampleType::serialize(void* data, SerializedPayload_t* payload) {
  const auto* slot = static_cast<const SampleSlot*>(data);
  const std::size_t size =
      encode_into(ops_, slot->sample, reinterpret_cast<char*>(payload->data), payload->max_size);
  payload->encapsulation = Cdr::DEFAULT_ENDIAN == Cdr::BIG_ENDIANNESS ? CDR_BE : CDR_LE;
  payload->length = static_cast<std::uint32_t>(size);
  return size != 0;
}

bool SampleType::deserialize(SerializedPayload_t* payload, void* data) {
  auto* slot = static_cast<SampleSlot*>(data);
  slot->valid = decode_from(ops_, reinterpret_cast<char*>(payload->data), payload->length, slot->sample);
  return true;
}

std::function<std::uint32_t()> SampleType::getSerializedSizeProvider(void* /*data*/) {
  // Every type is bounded and small: room for the largest sample costs less than measuring each one.
  return [size = m_typeSize] { return size; };
}

void* SampleType::createData() {
  return new SampleSlot{ops_.create(), true};
}

void SampleType::deleteData(void* data) {
  auto* slot = static_cast<SampleSlot*>(data);
  ops_.destroy(slot->sample);
  delete slot;
}

bool SampleType::getKey(void* data, InstanceHandle_t* handle, bool force_md5) {
  const auto* slot = static_cast<const SampleSlot*>(data);
  std::array<char, 128> buffer{};
  assert(ops_.max_key_size <= buffer.size());
  FastBuffer fast(buffer.data(), buffer.size());
  Cdr cdr(fast, Cdr::BIG_ENDIANNESS);  // RTPS 9.6.3.8: the key is hashed as big-endian CDR
  ops_.encode_key(slot->sample, cdr);
  if (force_md5 || ops_.max_key_size > 16) {
    MD5 md5;
    md5.update(buffer.data(), static_cast<unsigned int>(cdr.getSerializedDataLength()));
    md5.finalize();
    std::copy_n(md5.digest, 16, &handle->value[0]);
  } else {
    std::copy_n(buffer.data(), 16, &handle->value[0]);
  }
  return true;
}

std::vector<std::uint8_t> encode(const TopicOps& ops, const void* sample) {
  std::vector<std::uint8_t> bytes(ops.max_size + kEncapsulation);
  bytes.resize(encode_into(ops, sample, reinterpret_cast<char*>(bytes.data()), bytes.size()));
  return bytes;
}

bool decode(const TopicOps& ops, std::span<const std::uint8_t> bytes, void* sample) {
  // Fast CDR reads through a non-const pointer and does not write.
  auto* data = const_cast<std::uint8_t*>(bytes.data());
  return decode_from(ops, reinterpret_cast<char*>(data), bytes.size(), sample);
}

}  // namespace fathom::bus::detail
