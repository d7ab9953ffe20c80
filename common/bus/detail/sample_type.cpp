#include "bus/detail/sample_type.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>

#include "bus/detail/versions/cdr.hpp"

namespace fathom::bus::detail {
void* SamplePlace::create() const {
  return raw ? new RawSample() : ops.create();
}

SamplePlace::Destroy SamplePlace::destroy() const {
  return raw ? [](void* sample) { delete static_cast<RawSample*>(sample); } : ops.destroy;
}

std::string SamplePlace::key_text(const void* sample) const {
  if (!raw) return ops.key_text(sample);
  const std::unique_ptr<void, Destroy> typed(ops.create(), ops.destroy);
  const bool valid = decode(ops, *static_cast<const RawSample*>(sample), typed.get());
  return valid ? ops.key_text(typed.get()) : "an unknown key";
}

SampleType::SampleType(const TopicOps& ops) : TopicType(ops.type_name, ops.max_size), ops_(ops) {}

void* SampleType::create() const {
  return new SampleSlot{ops_.create()};
}

void SampleType::destroy(void* data) const {
  auto* slot = static_cast<SampleSlot*>(data);
  ops_.destroy(slot->sample);
  delete slot;
}

std::size_t SampleType::encode(const void* data, std::span<char> into) const {
  const auto* slot = static_cast<const SampleSlot*>(data);
  if (slot->wire == nullptr) return encode_into(ops_, slot->sample, into);
  if (slot->wire->size() > into.size()) return 0;
  std::copy(slot->wire->begin(), slot->wire->end(), into.begin());
  return slot->wire->size();
}

void SampleType::decode(std::span<char> bytes, void* data) const {
  auto* slot = static_cast<SampleSlot*>(data);
  if (slot->raw) {
    static_cast<RawSample*>(slot->sample)->assign(bytes.begin(), bytes.end());
    slot->valid = true;
    return;
  }
  slot->valid = decode_from(ops_, bytes, slot->sample);
}

Digest SampleType::key(const void* data, bool force_md5) const {
  const auto* slot = static_cast<const SampleSlot*>(data);
  std::array<char, 128> buffer{};
  assert(ops_.max_key_size <= buffer.size());
  FastBuffer fast(buffer.data(), buffer.size());
  Cdr cdr(fast, Cdr::BIG_ENDIANNESS, kPlainCdr);  // the key is hashed as big-endian CDR
  ops_.encode_key(slot->sample, cdr);
  if (force_md5 || ops_.max_key_size > 16) return md5({buffer.data(), length_of(cdr)});
  Digest digest{};
  std::copy_n(buffer.data(), digest.size(), digest.begin());
  return digest;
}

}  // namespace fathom::bus::detail
