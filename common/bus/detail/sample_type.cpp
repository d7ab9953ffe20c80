#include "bus/detail/sample_type.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <new>
#include <stdexcept>

#include <fastcdr/exceptions/Exception.h>

#include "bus/detail/endpoint.hpp"
#include "bus/detail/versions/cdr.hpp"

namespace fathom::bus::detail {
namespace {

constexpr std::uint32_t kEncapsulation = 4;

/// Bytes written; 0 when they do not fit.
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

}  // namespace

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
