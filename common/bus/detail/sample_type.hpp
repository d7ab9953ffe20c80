#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/detail/topic_ops.hpp"
#include "bus/detail/versions/topic_type.hpp"

namespace fathom::bus::detail {

/// What Fast DDS calls the data of our topics: a pointer to a plain sample, and whether the bytes it was last
/// decoded from made sense. Decoding never fails towards Fast DDS, so that the reader learns of bad bytes and
/// counts them. Whoever reads or writes bytes says so in the slot that it hands to Fast DDS; the topic's type
/// is the same for all.
struct SampleSlot {
  void* sample = nullptr;
  bool valid = true;
  bool raw = false;  ///< reading: `sample` is a RawSample, which gets the bytes
  const std::vector<std::uint8_t>* wire = nullptr;  ///< writing: the bytes of `sample`, sent as they are
};
using RawSample = std::vector<std::uint8_t>;

/// What a slot's sample is made of.
struct SamplePlace {
  using Destroy = void (*)(void* sample);

  const TopicOps& ops;
  bool raw = false;  ///< a RawSample

  [[nodiscard]] void* create() const;
  [[nodiscard]] Destroy destroy() const;
  [[nodiscard]] std::string key_text(const void* sample) const;
};

/// Teaches Fast DDS one topic's type. Unlike generated type supports it is safe to share between threads, and
/// no bytes from the network make it throw.
class SampleType final : public TopicType {
 public:
  explicit SampleType(const TopicOps& ops);

 private:
  [[nodiscard]] void* create() const override;
  void destroy(void* data) const override;
  [[nodiscard]] std::size_t encode(const void* data, std::span<char> into) const override;
  void decode(std::span<char> bytes, void* data) const override;
  [[nodiscard]] Digest key(const void* data, bool force_md5) const override;

  const TopicOps& ops_;
};

}  // namespace fathom::bus::detail
