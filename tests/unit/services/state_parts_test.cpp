#include "fusion/replica/state_parts.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

std::vector<std::byte> state(std::size_t size) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 7 + i / 251);
  return out;
}

std::vector<EngineStatePart> parts_of(std::span<const std::byte> bytes, std::uint64_t transfer = 1) {
  EngineStatePart head;
  head.transfer = transfer;
  head.missed = 5;
  std::vector<EngineStatePart> out;
  EXPECT_TRUE(send_in_parts(head, bytes, [&](const EngineStatePart& part) { out.push_back(part); }));
  return out;
}

const WriterGuid kA{1};
const WriterGuid kB{2};

TEST(StateParts, AreWholeAgainAtTheOtherEnd) {
  for (const std::size_t size : {std::size_t{1}, EngineStatePart::kBytes, EngineStatePart::kBytes + 1,
                                 std::size_t{170'001}, kMostParts * EngineStatePart::kBytes}) {
    const auto sent = state(size);
    const auto parts = parts_of(sent);
    StateAssembler assembler;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto whole = assembler.add(parts[i], kA);
      ASSERT_EQ(whole.has_value(), i + 1 == parts.size()) << size << " " << i;
      if (!whole) continue;
      EXPECT_EQ(whole->bytes, sent);
      EXPECT_EQ(whole->head.missed, 5U);
    }
  }
}

TEST(StateParts, OfNothingOrTooMuchAreNone) {
  const auto never = [](const EngineStatePart&) { FAIL(); };
  EXPECT_FALSE(send_in_parts({}, {}, never));
  EXPECT_FALSE(send_in_parts({}, state(kMostParts * EngineStatePart::kBytes + 1), never));
}

TEST(StateParts, ALostOneSpoilsThatStateOnly) {
  const auto sent = state(100'000);
  StateAssembler assembler;
  auto parts = parts_of(sent, 1);
  parts.erase(parts.begin() + 3);
  for (const auto& part : parts) EXPECT_FALSE(assembler.add(part, kA));
  int whole = 0;
  for (const auto& part : parts_of(sent, 2)) whole += assembler.add(part, kA) ? 1 : 0;
  EXPECT_EQ(whole, 1);
}

TEST(StateParts, OfTwoWritersNeverMix) {
  const auto a = parts_of(state(100'000), 1);
  const auto b = parts_of(state(100'000), 1);
  StateAssembler assembler;
  EXPECT_FALSE(assembler.add(a[0], kA));
  for (std::size_t i = 1; i < a.size(); ++i) EXPECT_FALSE(assembler.add(b[i], kB));
}

TEST(StateParts, ThatMakeNoSenseAreRefused) {
  const auto good = parts_of(state(40'000));
  for (const auto& spoil : std::vector<std::function<void(EngineStatePart&)>>{
           [](EngineStatePart& part) { part.parts = 0; },
           [](EngineStatePart& part) { part.parts = kMostParts + 1; },
           [](EngineStatePart& part) { part.part = part.parts; },
           [](EngineStatePart& part) { part.size = 0; },
           [](EngineStatePart& part) { part.size = EngineStatePart::kBytes + 1; }}) {
    StateAssembler assembler;
    auto parts = good;
    spoil(parts[1]);
    for (const auto& part : parts) EXPECT_FALSE(assembler.add(part, kA));
  }
}

}  // namespace
}  // namespace fathom::fusion
