#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace fathom::estimation {

template <class T, std::size_t N>
bool same_bits(const std::array<T, N>& a, const std::array<T, N>& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

}  // namespace fathom::estimation
