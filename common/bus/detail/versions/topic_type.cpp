#include "bus/detail/versions/topic_type.hpp"

#include <algorithm>

#include <fastcdr/Cdr.h>
#if FATHOM_FASTDDS_MAJOR < 3
#include <fastrtps/utils/md5.h>
#else
#include <fastdds/rtps/common/SerializedPayload.hpp>
#include <fastdds/utils/md5.hpp>
#endif

namespace fathom::bus::detail {
namespace {

using eprosima::fastcdr::Cdr;
using rtps::InstanceHandle_t;
using rtps::SerializedPayload_t;

constexpr std::uint32_t kEncapsulation = 4;

std::span<char> room_of(SerializedPayload_t& payload) {
  return {reinterpret_cast<char*>(payload.data), payload.max_size};
}
std::span<char> bytes_of(SerializedPayload_t& payload) {
  return {reinterpret_cast<char*>(payload.data), payload.length};
}
bool filled(SerializedPayload_t& payload, std::size_t bytes) {
  payload.encapsulation = Cdr::DEFAULT_ENDIAN == Cdr::BIG_ENDIANNESS ? CDR_BE : CDR_LE;
  payload.length = static_cast<std::uint32_t>(bytes);
  return bytes != 0;
}
void put(const Digest& key, InstanceHandle_t& handle) {
  std::copy_n(key.begin(), key.size(), &handle.value[0]);
}

}  // namespace

Digest md5(std::span<const char> bytes) {
#if FATHOM_FASTDDS_MAJOR < 3
  MD5 md5;
#else
  eprosima::fastdds::MD5 md5;
#endif
  md5.update(bytes.data(), static_cast<unsigned int>(bytes.size()));
  md5.finalize();
  Digest digest{};
  std::copy_n(md5.digest, digest.size(), digest.begin());
  return digest;
}

InstanceHandle_t TopicType::handle_of(const void* data) const {
  InstanceHandle_t handle;
  put(key(data, false), handle);
  return handle;
}

// Every type is bounded and small: room for the largest sample costs less than measuring each one.
#if FATHOM_FASTDDS_MAJOR < 3

TopicType::TopicType(const char* name, std::uint32_t max_bytes, bool keyed) {
  setName(name);
  m_typeSize = max_bytes + kEncapsulation;
  m_isGetKeyDefined = keyed;
  // Type objects in discovery keep Cyclone DDS from matching, and the IDL files tell the same.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool TopicType::serialize(void* data, SerializedPayload_t* payload) {
  return filled(*payload, encode(data, room_of(*payload)));
}

bool TopicType::deserialize(SerializedPayload_t* payload, void* data) {
  decode(bytes_of(*payload), data);
  return true;
}

std::function<std::uint32_t()> TopicType::getSerializedSizeProvider(void* /*data*/) {
  return [size = m_typeSize] { return size; };
}

bool TopicType::getKey(void* data, InstanceHandle_t* handle, bool force_md5) {
  put(key(data, force_md5), *handle);
  return true;
}

#else

TopicType::TopicType(const char* name, std::uint32_t max_bytes, bool keyed) {
  set_name(name);
  max_serialized_type_size = max_bytes + kEncapsulation;
  is_compute_key_provided = keyed;
  // No type object is registered: the IDL files tell the same.
}

bool TopicType::serialize(const void* data, SerializedPayload_t& payload, dds::DataRepresentationId_t) {
  return filled(payload, encode(data, room_of(payload)));
}

bool TopicType::deserialize(SerializedPayload_t& payload, void* data) {
  decode(bytes_of(payload), data);
  return true;
}

std::uint32_t TopicType::calculate_serialized_size(const void* /*data*/, dds::DataRepresentationId_t) {
  return max_serialized_type_size;
}

bool TopicType::compute_key(SerializedPayload_t& payload, InstanceHandle_t& handle, bool force_md5) {
  void* data = create();
  decode(bytes_of(payload), data);
  put(key(data, force_md5), handle);
  destroy(data);
  return true;
}

bool TopicType::compute_key(const void* data, InstanceHandle_t& handle, bool force_md5) {
  put(key(data, force_md5), handle);
  return true;
}

#endif

}  // namespace fathom::bus::detail
