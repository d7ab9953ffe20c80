#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "support/vehicles/engine_states.hpp"

namespace fathom::fuzz {

/// Good states to begin from: at rest, under way, in a drop.
inline const std::vector<test::EngineState>& states() {
  static const std::vector<test::EngineState> all{test::survey_state(2.0), test::survey_state(24.0),
                                                  test::drop_state(20.0)};
  return all;
}

/// An image as the input wants it: a good one with changes of ten bytes each: where (4), how (1), what (5).
/// So that mutations reach what is behind the sizes and names, as random bytes do hardly ever.
inline std::vector<std::byte> forged(const test::EngineState& state, std::span<const std::uint8_t> input) {
  std::vector<std::byte> image = state.image;
  for (; input.size() >= 10; input = input.subspan(10)) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < 4; ++i) at |= static_cast<std::size_t>(input[i]) << (8 * i);
    if (image.size() < 8) break;
    at %= image.size() - 7;
    const std::uint8_t how = input[4] % 8;
    if (how == 0) {
      image[at] = std::byte{input[5]};
      continue;
    }
    if (how == 1) {
      image.resize(at);
      continue;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 8; ++i) bits |= std::to_integer<std::uint64_t>(image[at + i]) << (8 * i);
    const double value = std::bit_cast<double>(bits);
    const double factor = static_cast<double>(input[5]) / 64.0;
    switch (how) {
      case 2:
        bits = std::bit_cast<std::uint64_t>(value * factor);
        break;
      case 3:
        bits = std::bit_cast<std::uint64_t>(-value);
        break;
      case 4:
        bits = std::bit_cast<std::uint64_t>(std::pow(10.0, static_cast<double>(input[5]) * 4.0 - 512.0));
        break;
      case 5:
        bits = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
        break;
      case 6:
        bits += static_cast<std::uint64_t>(static_cast<std::int8_t>(input[5])) << (8 * (input[6] % 8));
        break;
      default:
        bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(static_cast<std::int8_t>(input[5])));
        break;
    }
    for (std::size_t i = 0; i < 8; ++i) image[at + i] = static_cast<std::byte>(bits >> (8 * i) & 0xFFU);
  }
  return image;
}

inline void fail(const std::string& what) {
  (void)std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

/// What must hold of an engine that was handed an image: a refusal has a reason and changes nothing; else it
/// goes on, and what it saves then is itself such an image, or refused with a reason.
inline void hand_over(const test::EngineState& state, std::span<const std::byte> image) {
  estimation::FusionEngine engine(state.config);
  const std::string why = engine.restore(image);
  std::vector<std::byte> saved;
  if (!why.empty()) {
    if (engine.save(saved)) fail("refused, and yet something was taken over: " + why);
    return;
  }
  state.feed_to(engine);
  NavDetail detail;
  AlignmentStatus alignment;
  engine.fill(detail);
  engine.fill(alignment);
  for (Verdict verdict; engine.next_verdict(verdict);) continue;
  if (!engine.save(saved)) fail("a restored engine has nothing to save");
  estimation::FusionEngine another(state.config);
  (void)another.restore(saved);
}

}  // namespace fathom::fuzz
