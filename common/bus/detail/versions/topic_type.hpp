#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <fastdds/dds/topic/TopicDataType.hpp>

#include "bus/detail/versions/names.hpp"

namespace fathom::bus::detail {

using Digest = std::array<std::uint8_t, 16>;
[[nodiscard]] Digest md5(std::span<const char> bytes);

/// dds::TopicDataType, which every version of Fast DDS asks with functions of its own, as five that do not
/// change. `data` is what create() makes.
class TopicType : public dds::TopicDataType {
 public:
  [[nodiscard]] rtps::InstanceHandle_t handle_of(const void* data) const;

 protected:
  /// `max_bytes` without encapsulation.
  TopicType(const char* name, std::uint32_t max_bytes, bool keyed = true);

  [[nodiscard]] virtual void* create() const = 0;
  virtual void destroy(void* data) const = 0;
  /// Bytes written, encapsulation included; 0 when they do not fit.
  [[nodiscard]] virtual std::size_t encode(const void* data, std::span<char> into) const = 0;
  virtual void decode(std::span<char> bytes, void* data) const = 0;
  /// The key of RTPS 9.6.3.8.
  [[nodiscard]] virtual Digest key(const void* data, bool force_md5) const = 0;

 private:
  bool is_bounded() const final { return true; }

#if FATHOM_FASTDDS_MAJOR < 3
  bool serialize(void* data, rtps::SerializedPayload_t* payload) final;
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) final;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) final;
  void* createData() final {
    return create();
  }
  void deleteData(void* data) final {
    destroy(data);
  }
  bool getKey(void* data, rtps::InstanceHandle_t* handle, bool force_md5) final;
  bool is_plain() const final {
    return false;
  }
#else
  bool serialize(const void* data, rtps::SerializedPayload_t& payload, dds::DataRepresentationId_t) final;
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) final;
  std::uint32_t calculate_serialized_size(const void* data, dds::DataRepresentationId_t) final;
  void* create_data() final {
    return create();
  }
  void delete_data(void* data) final {
    destroy(data);
  }
  bool compute_key(rtps::SerializedPayload_t& payload, rtps::InstanceHandle_t& handle, bool force_md5) final;
  bool compute_key(const void* data, rtps::InstanceHandle_t& handle, bool force_md5) final;
  bool is_plain(dds::DataRepresentationId_t) const final {
    return false;
  }
#endif
};

}  // namespace fathom::bus::detail
