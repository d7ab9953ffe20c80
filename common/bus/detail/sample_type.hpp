#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>

#include "bus/detail/topic_ops.hpp"

namespace fathom::bus::detail {

/// What Fast DDS calls the data of our topics: a pointer to a plain sample, and whether the bytes it was last
/// decoded from made sense. Decoding never fails towards Fast DDS, so that the reader learns of bad bytes and
/// counts them.
struct SampleSlot {
  void* sample = nullptr;
  bool valid = true;
};

/// Teaches Fast DDS one topic's type. Unlike generated type supports it is safe to share between threads, and
/// no bytes from the network make it throw.
class SampleType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit SampleType(const TopicOps& ops);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
  bool is_bounded() const override { return true; }
  bool is_plain() const override { return false; }

 private:
  const TopicOps& ops_;
};

}  // namespace fathom::bus::detail
