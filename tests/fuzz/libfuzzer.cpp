// For libFuzzer only: without a corpus it would spend its life in front of the checksums. Now and then a
// mutation starts from a piece of the target's seed instead of the input, and goes on from there.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "driver.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  constexpr unsigned int kFromTheStreamEvery = 32;
  static const auto stream = fathom::fuzz::target_seed();
  if (seed % kFromTheStreamEvery == 0 && !stream.empty()) {
    const std::size_t first = (seed / kFromTheStreamEvery) % stream.size();
    size = std::min(max_size, stream.size() - first);
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(first), size, data);
  }
  return LLVMFuzzerMutate(data, size, max_size);
}
