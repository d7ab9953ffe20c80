// However long the garbage, a codec's memory does not grow; counted by replacing the global allocator.

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>

#include <gtest/gtest.h>
#include <malloc.h>

#include "support/codec/seed_streams.hpp"

namespace {

std::atomic<std::size_t> live_bytes{0};
std::atomic<std::size_t> peak_bytes{0};

void* counted_or_null(std::size_t size) noexcept {
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) return nullptr;
  const std::size_t now = live_bytes += malloc_usable_size(memory);
  std::size_t peak = peak_bytes;
  while (now > peak && !peak_bytes.compare_exchange_weak(peak, now)) {
  }
  return memory;
}

void* counted(std::size_t size) {
  void* memory = counted_or_null(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void release(void* memory) noexcept {
  if (memory == nullptr) return;
  live_bytes -= malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return counted(size);
}
// The library's own ends in the above; AddressSanitizer's does not, and would miss its other half
// (stable_sort).
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted_or_null(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  release(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  release(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}

namespace fathom::test {
namespace {

struct Nowhere final : codec::Sink {
  void on_sample(const codec::Decoded&) override { ++events; }
  void on_rejected(const codec::Rejected&) override { ++events; }
  std::size_t events = 0;
};

ByteVector repeated(std::string_view piece, std::size_t length) {
  ByteVector bytes;
  bytes.reserve(length + piece.size());
  while (bytes.size() < length) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

TEST(BoundedMemory, EndlessGarbageOfEveryKindLeavesEveryCodecSmall) {
  constexpr std::size_t kLength = 300'000;
  constexpr std::size_t kLimit = 512 * 1024;
  using namespace std::string_view_literals;
  // Noise, beginnings of frames that never end, longest lengths, deepest nesting, lines without end.
  const std::vector<ByteVector> garbage{
      noise(kLength, 1),
      repeated("$GPGGA,"sv, kLength),
      repeated("$"sv, kLength),
      repeated("*00011"sv, kLength),
      repeated("\xB5\x62\x01\x07\xFF\x0F"sv, kLength),
      repeated("\x7F\x7F\xFF\xFF"sv, kLength),
      repeated("\x7F\x7F\xF0\x0F\x00\x06"sv, kLength),
      repeated("\xFA\x14\x3E\x00"sv, kLength),
      repeated("\xFA"sv, kLength),
      repeated("{\"a\":["sv, kLength),
      repeated("[[[[[[[["sv, kLength),
      repeated("x"sv, kLength),
      repeated("\r\n"sv, kLength),
      repeated("\0"sv, kLength),
  };
  for (const codec::Protocol& protocol : codec::protocols()) {
    for (std::size_t kind = 0; kind < garbage.size(); ++kind) {
      const std::size_t before = live_bytes;
      peak_bytes = before;
      Nowhere sink;
      {
        const auto codec = protocol.make(seed_options(protocol.name));
        codec->feed(garbage[kind], sink);
        EXPECT_EQ(codec->totals().bytes, garbage[kind].size());
        codec->finish(sink);
      }
      EXPECT_LT(peak_bytes - before, kLimit) << protocol.name << ", garbage " << kind;
      EXPECT_EQ(live_bytes, before) << protocol.name << ", garbage " << kind;
    }
  }
}

}  // namespace
}  // namespace fathom::test
